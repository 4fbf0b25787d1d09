// SPDX-License-Identifier: GPL-3.0-or-later
// Determinants and inverses of the small symbolic matrices of geometry; row-major, n x n. Throw work::BudgetExceeded.
#pragma once

#include "reading/ginac_bridge.hpp"

namespace eomgen::reading {

/// By cofactors along rows, zero entries skipped.
Sum determinant(const std::vector<Sum>& matrix, std::size_t n);
/// Cofactors over the determinant, cancelled; the determinant must not be zero.
std::vector<Sum> inverse_matrix(const std::vector<Sum>& matrix, std::size_t n);
/// M_ik = d2T/dqdot_i dqdot_k.
std::vector<Sum> mass_matrix(GinacBridge& bridge, const Sum& kinetic, const std::vector<std::uint32_t>& coordinates);

}  // namespace eomgen::reading
