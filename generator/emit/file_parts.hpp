// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of one file in order: as they are where a program has one chart; in several charts those of each chart,
// and the ones that choose among them by `mode` (docs/abi.md, "Charts").
#pragma once

#include <string>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

struct FilePart {
  std::string name;  // without NAME: "rhs", "own_rhs", "chart1_rhs"
  std::string purpose;
  const program::Function* function = nullptr;  // its statements; nullptr: `body` calls others
  bool internal = false;                        // only others of the file call it
  std::string arguments, body;
};

/// `prefix`: of what is called, "NAME_"; `real`: "double";
std::vector<FilePart> file_parts(const program::Program& program, const std::string& prefix, const std::string& real);

/// "chart 1": which objects are in their second charts, for the banner and for NAME_info.
std::string chart_title(const program::Program& program, int in_charts);

}  // namespace eomgen::emit
