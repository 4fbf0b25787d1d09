// SPDX-License-Identifier: GPL-3.0-or-later
// Second charts of a model's rotations and positions: the exchangeable ones, and programs with several charts. In: the
// model derived in its own charts. Out: the equations in second charts, derived, verified and added to the program.
#pragma once

#include <map>
#include <vector>

#include "model/charts.hpp"
#include "pipeline/code.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

/// All second charts, also those that the mechanics exclude, with the reason.
std::vector<model::ChartPair> list_charts(const mechanics::Mechanics& mechanics);
/// The exchangeable charts, at most eom::max_charts.
std::vector<model::ChartPair> exchangeable_charts(const std::vector<model::ChartPair>& charts);

/// Options of the programs of one model, in any charts.
struct ChartRequest {
  program::Request request;
  ApproachChoice approach = ApproachChoice::automatic;
  FormChoice form = std::nullopt;
  std::uint64_t seed = 1;
  Tier tier = Tier::compiled;  // of the code; never automatic
};

/// Derives, verifies and optimises the second charts of `mask`, and adds them to `program`. Throws
/// Error{ErrorKind::check} if the verification fails.
void add_second_charts(DerivedModel& own, program::Program& program, const std::vector<model::ChartPair>& charts,
                       unsigned mask, const ChartRequest& request);

/// Provides runs near chart singularities with code for the charts that each has requested so far. Several runs share
/// the code; the code of one run does not depend on the others.
class ChartLibrary {
 public:
  ChartLibrary(DerivedModel& own, program::Program program, emit::EmissionContext context, ChartRequest request);

  const std::vector<model::ChartPair>& charts() const { return charts_; }
  /// Code with these second charts, in the order in which a run has requested them. Valid as long as the library.
  /// Throws Error if a second chart cannot be derived or compiled.
  const run::Code& code_for(const std::vector<unsigned>& masks);
  /// Seconds of derivation, verification and compilation.
  double seconds() const { return seconds_; }

 private:
  struct Compiled {
    program::Program program;
    CompiledCode code;
  };

  DerivedModel& own_;
  program::Program program_;
  emit::EmissionContext context_;
  ChartRequest request_;
  std::vector<model::ChartPair> charts_;
  std::map<std::vector<unsigned>, Compiled> compiled_;
  double seconds_ = 0;
};

}  // namespace eomgen::pipeline
