// SPDX-License-Identifier: GPL-3.0-or-later
// How a state goes from one chart to another (docs/theory.md, "Two charts of one body"): closed formulas in the symbols
// q, qdot of the angles alone, whose meaning is that of the chart that is left.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::system {

struct ChartChange {
  std::string of, own, second, regular;  // "B", "313", "312", "sin(theta)"
  std::vector<std::uint32_t> angles;     // coordinates of the model; guarded: which one's sine or cosine is `regular`
  std::size_t guarded = 0;
  bool at_sine = true;                  // the own chart
  bool second_at_sine = true;           // the second one
  bool rotation = true;                 // of a body or frame; else of a place
  std::vector<symbolic::Ref> to, back;  // the angles, then their rates: from the own chart to the second, and from it
};

}  // namespace eomgen::system
