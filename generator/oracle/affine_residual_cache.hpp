// SPDX-License-Identifier: GPL-3.0-or-later
// The terms of the oracle at one state that are independent of accelerations and constraint forces. d'Alembert's
// residuals are affine in these, so that each further evaluation at this state takes only products of numbers. In: the
// Oracle and a State. Out: the residuals at zero acceleration, the contribution of accelerations, constraint gradients.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "oracle/dalembert.hpp"

namespace eomgen::verify {

/// The mass matrix, for sum_k M_ik qddot_k with the sizes of its terms.
class Inertia {
 public:
  explicit Inertia(std::size_t n) : rows_(n) {}
  /// Adds a particle or a body: `tangent` are its displacements along the coordinates `along`, `momentum` its momenta
  /// for unit rates of these coordinates.
  void add(const std::vector<std::size_t>& along, const std::vector<Vector>& tangent,
           const std::vector<Vector>& momentum);
  /// Adds an entry from an energy that the model states directly; the sum itself is its size.
  void add_energy(std::size_t i, std::size_t k, const Real& entry);
  std::vector<Residual> multiply(const std::vector<Real>& qddot) const;

 private:
  struct Entry {
    Real value = 0, size = 0;
    Real energy = 0;
  };
  std::vector<std::map<std::size_t, Entry>> rows_;
};

class AffineResidualCache {
 public:
  AffineResidualCache(const Oracle& oracle, const State& at);

  /// psi and psi_dot; psi is 0 for a constraint on velocities.
  struct PathValues {
    Real psi = 0, rate = 0;
  };

  const State state;  // without accelerations
  Interpreter& now() { return now_; }
  const KinkMargin& margin() const { return margin_; }  // over all terms that were evaluated so far
  const Inertia& inertia();
  const std::vector<Residual>& offset();  // at zero acceleration, without friction and constraint forces
  const std::vector<Real>& gradient(std::size_t constraint);
  const PathValues& path_values(std::size_t constraint);
  const Real& psi_ddot_offset(std::size_t constraint);  // psi_ddot at zero acceleration

 private:
  void evaluate_residuals();
  void add_particles();
  void add_rotations();
  void add_energies();

  const Oracle& oracle_;
  const model::Model& model_;
  KinkMargin margin_;
  Interpreter now_;
  std::optional<Inertia> inertia_;
  std::vector<Residual> offset_;
  std::vector<std::optional<std::vector<Real>>> gradient_;
  std::vector<std::optional<PathValues>> path_values_;
  std::vector<std::optional<Real>> psi_ddot_offset_;
};

}  // namespace eomgen::verify
