// SPDX-License-Identifier: GPL-3.0-or-later
// Components of the linear momentum G = sum m v and of the angular momentum H = sum r x m v about the origin, along E1,
// E2, E3, that no motion changes (docs/theory.md, "Conserved quantities"). In: an EquationSystem. Out: Conserved, with
// the size of its terms.
#pragma once

#include "conservation/conserved.hpp"

namespace eomgen::conservation {

/// Such a component is conserved if a displacement of everything along E_k (or a rotation of everything about it) is
/// one that the coordinates and the constraints allow at fixed t, and no applied force works on it. Constant ones, and
/// those that are +- another of `known`, are left out. Not looked for beyond `most_coordinates` and where [energy] adds
/// to T.
std::vector<Conserved> conserved_momenta(mechanics::Mechanics& mechanics, const system::EquationSystem& system,
                                         const std::vector<Conserved>& known);

inline constexpr std::size_t most_coordinates = 30;

}  // namespace eomgen::conservation
