// SPDX-License-Identifier: GPL-3.0-or-later
// Second charts of a model's rotations and positions: which can be exchanged, and the program that knows several. In:
// what was derived in the own charts. Out: second charts derived, verified and put beside it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/charts.hpp"
#include "pipeline/code.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

/// All, with what the mechanics say against one too.
std::vector<model::SwitchedChart> charts_of(const mechanics::Mechanics& mechanics);
/// Those that can be exchanged, as many as `mode` has bits for.
std::vector<model::SwitchedChart> exchangeable(const std::vector<model::SwitchedChart>& charts);

/// How programs are made of one model, in whatever charts.
struct ChartRequest {
  program::Request request;
  ApproachChoice approach = ApproachChoice::automatic;
  FormChoice form = std::nullopt;
  std::uint64_t seed = 1;
};

/// Puts the second charts of `mask` beside `program`: derived, verified (Error{Fault::check} where that is negative),
/// optimised.
void add_second_charts(Derived& own, program::Program& program, const std::vector<model::SwitchedChart>& charts,
                       unsigned mask, const ChartRequest& request);

/// What a run asks for when it comes near where a chart fails: code with all charts that it has asked for so far.
class ChartLibrary {
 public:
  ChartLibrary(Derived& own, program::Program program, emit::EmissionContext context, ChartRequest request);

  const std::vector<model::SwitchedChart>& charts() const { return charts_; }
  /// Throws Error where a second chart cannot be derived or compiled.
  const run::Code& in(unsigned mask);
  /// Of deriving, verifying and compiling.
  double seconds() const { return seconds_; }

 private:
  struct Compiled {
    CompiledCode code;
    run::Code functions;
  };

  Derived& own_;
  program::Program program_;
  emit::EmissionContext context_;
  ChartRequest request_;
  std::vector<model::SwitchedChart> charts_;
  std::vector<unsigned> known_;
  std::vector<std::unique_ptr<Compiled>> compiled_;  // earlier ones may still be in use
  double seconds_ = 0;
};

}  // namespace eomgen::pipeline
