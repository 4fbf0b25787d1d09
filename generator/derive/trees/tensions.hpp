// SPDX-License-Identifier: GPL-3.0-or-later
// A tree of particles as links that transmit forces: the directions of these forces, and the accelerations that follow.
#pragma once

#include <optional>

#include "derive/trees/particle_tree.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// One link with its particle. Vectors are in theta and its rate.
struct TensionLink {
  int parent = -1;
  Ref inverse_mass_ratio;           // m_first / m_k: dimensionless inverse mass
  std::vector<std::size_t> joints;  // indices of theta
  std::vector<Vec3> J;
  std::vector<Vec3> N;  // the directions of force: normal to all J, and to one another
  Vec3 c;               // acceleration relative to the parent at zero second derivatives
};

struct TensionLinks {
  std::vector<TensionLink> links;  // parents first
  Ref first_mass;
};

/// Empty if a link has no particle or several, a mass that varies or is zero, or directions of force that are not
/// known.
std::optional<TensionLinks> tension_links(Dag& dag, const ParticleTree& tree);

/// The second derivatives of theta, as expressions in theta and its rate.
system::Solution tree_accelerations(Dag& dag, const ParticleTree& tree, const TensionLinks& links);

/// The tensions of the tree of the free coordinates as unknowns, in the coordinates of the model. Empty if a condition
/// of `articulated` is not met, and for a single link.
std::optional<system::InternalForces> tree_tensions(Mechanics& mechanics);

}  // namespace eomgen::derive
