// SPDX-License-Identifier: GPL-3.0-or-later
// Result of a verification: which derivations were compared, how far they differ, the verdict.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eomgen/formulas.hpp"

namespace eomgen {

/// Options of Model::verify().
struct VerifyOptions {
  int digits = 50;          // decimal digits of the arithmetic, 20 to 300
  std::size_t points = 20;  // random states, at least 1
  std::uint64_t seed = 1;   // of the random states
  bool compile = true;      // also checks the emitted code; needs a C compiler
};

/// Verdict of a verification with all comparisons.
struct Certificate {
  bool pass = false;
  std::size_t points = 0;  // states compared
  int digits = 0;          // of the arithmetic
  std::vector<Comparison> comparisons;
  std::vector<LeftOut> left_out;
  std::string summary;       // one sentence
  bool interrupted = false;  // stopped before all points were compared
};

}  // namespace eomgen
