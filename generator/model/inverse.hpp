// SPDX-License-Identifier: GPL-3.0-or-later
// Inversion of coordinates given as functions of x1, x2, x3. In: q_k = f_k(x1, x2, x3). Out: x(q), eq. (1.16).
#pragma once

#include <array>
#include <optional>
#include <string>

#include "model/syntax.hpp"

namespace eomgen::model {

inline constexpr std::array<const char*, 3> cartesian_names{"x1", "x2", "x3"};

/// x1, x2, x3 as expressions of `names`. The unknowns are isolated one after the other; only functions with a unique
/// inverse are inverted (no even powers, no sin). Nothing if no order of elimination succeeds. The caller checks the
/// result numerically.
std::optional<std::array<Syntax, 3>> invert(const std::array<Syntax, 3>& f, const std::array<std::string, 3>& names);

}  // namespace eomgen::model
