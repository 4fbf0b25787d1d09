// SPDX-License-Identifier: GPL-3.0-or-later
// Sample values of symbols for searches guided by numbers. They are inside the charts of coordinates and the domains of
// most functions. Results of such searches are proven, or decided in many digits at several points.
#pragma once

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// A value in [0.2, 1.2) that depends on symbol and point; the same in every process.
Rational sample(const Symbol& symbol, std::uint64_t point);
/// The same in binary64.
double sample_double(const Symbol& symbol, std::uint64_t point);

}  // namespace eomgen::symbolic
