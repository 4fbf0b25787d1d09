// SPDX-License-Identifier: GPL-3.0-or-later
// The vector field of the equations of motion at a point and its Jacobian: (q, v, s) -> (v, a, s') with M a = f + A^T
// lambda and A a + gamma = 0, differentiated with a and lambda as functions of the point, and the rates s' of the
// declared states of first order. In: an EquationSystem, and the modes of its contacts.
#pragma once

#include <memory>
#include <string>

#include "linear/held_equations.hpp"
#include "linear/tape.hpp"
#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::linear {

/// z = (q, v, s, t) of the free coordinates and the declared states of first order.
template <class T>
using State = std::vector<T>;

/// Quantities that stay constant while the state varies.
template <class T>
struct Setting {
  std::vector<T> parameters, inputs;
  std::vector<T> held;         // per Model::states: integrals of functions of time, discrete values; 0 for other states
  std::vector<T> leaf;         // values of the integrals of constraints on velocities
  std::vector<T> curves = {};  // HeldCurve::tangent of each; Flow::at computes them
};

template <class T>
struct Field {
  Matrix<T> X;                            // N x 1: v, a, s'
  Matrix<T> jacobian;                     // N x (N + 1), with respect to z
  Matrix<T> input_jacobian;               // N x inputs
  Matrix<T> phi;                          // constraints on positions (holonomic, then leaves), then on velocities
  Matrix<T> phi_jacobian;                 // by z
  Matrix<T> inertia_force = {};           // M a, n x 1; in binary64 only
  Matrix<T> inertia_force_jacobian = {};  // n x (N + 1)
  Matrix<T> forces = {};                  // of Flow::forces(), m x 1
  Matrix<T> force_jacobian = {};          // m x (N + 1 + inputs), by z, then the inputs
  Matrix<T> undetermined = {};            // m x k: changes of the forces that leave the motion as it is
};

class Flow {
 public:
  /// `modes`: of the contacts of the system, which are held.
  Flow(mechanics::Mechanics& mechanics, const system::EquationSystem& system, const std::vector<HeldMode>& modes = {});

  std::size_t coordinates() const { return n_; }
  std::size_t entries() const { return symbols_.size(); }  // N: of z without t
  std::size_t inputs() const { return inputs_; }
  std::size_t position_constraint_count() const { return position_constraints_; }
  /// Multipliers of the active constraints; with contacts also the components of their forces.
  const std::vector<Symbol>& forces() const { return forces_; }
  const std::vector<HeldContact>& contacts() const { return contacts_; }
  const std::vector<std::string>& names() const { return names_; }  // of z without t
  Ref entry(std::size_t place) const { return entries_[place]; }    // of z, as an expression
  const std::vector<Symbol>& symbols() const { return symbols_; }   // of z without t
  bool uses_integrals() const { return uses_integrals_; }

  /// Throws std::domain_error if the field has no value or no derivative.
  template <class T>
  Field<T> at(const State<T>& z, const Setting<T>& setting) const;

  /// Throws std::domain_error where the coordinates are singular: where the rounding of a coordinate to binary64 leaves
  /// fewer digits of the inertia along one than A is printed in. Contacts are not examined.
  void require_regular(const State<Precise>& z, const Setting<Precise>& setting) const;

  /// The constraint part of the field alone.
  template <class T>
  Field<T> constraints_at(const State<T>& z, const Setting<T>& setting) const;

  /// Values of the integrals that define the leaf of a state.
  template <class T>
  std::vector<T> leaf(const State<T>& z, const Setting<T>& setting) const;

  /// Values and Jacobian of a tape. If a formula has none but its limits from all sides agree, the limits are returned:
  /// the root in |v| v at rest, a distance that goes through 0. Throws std::domain_error if they do not agree.
  template <class T>
  ValueAndJacobian<T> value_and_jacobian(const Tape& tape, const State<T>& z, const Setting<T>& setting) const;

  /// A tape of other expressions of the system, with derivatives with respect to z.
  Tape tape(std::vector<Ref> expressions) const;
  template <class T>
  std::function<T(const Symbol&)> lookup(const State<T>& z, const Setting<T>& setting) const;

  const std::vector<Ref>& phi_expressions() const { return phi_expressions_; }  // leaves without their constants

 private:
  template <class T>
  void differentiate(const ValueAndJacobian<T>& s, const State<T>& z, Field<T>& field) const;
  template <class T>
  Matrix<T> matrix(const ValueAndJacobian<T>& s) const;
  template <class T>
  ValueAndJacobian<T> held_values(const State<T>& z, const Setting<T>& setting) const;
  template <class T>
  std::vector<T> tangents(const ValueAndJacobian<T>& s) const;
  template <class T>
  Elimination<T> eliminate_held(const ValueAndJacobian<T>& s, Matrix<T>& right) const;
  template <class T>
  void differentiate_held(const ValueAndJacobian<T>& s, const State<T>& z, Field<T>& field) const;
  template <class T>
  void fill(const Matrix<T>& y, const Matrix<T>& jacobian, const State<T>& z, Field<T>& field) const;
  template <class T>
  void fill_first_order(const ValueAndJacobian<T>& s, std::size_t rates, Field<T>& field) const;
  template <class T>
  void constrain_held(const State<T>& z, const Setting<T>& setting, Field<T>& field) const;
  struct Places {
    std::size_t A, b, psi;
  };
  template <class T>
  void constrain(const ValueAndJacobian<T>& s, const Places& places, const State<T>& z, const Setting<T>& setting,
                 Field<T>& field) const;

  const system::EquationSystem& system_;
  std::size_t n_, m_, inputs_ = 0;
  std::vector<std::size_t> holonomic_;  // of the active constraints
  std::size_t position_constraints_ = 0;
  bool held_ = false;  // the system has contacts
  std::vector<HeldContact> contacts_;
  std::vector<Symbol> forces_;
  std::vector<std::string> curves_;  // names of the contacts that slide on curves
  std::size_t curve_roots_ = 0;      // of tape_: where those of the curves begin
  std::vector<Ref> leaf_;
  std::vector<Ref> phi_expressions_;
  std::vector<std::string> names_;
  std::vector<Ref> entries_;
  std::vector<Symbol> symbols_;
  std::vector<double> scales_;            // a change of each coordinate that is never small, or 0 if there is none
  std::vector<std::size_t> place_;        // index in z of a coordinate of the model
  std::vector<std::size_t> state_place_;  // index in z of a declared state of the model
  std::vector<Symbol> directions_;        // z, then inputs
  bool uses_integrals_ = false;
  std::unique_ptr<Tape> tape_, constraint_tape_, leaf_tape_;
};

}  // namespace eomgen::linear
