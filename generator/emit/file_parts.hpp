// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of one file in order. A program with several charts has the functions of each chart and dispatchers
// that select by `mode` (docs/abi.md, "Charts").
#pragma once

#include <string>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

struct FilePart {
  std::string name;  // without NAME: "rhs", "own_rhs", "chart1_rhs"
  std::string purpose;
  const program::Function* function = nullptr;  // source of the statements; nullptr: `body` calls other functions
  bool internal = false;                        // called only within the file
  std::string arguments, body;
};

/// `prefix`: of called functions, "NAME_".
std::vector<FilePart> file_parts(const program::Program& program, const std::string& prefix, const Dialect& dialect);

/// The title of a chart for the banner and NAME_info: the objects that are in their second charts.
std::string chart_title(const program::Program& program, unsigned in_charts);

}  // namespace eomgen::emit
