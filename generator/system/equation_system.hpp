// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion of the free coordinates, as every formulation of derive returns them,
//   M(q,t) qddot = f(q,qdot,t,u) + A^T lambda,   A qddot + gamma = 0   (index-1 form, docs/theory.md),
// as Dag expressions in t, q, qdot of the free coordinates, states of first order, parameters and inputs only.
// Functions of time are expanded and eliminated coordinates are substituted.
#pragma once

#include <array>
#include <cstdint>
#include <eom/contacts/description.hpp>
#include <eom/layout.hpp>
#include <eom/modes/mode_array.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "symbolic/factorisation.hpp"
#include "system/array_loops.hpp"
#include "system/output.hpp"

namespace eomgen::system {

using symbolic::Dag;
using symbolic::Ref;

enum class Approach { one, two };
const char* name(Approach approach);  // "I", "II"

/// The method for constraints with multipliers: the Schur complement A M^-1 A^T, a null space of A, or solution for the
/// dependent velocities.
enum class Form { multipliers, nullspace, chaplygin };
const char* name(Form form);  // "multipliers", "nullspace", "chaplygin"

/// lambda of one constraint. For an active constraint it is the multiplier symbol. For an eliminated one it is an
/// expression in qddot (free) and the multipliers of the active constraints (the "(b)" equations of Approach I).
struct Reaction {
  std::uint32_t constraint;  // index into Mechanics::constraints
  std::string label;
  Ref value;
};

/// Equations in quasi-velocities theta_dot = S qdot with constant S: M = S^T M_theta S, f = S^T f_theta. They are
/// cheaper to solve if M_theta is the simpler matrix (relative angles).
struct QuasiVelocityEquations {
  std::vector<symbolic::Rational> S_inverse;  // n x n row-major
  std::vector<Ref> M, f;                      // n x n, n
};

/// The forces between the links of a tree, for which its formulation solves first: matrix forces = side. They are
/// symbols of their own in the accelerations only.
struct InternalForces {
  std::vector<symbolic::Symbol> symbols;  // k
  std::vector<Ref> matrix, side;          // k x k row-major, symmetric and positive definite; k
  std::vector<Ref> values;                // k: the solution
  std::vector<Ref> qddot;                 // n, linear in the symbols
};

/// The solution, if the formulation solves the equations itself.
struct Solution {
  std::vector<Ref> qddot;   // n, without accelerations and multipliers
  std::vector<Ref> lambda;  // m
  std::vector<symbolic::Pivot> pivots;
  std::optional<InternalForces> forces = {};  // for derivatives
};

/// The equations as forces that vanish, inertia - applied = A^T lambda, with the accelerations as symbols of their own
/// (order 2 of each coordinate): inertia = M qddot + h. Its derivatives are those at fixed accelerations.
struct Residual {
  std::vector<Ref> inertia, applied;  // n
  std::vector<Ref> by_q, by_qdot;     // n x n row-major: d inertia_i/dq_j, d inertia_i/dqdot_j
  // If the formulation solves for them itself, and otherwise empty: -M^-1 by_q, -M^-1 by_qdot, and M^-1 if `applied`
  // is not 0.
  std::vector<Ref> qddot_by_q, qddot_by_qdot, M_inverse;
  // -M^-1 by_q, -M^-1 by_qdot in loops, with the slopes of `applied`: may be empty.
  std::optional<AccelerationSlopes> slopes;
  std::vector<symbolic::Pivot> pivots;
  // The same equations, M qddot = f, and their solution, with most expressions in common: may be empty.
  std::vector<Ref> M, f, qddot;
};

/// A state of first order, with derivative `rate`: declared by the model, or an integral of a function of time without
/// a closed form.
struct FirstOrderState {
  symbolic::Symbol symbol;  // SymbolKind::state or integral; its index is that into Model::states
  Ref rate;                 // of t, q, qdot, parameters, inputs and states of first order
};

/// Simultaneous changes of the state x. Values depend on t, x, parameters and inputs before the change.
struct Reset {
  struct Entry {
    std::size_t component;  // of x
    Ref value;
  };
  std::vector<Entry> set = {};
  std::optional<Ref> condition = {};  // 1 where the reset is made, else 0

  bool empty() const { return set.empty() && !condition; }
};

struct Event {
  std::string name;
  Ref value;         // the event occurs at its sign changes; may depend on qddot of free coordinates and multipliers
  Reset reset = {};  // its condition holds for the whole event
};

/// A change at the times of Model::samples[i].
struct Sample {
  std::string name;
  Reset reset;
};

/// A direction of a contact that another constraint blocks: phi has no component along it while the contact sticks and
/// contact `by` is closed. See mechanics::BlockedDirection.
struct BlockedDirection {
  std::uint32_t by = 0;    // index into EquationSystem::contacts; its own index: always blocked
  std::vector<Ref> along;  // per tangent
};

/// A contact with friction, or a unilateral contact (docs/theory.md, "Friction"). The friction force sum_a phi_a t_a
/// enters f and the reactions with the symbols phi_a = {SymbolKind::friction, first + a}. The law for phi_a depends on
/// the mode.
struct Contact {
  std::string name;
  std::uint32_t first = 0;               // index of the first phi
  std::vector<std::uint32_t> reactions;  // indices into EquationSystem::reactions; empty: the normal force is given
  std::vector<Ref> gram;                 // |normal force|^2 = lambda^T gram lambda
  Ref normal;                            // the given normal force
  std::vector<Ref> slip, slip_rate;      // per tangent; the rate may depend on qddot
  std::vector<BlockedDirection> blocked;
  std::vector<std::array<Ref, 3>> directions;  // t_a; empty for friction on a coordinate
  Ref static_coefficient, dynamic_coefficient;
  std::optional<Ref> width;                 // of the regularised law, which has no static coefficient
  std::optional<std::uint32_t> unilateral;  // the active constraint that can open
  Ref restitution;                          // of impacts of a unilateral contact
  bool rolls = false;                       // sticking is rolling

  bool can_stick() const { return !slip.empty() && !width; }
  eom::ContactShape shape() const {
    return {slip.size(), reactions.size() == 1 && !unilateral && !slip.empty(), unilateral.has_value(), can_stick(),
            rolls};
  }
};

/// A velocity that a contact restricts: rate = slopes . qdot + .., acceleration = slopes . qddot + bias.
struct ContactRow {
  Ref rate, bias;
  std::vector<Ref> slopes;  // n
};

/// A contact whose forces are inputs (mechanics/contact_forces.hpp): what a run needs to solve for them.
struct ContactWithInputs {
  std::string name;
  bool unilateral = false;                      // it can open
  bool rolls = false;                           // sticking is rolling
  Ref gap;                                      // psi of its constraint; 0 without one
  std::optional<ContactRow> normal;             // of its constraint; none: the normal force is given
  Ref normal_scale;                             // |normal force| = normal_scale |lambda|
  Ref given_normal;                             // the given normal force
  std::vector<ContactRow> slip;                 // per tangent
  Ref static_coefficient, dynamic_coefficient;  // of friction
  std::optional<Ref> width;                     // of the regularised law
  Ref restitution;
  std::uint32_t friction_input = 0;  // of the first component; that of the mode follows them
  std::uint32_t force_input = 0;     // of lambda, with a constraint

  std::uint32_t mode_input() const { return friction_input + static_cast<std::uint32_t>(slip.size()); }
};

/// Symbols of the mode of a contact. slip_direction_symbol: 1 slides along its tangent, -1 against it, 0 sticks.
/// normal_sign_symbol: the sign of the normal force; for a unilateral contact 1 closed, -1 open.
inline symbolic::Symbol slip_direction_symbol(std::uint32_t contact) {
  return {symbolic::SymbolKind::contact_mode, contact, 0};
}
inline symbolic::Symbol normal_sign_symbol(std::uint32_t contact) {
  return {symbolic::SymbolKind::contact_mode, contact, 1};
}

/// A constraint that follows from the active ones. Runs monitor psi, and initial states satisfy it.
struct RedundantConstraint {
  std::uint32_t constraint;  // index into Mechanics::constraints
  Ref psi;
  std::vector<Ref> A;  // n
  Ref b;
};

struct EquationSystem {
  // Defined in the .cpp file, so that they are compiled only once.
  EquationSystem();
  EquationSystem(const EquationSystem&);
  EquationSystem(EquationSystem&&) noexcept;
  EquationSystem& operator=(const EquationSystem&);
  EquationSystem& operator=(EquationSystem&&) noexcept;
  ~EquationSystem();

  std::shared_ptr<Dag> dag;
  std::string formulation;  // "lagrange", "jacobian"
  Approach approach = Approach::two;
  Form form = Form::multipliers;

  std::vector<std::uint32_t> free;    // n coordinates of the model, ascending; state x = (q_free, qdot_free, states)
  std::vector<std::uint32_t> active;  // m constraints with multipliers

  std::vector<FirstOrderState> states;
  std::vector<Ref> M;           // n x n, row-major, symmetric
  std::vector<Ref> f;           // n
  std::vector<bool> holonomic;  // m: false for constraints on velocities, whose psi is 0
  std::vector<Ref> psi;         // m
  std::vector<Ref> A;           // m x n, row-major
  std::vector<Ref> b;           // m: A qdot + b = 0
  std::vector<Ref> gamma;       // m: A qddot + gamma = 0
  std::vector<RedundantConstraint> redundant;
  std::vector<Ref>
      contact_open;  // m, or empty: 1 if the contact of a constraint is open; its row of A and gamma is then 0

  std::optional<QuasiVelocityEquations> quasi;  // equivalent equations in quasi-velocities
  std::optional<Solution> solution;             // equal to the solution from M, f, A, gamma
  std::optional<Residual> residual;             // equal to M qddot - f

  std::vector<Contact> contacts;                                // their forces are solved for
  std::vector<ContactWithInputs> contacts_with_inputs;          // their forces are inputs: one of both lists is empty
  std::map<symbolic::Symbol, symbolic::Symbol> contact_inputs;  // the inputs of those forces
  eom::contacts::ImpactLaw impact_law = eom::contacts::ImpactLaw::newton;
  eom::contacts::ImpactOrder impact_order = eom::contacts::ImpactOrder::simultaneous;

  bool has_contacts() const { return !contacts.empty() || !contacts_with_inputs.empty(); }

  std::vector<Reaction> reactions;        // all constraints, in model order
  std::vector<Output> outputs;            // all available outputs, in the order of docs/model-format.md
  std::vector<Event> events;              // in model order
  std::vector<Sample> samples;            // in model order
  Ref energy, kinetic, potential, power;  // power: the expected dE/dt; may depend on multipliers and qddot

  std::size_t discrete = 0;  // how many of `states`, the last ones, are discrete values

  eom::StateLayout layout() const { return {free.size(), states.size() - discrete, discrete}; }
  /// Whether an event or a sample changes the state.
  bool has_resets() const;
  std::vector<symbolic::Symbol> state_symbols() const;  // of `states`
};

}  // namespace eomgen::system
