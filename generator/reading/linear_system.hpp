// SPDX-License-Identifier: GPL-3.0-or-later
// Small symbolic linear systems. In: sums that are linear in some symbols. Out: these symbols as functions of the
// others, with common factors cancelled. Single entries and pivots that are parameters are eliminated first; the rest
// is solved by Cramer's rule.
#pragma once

#include <optional>
#include <vector>

#include "reading/sum.hpp"

namespace eomgen::reading {

/// The unknowns as functions of the other symbols; nullopt for those that the equations leave undetermined, and for
/// those that depend on them. Throws work::BudgetExceeded if the equations couple too many unknowns, or if they are not
/// linear in them.
std::vector<std::optional<Sum>> solve_linear(const std::vector<Sum>& equations, const std::vector<Symbol>& unknowns);

}  // namespace eomgen::reading
