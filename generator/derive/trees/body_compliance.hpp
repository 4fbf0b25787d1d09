// SPDX-License-Identifier: GPL-3.0-or-later
// The derivatives of the accelerations of a tree of bodies without its mass matrix. Links react to a disturbance with
// their articulated inertia (body_elimination.hpp). The wrench that a disturbed link passes inwards accelerates the
// links there by their compliance: that of the whole tree at a link follows outwards from link to link, and so do the
// accelerations of a link due to the force on each coordinate further in, which by reciprocity answer the wrench.
#pragma once

#include "derive/trees/link_dynamics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Adds qddot_by_q, qddot_by_qdot and their pivots, and M_inverse if there are applied forces.
void add_compliance(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                    const std::vector<LinkDynamics>& dynamics, system::Residual& residual);

}  // namespace eomgen::derive
