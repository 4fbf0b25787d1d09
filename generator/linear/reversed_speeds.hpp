// SPDX-License-Identifier: GPL-3.0-or-later
// Turns of a whole system by pi about an axis of its symmetry, such as the vertical. In: the flow, the angles that the
// turn changes. Out: the speeds that it reverses.
#pragma once

#include "linear/chart.hpp"

namespace eomgen::linear {

/// Of the entries `angles` of z those are turned that are ignorable. Returns the fewest ignorable positions whose
/// speeds change their signs, so that every motion stays one: x and y for an angle about z. Empty if none, or no
/// choice, does.
std::vector<std::size_t> reversed_by_turn(const Flow& flow, const Symmetry& symmetry, const State<Precise>& start,
                                          Setting<Precise> setting, const std::array<std::size_t, 3>& angles,
                                          std::uint64_t seed);

}  // namespace eomgen::linear
