// SPDX-License-Identifier: GPL-3.0-or-later
// The independent oracle. In: a Model and a state with accelerations and multipliers. Out: the residual of d'Alembert's
// principle for each coordinate,
//   sum_masses (d(m v)/dt - F) . dr/dq_i + sum_bodies (dH/dt - M) . dw/dqdot_i - Q_i - sum_k lambda_k f_ki ((2.74),
//   (2.163), (2.31), (2.50), (3.20)),
// f_ki = dpsi_k/dq_i, or de_k/dqdot_i of a constraint e_k = 0 on velocities. Energies that the model states directly
// add the Euler-Lagrange residual d/dt(dT/dqdot_i) - dT/dq_i + dU/dq_i. The oracle also computes the constraints and
// the energies with their rates.
//
// The oracle reads the forces from the Model. It includes the Model and jets only: no graph, no computer algebra, no
// mechanics. This independence gives its agreement weight (docs/verification.md).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "oracle/interpreter.hpp"
#include "oracle/quadrature.hpp"

namespace eomgen::verify {

/// A friction force of arbitrary size: the equations must hold for any value, independent of the friction law.
struct FrictionForce {
  std::uint32_t place = 0;                         // of the particle; 0 for friction along a coordinate
  std::uint32_t coordinate = 0;                    // with friction
  std::array<Real, 3> force{};                     // on the particle; force[0] on the coordinate
  std::optional<std::uint32_t> body_contact = {};  // on a body, at the contact of this constraint of the model
};

struct State {
  Real t = 0;
  std::vector<Real> q, qdot, qddot;  // every coordinate of the model
  std::vector<Real> parameters, inputs;
  std::vector<Real> z;                  // per Model::states; empty: all are integrals, which are not computed yet
  std::vector<Real> phi;                // components of friction along the tangents
  std::vector<FrictionForce> friction;  // the forces that belong to phi
  std::vector<int> mode = {};           // state of each contact (eom/modes/contact_state.hpp); empty: all are 0
  std::set<std::size_t> open;           // scalar constraints that are open in this state: inactive and without force
};

/// A sum that should vanish, and the sum of the absolute values of its terms, which determines its rounding error.
struct Residual {
  Real value = 0;
  Real scale = 0;
  void add(const Real& term) { add(term, cln::abs(term)); }
  void add(const Real& term, const Real& size);
  double relative() const;  // |value| / scale; 0 if both are 0
};

/// Values of all K scalar constraints in the order of the model, for N coordinates. A constraint e = 0 on velocities
/// has psi = 0, psi_dot = e.
struct ConstraintValues {
  std::vector<Real> psi, psi_dot, psi_ddot;  // along the path
  std::vector<std::vector<Real>> gradient;   // K x N: dpsi_k/dq_i, de_k/dqdot_i
};

struct EnergyValues {
  Real kinetic = 0, potential = 0, stored = 0;  // T; U of all forces that have a potential; energy of states
  Real kinetic_rate = 0, potential_rate = 0, stored_rate = 0;  // along the path
  Real scale = 0;                                              // sum of the absolute values of their terms
  Real rate_scale = 0;
};

/// An undefined number of the model, such as log(0), with its position in the file.
struct UndefinedValue : Singular {
  UndefinedValue(const char* what, SourceLocation place) : Singular(what), where(std::move(place)) {}
  SourceLocation where;
};

class AffineResidualCache;

class Oracle {
 public:
  Oracle(const model::Model& model, int digits);
  ~Oracle();

  const model::Model& model() const { return model_; }
  const Precision& precision() const { return precision_; }
  int digits() const { return digits_; }
  const std::vector<model::NodeId>& constraints() const { return psi_; }
  bool is_holonomic(std::size_t constraint) const { return holonomic_[constraint]; }
  /// Marks a constraint as implied by the others: it has no force; it is checked, but not solved for.
  void mark_implied(std::size_t constraint) { implied_.insert(constraint); }
  bool is_implied(std::size_t constraint) const { return implied_.contains(constraint); }
  bool has_implied() const { return !implied_.empty(); }
  /// The inputs that hold the forces of contacts (mechanics/contact_forces.hpp). These contacts are open: their
  /// constraints are not imposed, and their forces act as applied ones.
  struct ContactInputs {
    std::map<std::size_t, std::uint32_t> forces;  // of constraints
    std::vector<std::uint32_t> friction;          // of its components phi
  };
  void set_contact_inputs(ContactInputs inputs) { contact_inputs_ = std::move(inputs); }
  const ContactInputs& contact_inputs() const { return contact_inputs_; }
  /// The input that holds the force of a constraint.
  std::optional<std::uint32_t> force_input(std::size_t constraint) const {
    const auto found = contact_inputs_.forces.find(constraint);
    return found == contact_inputs_.forces.end() ? std::nullopt : std::optional(found->second);
  }

  std::vector<Real> default_parameters() const;
  /// All parameters. `given` holds the independent ones; the dependent ones are computed.
  std::vector<Real> parameters(std::vector<Real> given) const;
  bool is_independent_parameter(std::size_t index) const;

  std::vector<Residual> dalembert_residuals(const State& state, const std::vector<Real>& lambda,
                                            KinkMargin* margin = nullptr) const;
  ConstraintValues constraint_values(const State& state, KinkMargin* margin = nullptr) const;
  EnergyValues energy_values(const State& state) const;
  /// Value of an expression of the model, such as an initial value of a scene.
  Real evaluate(model::NodeId expression, const State& state) const;

  /// Value of an expression of parameters alone. Throws UndefinedValue if it is undefined, such as log(0).
  Real evaluate_constant(model::NodeId expression, const std::vector<Real>& parameters) const;
  /// Values per Model::states: declared states as in `state`, integrals at its time and parameters, by quadrature.
  std::vector<Real> with_integrals(const State& state) const;

  Interpreter interpreter(const State& state, KinkMargin* margin = nullptr) const;

 private:
  /// Functions of time and integrals with `orders` derivatives; `z` holds the values of the latter.
  void add_functions(Environment& environment, const std::vector<Real>& z, std::size_t orders) const;
  /// Declared states with their rates, which may depend on everything else.
  void add_states(Environment& environment, const std::vector<Real>& z, KinkMargin* margin) const;
  bool needs_derivatives(model::NodeId expression) const;
  Real integral_value(std::uint32_t integral, const State& state) const;
  void subtract_friction(const State& state, Interpreter& now, std::vector<Residual>& sums) const;
  void subtract_contact(const model::BodyContact& contact, const std::array<Real, 3>& force, Interpreter& now,
                        std::vector<Residual>& sums) const;
  /// The terms that are independent of accelerations and constraint forces, cached for the last state.
  AffineResidualCache& residual_cache(const State& state) const;

  const model::Model& model_;
  int digits_;
  Precision precision_;
  std::vector<model::NodeId> psi_;
  std::vector<bool> holonomic_;
  std::set<std::size_t> implied_;
  ContactInputs contact_inputs_;
  std::optional<GaussLegendre> quadrature_;  // if the model has integrals
  mutable std::unique_ptr<AffineResidualCache> residual_cache_;
};

}  // namespace eomgen::verify
