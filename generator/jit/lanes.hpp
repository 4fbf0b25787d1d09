// SPDX-License-Identifier: GPL-3.0-or-later
// In: a function of a program, `rhs` or `rhs_prepared`. Out: machine code that computes it for four states at once.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "jit/lane_encode.hpp"
#include "program/program.hpp"

namespace eomgen::jit {

/// May be called from any thread.
class LaneCode {
 public:
  /// Requires has_lanes(). `default_inputs`: as of MachineCode.
  LaneCode(const program::Program& program, const program::Function& function, std::span<const double> default_inputs);

  int operator()(const LaneArguments& arguments) const { return function_(&arguments); }
  /// Whether four states take less time than each alone. The C library is called for each of them in either case.
  bool is_faster() const { return is_faster_; }

 private:
  std::vector<double> constants_;
  std::unique_ptr<ExecutableMemory> memory_;
  LaneFunction function_;
  bool is_faster_;
};

}  // namespace eomgen::jit
