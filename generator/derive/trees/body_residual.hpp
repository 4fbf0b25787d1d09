// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of a tree of bodies as forces at given accelerations, and their derivatives by the state (Carpentier
// and Mansard 2018; Singh, Russell and Wensing 2022), on expressions, all along the axes of the links. A coordinate or
// rate disturbs the motion of its link. The links beyond it feel the disturbance as a rotating frame feels its base,
// which three vectors describe; composite quantities give the forces that it needs.
#pragma once

#include <optional>

#include "derive/imposition.hpp"

namespace eomgen::derive {

/// The residual in the free coordinates. Empty if the bodies form no tree (body_tree.hpp), if a link is not carried by
/// the rotation of its parent, if Euler parameters are coordinates, or if inertia has kinks.
std::optional<system::Residual> body_residual(Mechanics& mechanics);

}  // namespace eomgen::derive
