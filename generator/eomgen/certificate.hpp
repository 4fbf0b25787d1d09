// SPDX-License-Identifier: GPL-3.0-or-later
// What was held against one another, and the verdict.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eomgen/formulas.hpp"

namespace eomgen {

struct VerifyOptions {
  int digits = 50;          // decimal, of the arithmetic; 20 to 300
  std::size_t points = 20;  // random states
  std::uint64_t seed = 1;
  bool compile = true;  // the emitted code too, which needs a C compiler
};

struct Comparison {
  std::string a, b;
  bool shares_code = false;  // else the two have nothing in common
  double max_relative_difference = 0, tolerance = 0;
  bool pass = false;
};

struct Certificate {
  bool pass = false;
  std::size_t points = 0;
  int digits = 0;
  std::vector<Comparison> comparisons;
  std::vector<LeftOut> left_out;
  std::string summary;
  bool interrupted = false;  // before all points were compared
};

}  // namespace eomgen
