// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that hang on one another: where every coordinate theta_a moves all the particles beyond it by one and the
// same vector J_a = dr/dtheta_a, the particles form a tree of links, and the equations need each J_a once:
//   M_ab = (mass beyond the outer of a, b) J_a . J_b,   h_a = J_a . sum_beyond m (bias acceleration - g).
// This is the recursive Newton-Euler and composite-body scheme (Featherstone 2008, ch. 5, 6) for particles.
#pragma once

#include <optional>
#include <vector>

#include "derive/trees/quasi_coordinates.hpp"

namespace eomgen::derive {

using mechanics::Mechanics;

/// A particle as the coordinates `of` move it; everything in theta, rates of theta and time.
struct TreeParticle {
  Ref mass;
  Vec3 position, velocity, bias;  // bias: acceleration with the second rates of theta at zero
};

/// Coordinates that move the same particles.
struct Link {
  std::vector<std::size_t> joints;     // indices of theta, ascending
  std::vector<std::size_t> particles;  // that no link further out moves
  int parent = -1;                     // index of a link before this one
  Ref mass_beyond;                     // of all particles that it moves
};

struct Branches {
  QuasiCoordinates coordinates;
  std::vector<TreeParticle> particles;
  std::vector<Vec3> J;          // per theta
  std::vector<std::size_t> of;  // link of each theta
  std::vector<Link> links;      // parents first
  Vec3 gravity;                 // acceleration, of uniform gravity
  std::vector<Ref> f;           // per theta: the forces beside gravity, S^-T (Q - dU/dq)

  /// True where link `outer` is `inner` or hangs on it.
  bool beyond(std::size_t outer, std::size_t inner) const;
};

/// The tree that the coordinates `of` see; with `imposed`, the eliminated coordinates are functions of time. Nothing
/// where the particles are no tree, or where kinetic energy was given beside them. Where it was given alone they are
/// those of point_energies.hpp.
std::optional<Branches> branches(Mechanics& mechanics, const std::vector<std::uint32_t>& of, bool imposed);

}  // namespace eomgen::derive
