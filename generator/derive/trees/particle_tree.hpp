// SPDX-License-Identifier: GPL-3.0-or-later
// Trees of particles. If every coordinate theta_a moves all particles beyond it by the same vector J_a = dr/dtheta_a,
// the particles form a tree of links, and the equations need each J_a once:
//   M_ab = (mass beyond the outer of a, b) J_a . J_b,   h_a = J_a . sum_beyond m (bias acceleration - g).
// This is the recursive Newton-Euler and composite-body scheme (Featherstone 2008, ch. 5, 6) for particles.
#pragma once

#include <optional>
#include <vector>

#include "derive/trees/quasi_coordinates.hpp"

namespace eomgen::derive {

using mechanics::Mechanics;

/// A particle as a function of the coordinates `of`; all quantities in theta, rates of theta and time.
struct TreeParticle {
  Ref mass;
  Vec3 position, velocity, bias;  // bias: acceleration at zero second derivatives of theta
};

/// Coordinates that move the same particles.
struct Link {
  std::vector<std::size_t> joints;     // indices of theta, ascending
  std::vector<std::size_t> particles;  // those that no outer link moves
  int parent = -1;                     // index of a link before this one
  Ref mass_beyond;                     // of all particles it moves
};

struct ParticleTree {
  QuasiCoordinates coordinates;
  std::vector<TreeParticle> particles;
  std::vector<Vec3> J;               // per theta
  std::vector<std::size_t> link_of;  // link of each theta
  std::vector<Link> links;           // parents first
  Vec3 gravity;                      // acceleration, of uniform gravity
  std::vector<Ref> f;                // per theta: the forces without gravity, S^-T (Q - dU/dq)

  /// Whether link `outer` is `inner` or one of its descendants.
  bool is_beyond(std::size_t outer, std::size_t inner) const;
};

/// The tree for the coordinates `of`. With `imposed`, the eliminated coordinates are functions of time. Empty if the
/// particles form no tree, or if kinetic energy is given besides them. If it is given alone, the particles are those
/// whose energy it is.
std::optional<ParticleTree> particle_tree(Mechanics& mechanics, const std::vector<std::uint32_t>& of, bool imposed);

}  // namespace eomgen::derive
