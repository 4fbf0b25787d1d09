// SPDX-License-Identifier: GPL-3.0-or-later
// Error messages for inconsistent starts: the violated constraint, the violation, and a remedy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "run/start_rows.hpp"

namespace eomgen::run {

/// A coordinate is undetermined if the part of its column outside the span of the others is smaller than this
/// (relative).
inline constexpr double start_rank_tolerance = 1e-10;

/// Throws the Error for row k of this order, which no values of the unknowns satisfy; `free`: the unknowns, as indices
/// of free coordinates. The current values are those of the message, and are lost.
[[noreturn]] void refuse_start(const StartProblem& problem, StartRows& rows, std::uint8_t order, std::size_t k,
                               const std::vector<std::size_t>& free);

/// Throws the Error for a contact of a body whose normal is along the direction that defines its tangents. The current
/// positions are those of the start.
void require_tangents(const StartProblem& problem, const StartRows& rows);

}  // namespace eomgen::run
