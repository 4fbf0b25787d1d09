// SPDX-License-Identifier: GPL-3.0-or-later
// What the judge's statements of forces are made of: a vector at a point, a moment on a body, or a tension times a
// virtual extension. In: a Model and a state. Out: the generalised forces, Q_i = F . dr/dq_i, (2.74), subtracted from
// the sums; and potential energies, term by term.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "verify/argument.hpp"
#include "verify/plain_forces.hpp"

namespace eomgen::verify {

class VirtualWork {
 public:
  VirtualWork(const model::Model& given, const Precision& digits, Interpreter& at, std::vector<Residual>& residuals)
      : model(given), precision(digits), now(at), by_q(at.by_coordinates(false)), sums_(residuals) {}

  const model::Model& model;
  const Precision& precision;
  Interpreter& now;   // values at the state
  Interpreter& by_q;  // and with the coordinates on a new level

  /// Values a moment later; the rate of one is its slope on later().level().
  Interpreter& later() { return now.along_time(); }
  Vector velocity(model::NodeId point) { return rate(later().vector(point)); }
  Vector velocity_of_place(std::uint32_t place) { return rate(later().place(place)); }

  /// F at r: F . dr/dq_i; the size of the term is that of its factors.
  void apply(const Vector& force, const Vector& r);
  /// M on a frame: M . dw/dqdot_i. Nothing on the ground.
  void turn(const Vector& moment, std::uint32_t frame);
  /// A generalised force on x: F dx/dq_i.
  void work(const Jet& force, const Jet& x);
  /// A generalised force along a coordinate.
  void along(std::uint32_t coordinate, const Jet& force) { sums_[coordinate].add(-force.real()); }
  /// Newton's attraction along d, on both ends.
  void attract(const Jet& strength, const Vector& d, const Vector& d_by_q);
  /// Tension K e through de, and what a stiffness that depends on the place adds.
  void stretch(const Jet& stiffness, const Jet& extension);
  /// The same along a vector: K d through dd.
  void stretch(const Jet& stiffness, const Vector& d);
  /// -dU of an energy.
  void descend(const Jet& energy) { work(Jet(-1), energy); }

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
