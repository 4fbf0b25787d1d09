// SPDX-License-Identifier: GPL-3.0-or-later
// Transition of a state from one chart to another (docs/theory.md, "Two charts of one body"): closed formulas in the
// symbols q, qdot of the angles, which are those of the initial chart.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::system {

struct ChartChange {
  std::string of, own, second, singularity;  // "B", "313", "312", "sin(theta)"
  std::vector<std::uint32_t> angles;  // coordinates of the model; guarded: the one whose sine or cosine is `regular`
  std::size_t guarded = 0;
  bool at_sine = true;         // the own chart is singular at zeros of the sine; else of the cosine
  bool second_at_sine = true;  // the same for the second chart
  bool rotation = true;        // chart of a body or frame; else of a place
  std::vector<symbolic::Ref> to_second,
      to_own;  // the angles, then their rates: from the own chart to the second, and from it
};

}  // namespace eomgen::system
