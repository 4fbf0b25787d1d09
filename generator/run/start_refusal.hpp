// SPDX-License-Identifier: GPL-3.0-or-later
// Why a start cannot be: the constraint that it breaks, by how much, and what to do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "run/start_rows.hpp"

namespace eomgen::run {

/// Columns whose part outside the span of the others is smaller than this (relative) do not fix their coordinate.
inline constexpr double start_rank_tolerance = 1e-10;

/// Row k of this order does not hold, whatever the unknowns are; `free`: places of these among the free coordinates.
/// Throws Error.
[[noreturn]] void refuse_start(const StartProblem& problem, const StartRows& rows, std::uint8_t order, std::size_t k,
                               const std::vector<std::size_t>& free);

}  // namespace eomgen::run
