// SPDX-License-Identifier: GPL-3.0-or-later
// theta = S q with constant S: the coordinates in which positions are simplest. Relative angles of a chain enter
// positions only as their running sums; relative displacements likewise. In these sums the mass matrix is that of the
// absolute description, M_q = S^T M_theta S, and far cheaper to form and to solve.
#pragma once

#include <vector>

#include "mechanics/mechanics.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::derive {

using mechanics::Vec3;
using symbolic::Dag;
using symbolic::Rational;
using symbolic::Ref;

struct QuasiCoordinates {
  std::vector<symbolic::Symbol> theta, rate;  // n symbols each; the coordinates themselves if S is the identity
  std::vector<Rational> S, S_inverse;         // n x n row-major; empty for the identity
  std::vector<Ref> value, value_rate;         // theta and its rate as expressions of q and qdot

  bool identity() const { return S.empty(); }
  /// The substitution of theta and its rate by their values.
  symbolic::Substitution back(Dag& dag) const;
  /// d/dt at zero second derivatives of theta; t -> 1.
  symbolic::Derivation bias(Dag& dag) const;
};

/// Rewrites `positions` in the linear forms of the coordinates `of` that they use, if these are independent and as many
/// as the coordinates. Otherwise S is the identity and nothing changes.
QuasiCoordinates quasi_coordinates(Dag& dag, const std::vector<std::uint32_t>& of, std::vector<Vec3>& positions);

}  // namespace eomgen::derive
