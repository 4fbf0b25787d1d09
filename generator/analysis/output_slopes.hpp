// SPDX-License-Identifier: GPL-3.0-or-later
// The linearised outputs of a model: delta o = C delta y + D delta u beside the equations of linear/linearise.hpp. In:
// a linearisation and names of outputs. Out: their values, C and D, in the precision of the linearisation.
#pragma once

#include <string>
#include <vector>

#include "analysis/steady.hpp"

namespace eomgen::analysis {

struct OutputSlopes {
  struct LeftOut {
    std::string name, reason;
  };
  std::vector<std::string> names;
  std::vector<linear::Precise> values;
  linear::Matrix<linear::Precise> C, D;  // outputs x y, outputs x inputs
  std::vector<LeftOut> left_out;         // outputs of the scene without a slope at the state
};

/// The outputs that are requested by these names, or those of the scene if there are none. Throws Error{stage
/// "linearize"} if a name is unknown, or if a requested output has no slope at the state or depends on quantities that
/// only runs have.
OutputSlopes linearise_outputs(const SteadyProblem& problem, const linear::Linearisation& at,
                               const std::vector<std::string>& names);

}  // namespace eomgen::analysis
