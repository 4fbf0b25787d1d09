// SPDX-License-Identifier: GPL-3.0-or-later
// What the judge finds at one state whatever the accelerations and the constraint forces are: d'Alembert's residuals
// are affine in them, so that each further question at this state costs products of numbers only. In: a Judge and a
// State. Out: the residuals without accelerations, what accelerations add, rows of the constraints.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "verify/dalembert.hpp"

namespace eomgen::verify {

/// sum_k M_ik qddot_k, with the sizes of its terms.
class Inertia {
 public:
  explicit Inertia(std::size_t n) : rows_(n) {}
  /// A mass or a body whose displacements along the coordinates `along` are `tangent`, and what those make of its
  /// momentum.
  void add(const std::vector<std::size_t>& along, const std::vector<Vector>& tangent,
           const std::vector<Vector>& momentum);
  /// Of energies that are given as such: their sizes are those of the sums.
  void add_energy(std::size_t i, std::size_t k, const Real& entry);
  std::vector<Residual> at(const std::vector<Real>& qddot) const;

 private:
  struct Entry {
    Real value = 0, size = 0;
    Real energy = 0;
  };
  std::vector<std::map<std::size_t, Entry>> rows_;
};

class Standing {
 public:
  Standing(const Judge& judge, const State& at);

  /// psi and psi_dot; psi is 0 of a constraint on velocities.
  struct Along {
    Real psi = 0, rate = 0;
  };

  const State state;  // without accelerations
  Interpreter& now() { return now_; }
  const Margin& margin() const { return margin_; }  // of all that was looked at so far
  const Inertia& inertia();
  const std::vector<Residual>& rest();  // everything but friction and constraint forces
  const std::vector<Real>& row(std::size_t constraint);
  const Along& along(std::size_t constraint);
  const Real& second(std::size_t constraint);  // psi_ddot without accelerations

 private:
  void look();
  void add_particles();
  void add_rotations();
  void add_energies();

  const Judge& judge_;
  const model::Model& model_;
  Margin margin_;
  Interpreter now_;
  std::optional<Inertia> inertia_;
  std::vector<Residual> rest_;
  std::vector<std::optional<std::vector<Real>>> row_;
  std::vector<std::optional<Along>> along_;
  std::vector<std::optional<Real>> second_;
};

}  // namespace eomgen::verify
