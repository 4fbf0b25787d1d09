// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinates that are given as functions of x1, x2, x3, solved for these: in: q_k = f_k(x1, x2, x3); out: x(q), eq.
// (1.16).
#pragma once

#include <array>
#include <optional>
#include <string>

#include "model/syntax.hpp"

namespace eomgen::model {

inline constexpr std::array<const char*, 3> cartesian_names{"x1", "x2", "x3"};

/// x1, x2, x3 as expressions of `names`, one unknown isolated after another; only functions with one inverse are undone
/// (no even powers, no sin). Nothing where no order of elimination gets through. The caller checks the result by
/// values.
std::optional<std::array<Syntax, 3>> invert(const std::array<Syntax, 3>& f, const std::array<std::string, 3>& names);

}  // namespace eomgen::model
