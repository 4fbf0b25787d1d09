// SPDX-License-Identifier: GPL-3.0-or-later
// Sample values of symbols for numerical tests of identities, which hold for any values.
#pragma once

#include <cmath>

#include "symbolic/dag.hpp"

namespace eomgen::analysis {

inline double sample_value(const symbolic::Symbol& s, int state) {
  const double turn = 1.3 * s.index + 0.7 * static_cast<int>(s.kind) + 2.1 * state;
  return 0.9 + 0.4 * std::sin(turn);
}

}  // namespace eomgen::analysis
