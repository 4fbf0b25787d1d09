// SPDX-License-Identifier: GPL-3.0-or-later
// In: a one-form. Out: psi with d psi = factor * form, proven. Factors that are tried: 1; functions of one variable;
// products of powers of the variables, of the parts of the coefficients, and of sums of two squares.
#pragma once

#include <optional>

#include "mechanics/pfaffian.hpp"

namespace eomgen::mechanics {

/// Empty if no factor or no integral is found. This is inconclusive: an integral may still exist.
std::optional<Ref> find_integral(OneFormSpace& space, const OneForm& form);

}  // namespace eomgen::mechanics
