// SPDX-License-Identifier: GPL-3.0-or-later
// Whether one sum divides another one without remainder: mostly it does not, which the first term tells.
#pragma once

#include <optional>

#include "reading/sum.hpp"

namespace eomgen::reading {

/// a / b for sums that are polynomials in their atoms, up to a common factor with any exponents; nothing where that is
/// none, or exponents are beyond what anybody reads. b is not 0.
std::optional<Sum> divide_exactly(const Sum& a, const Sum& b);

/// Operations that it takes to put a sum together of products of powers.
std::size_t operations_of_reading(const Sum& sum);

}  // namespace eomgen::reading
