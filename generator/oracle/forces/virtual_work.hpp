// SPDX-License-Identifier: GPL-3.0-or-later
// The elements of the oracle's force laws: a force at a point, a moment on a body, or a tension times a virtual
// extension. In: a Model and a state. Out: the generalised forces, Q_i = F . dr/dq_i, (2.74), subtracted from the sums;
// and potential energies, term by term.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "oracle/applied_forces.hpp"
#include "oracle/argument.hpp"

namespace eomgen::verify {

class VirtualWork {
 public:
  VirtualWork(const model::Model& given, const Precision& digits, Interpreter& at, std::vector<Residual>& residuals)
      : model(given), precision(digits), now(at), by_q(at.with_coordinate_slopes(false)), sums_(residuals) {}

  const model::Model& model;
  const Precision& precision;
  Interpreter& now;   // values at the state
  Interpreter& by_q;  // the same with the coordinates on a new level

  /// Values with time on a new level: the rate of a value is its slope on this level.
  Interpreter& with_time_slope() { return now.with_time_slope(); }
  Vector velocity(model::NodeId point) { return rate(with_time_slope().vector(point)); }
  Vector velocity_of_place(std::uint32_t place) { return rate(with_time_slope().place(place)); }

  /// Adds F at r: F . dr/dq_i; the size of the term is the product of the sizes of its factors.
  void apply_force(const Vector& force, const Vector& r);
  /// Adds a moment M on a frame: M . dw/dqdot_i; nothing for the ground.
  void apply_moment(const Vector& moment, std::uint32_t frame);
  /// Adds a generalised force on x: F dx/dq_i.
  void apply_generalized_force(const Jet& force, const Jet& x);
  /// Adds a generalised force along a coordinate.
  void apply_to_coordinate(std::uint32_t coordinate, const Jet& force) { sums_[coordinate].add(-force.real()); }
  /// Adds Newton's attraction along d, on both ends.
  void apply_attraction(const Jet& strength, const Vector& d, const Vector& d_by_q);
  /// Adds the tension K e along de, and the contribution of a stiffness that depends on the position.
  void apply_elastic_force(const Jet& stiffness, const Jet& extension);
  /// The same along a vector: K d along dd.
  void apply_elastic_force(const Jet& stiffness, const Vector& d);
  /// Adds -dU of a potential energy U.
  void apply_potential(const Jet& energy) { apply_generalized_force(Jet(-1), energy); }

 private:
  Vector rate(const Vector& r) const;
  std::set<std::size_t> directions(const std::vector<const Jet*>& jets) const;
  std::vector<Residual>& sums_;
};

struct Potentials {
  const model::Model& model;
  const Precision& precision;
  Interpreter& at;
  std::vector<Jet>& terms;

  void add(const Jet& term) { terms.push_back(term); }
};

}  // namespace eomgen::verify
