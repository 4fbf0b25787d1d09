// SPDX-License-Identifier: GPL-3.0-or-later
// In: the data of a CompiledModel. Out: dx/dt of four states at a time, in vector registers. Not installed.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "jit/lanes.hpp"

namespace eomgen {

struct PreparedRun;

/// Code that is made at the first call that asks for it. May be used from any thread.
class RhsLanes {
 public:
  /// The code of `rhs`, or of `rhs_prepared`; null if it is not faster, on other processors, in the tier `compiled`,
  /// and while another call derives. The program is read under the lock of the library.
  const jit::LaneCode* find(const PreparedRun& run, bool prepared) const;

 private:
  struct Codes {
    std::unique_ptr<const jit::LaneCode> rhs, rhs_prepared;
  };
  mutable std::atomic<bool> is_made_{false};
  mutable Codes codes_;  // from then on constant
};

/// Arguments that all states of a batch share, and places for the states of some groups of four.
class LaneBatch {
 public:
  /// So many groups are copied before the first is evaluated: vector registers then load what left the store buffer.
  static constexpr std::size_t most_groups = 16;

  /// `p`, `w`, `u`: parameters, prepared values and inputs; w may be null.
  LaneBatch(const jit::LaneCode& code, std::size_t states, const double* p, std::size_t p_count, const double* w,
            std::size_t w_count, const double* u, std::size_t u_count);

  /// dx/dt of four states for each of `groups` at `x`, N values each. Bit g of the result: one state of group g has no
  /// derivative, and its part of dx is left.
  std::uint32_t evaluate(std::size_t groups, const double* t, const double* x, double* dx);

 private:
  const jit::LaneCode& code_;
  std::size_t states_;
  std::vector<double> x_, p_, w_, u_, dx_;
};

}  // namespace eomgen
