// SPDX-License-Identifier: GPL-3.0-or-later
// Exact division of sums. In most cases there is a remainder, which the first term already shows.
#pragma once

#include <optional>

#include "reading/sum.hpp"

namespace eomgen::reading {

/// a / b for sums that are polynomials in their atoms, up to a common factor with any exponents. Empty if there is a
/// remainder, or if exponents are too large to display. b is not 0.
std::optional<Sum> divide_exactly(const Sum& a, const Sum& b);

/// The number of operations that form a sum from products of powers.
std::size_t display_operation_count(const Sum& sum);

}  // namespace eomgen::reading
