// SPDX-License-Identifier: GPL-3.0-or-later
// ConservedQuantity components of the linear momentum G = sum m v and of the angular momentum H = sum r x m v about the
// origin, along E1, E2, E3 (docs/theory.md, "Conserved quantities"). In: an EquationSystem. Out: ConservedQuantity,
// with the magnitude of its terms.
#pragma once

#include "conservation/conserved.hpp"

namespace eomgen::conservation {

/// A component is conserved if the coordinates and the constraints allow a translation of the whole system along E_k
/// (or a rotation about it) at fixed t, and no applied force does work on it. Constant components, and those that equal
/// +- another of `known`, are omitted. Not searched beyond `max_momentum_coordinates` or if [energy] adds to T.
std::vector<ConservedQuantity> conserved_momenta(mechanics::Mechanics& mechanics, const system::EquationSystem& system,
                                                 const std::vector<ConservedQuantity>& known);

inline constexpr std::size_t max_momentum_coordinates = 30;

}  // namespace eomgen::conservation
