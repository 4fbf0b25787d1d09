// SPDX-License-Identifier: GPL-3.0-or-later
// Values for symbols where numbers guide a search: inside the charts of coordinates and the domains of most functions.
// What is found with them is proven, or decided in many digits at several points.
#pragma once

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// In [0.2, 1.2), by symbol and point; the same in every process.
Rational sample(const Symbol& symbol, std::uint64_t point);
/// The same in binary64.
double sample_double(const Symbol& symbol, std::uint64_t point);

}  // namespace eomgen::symbolic
