// SPDX-License-Identifier: GPL-3.0-or-later
// The product of derive's fast routes: the equations of motion of the coordinates that stay,
//   M(q,t) qddot = f(q,qdot,t,u) + A^T lambda,   A qddot + gamma = 0   (index-1 form, docs/theory.md),
// as Dag expressions in the symbols t, q, qdot of the free coordinates, parameters and inputs only: functions of time
// are written out and eliminated coordinates are replaced by theirs.
#pragma once

#include <array>
#include <cstdint>
#include <eom/modes/contact_state.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "symbolic/factorisation.hpp"
#include "system/output.hpp"

namespace eomgen::system {

using symbolic::Dag;
using symbolic::Ref;

enum class Approach { one, two };
const char* name(Approach approach);  // "I", "II"

/// How the equations are solved where constraints keep multipliers: by the Schur complement A M^-1 A^T, on a null space
/// of A, or with the dependent velocities solved for.
enum class Form { multipliers, nullspace, chaplygin };
const char* name(Form form);  // "multipliers", "nullspace", "chaplygin"

/// lambda of one constraint. For the active ones the bare multiplier symbol; for eliminated ones an expression in
/// qddot (free) and the multipliers of the active constraints (the "(b)" equations of Approach I).
struct Reaction {
  std::uint32_t constraint;  // index into Mechanics::constraints
  std::string label;
  Ref value;
};

/// M = S^T M_theta S, f = S^T f_theta for rates theta_dot = S qdot with constant S: cheaper to solve where M_theta is
/// the simpler matrix (relative angles).
struct QuasiEquations {
  std::vector<symbolic::Rational> S_inverse;  // n x n row-major
  std::vector<Ref> M, f;                      // n x n, n
};

/// The equations solved by the route itself; nothing is left to factorise.
struct Solution {
  std::vector<Ref> qddot;   // n, without accelerations and multipliers
  std::vector<Ref> lambda;  // m
  std::vector<symbolic::Pivot> pivots;
};

/// An integral of a function of time without a closed form: a state that is 0 at the start, d/dt of it is `rate`.
struct IntegralState {
  std::uint32_t integral;  // index into Model::integrals
  Ref rate;                // of t, parameters and integrals that are states
};

struct Event {
  std::string name;
  Ref value;  // the event is where it changes its sign; may use qddot of free coordinates and multipliers
};

/// mechanics::HeldDirection: phi has no part along it while it sticks and contact `by` touches.
struct HeldDirection {
  std::uint32_t by = 0;    // index into EquationSystem::contacts; the contact itself: always
  std::vector<Ref> along;  // per tangent
};

/// A contact with friction or that can be left (docs/theory.md, "Friction"). The friction force sum_a phi_a t_a enters
/// f and the reactions with the symbols phi_a = {SymbolKind::friction, first + a}; the law that determines them depends
/// on the mode.
struct Contact {
  std::string name;
  std::uint32_t first = 0;               // index of the first phi
  std::vector<std::uint32_t> reactions;  // indices into EquationSystem::reactions; none: the normal force is given
  std::vector<Ref> gram;                 // |normal force|^2 = lambda^T gram lambda
  Ref normal;                            // the given normal force
  std::vector<Ref> slip, slip_rate;      // per tangent; the rate may use qddot
  std::vector<HeldDirection> held;
  std::vector<std::array<Ref, 3>> directions;  // t_a; none where a coordinate rubs
  Ref static_coefficient, dynamic_coefficient;
  std::optional<Ref> width;                 // of the smooth law, which has no static coefficient
  std::optional<std::uint32_t> unilateral;  // which of the active constraints can be left
  Ref restitution;                          // of impacts then
  bool rolls = false;                       // sticking is rolling

  bool sticks() const { return !slip.empty() && !width; }
  eom::ContactShape shape() const {
    return {slip.size(), reactions.size() == 1 && !unilateral && !slip.empty(), unilateral.has_value(), sticks(),
            rolls};
  }
};

/// Symbols of the mode of a contact: 1, -1, 0 as it slides along its tangent, against it, sticks; 1, -1 as it presses,
/// or as a unilateral one touches, is apart.
inline symbolic::Symbol slides_symbol(std::uint32_t contact) { return {symbolic::SymbolKind::contact, contact, 0}; }
inline symbolic::Symbol presses_symbol(std::uint32_t contact) { return {symbolic::SymbolKind::contact, contact, 1}; }

/// An equation that the active constraints make hold; runs watch psi, and starts satisfy it too.
struct Watched {
  std::uint32_t constraint;  // index into Mechanics::constraints
  Ref psi;
  std::vector<Ref> A;  // n
  Ref b;
};

struct EquationSystem {
  // Defined once: every file that holds one would compile them anew.
  EquationSystem();
  EquationSystem(const EquationSystem&);
  EquationSystem(EquationSystem&&) noexcept;
  EquationSystem& operator=(const EquationSystem&);
  EquationSystem& operator=(EquationSystem&&) noexcept;
  ~EquationSystem();

  std::shared_ptr<Dag> dag;
  std::string route;  // "lagrange", "jacobian"
  Approach approach = Approach::two;
  Form form = Form::multipliers;

  std::vector<std::uint32_t> free;    // n coordinates of the model, ascending; state x = (q_free, qdot_free, integrals)
  std::vector<std::uint32_t> active;  // m constraints with multipliers

  std::vector<IntegralState> integrals;
  std::vector<Ref> M;           // n x n, row-major, symmetric
  std::vector<Ref> f;           // n
  std::vector<bool> holonomic;  // m: false of constraints on velocities, whose psi is 0
  std::vector<Ref> psi;         // m
  std::vector<Ref> A;           // m x n, row-major
  std::vector<Ref> b;           // m: A qdot + b = 0
  std::vector<Ref> gamma;       // m: A qddot + gamma = 0
  std::vector<Watched> redundant;
  std::vector<Ref> apart;  // m, or none: 1 where the mode has left a constraint, whose row of A and gamma is 0 then

  std::optional<QuasiEquations> quasi;  // another way to M and f
  std::optional<Solution> solution;     // equal to what M, f, A, gamma give

  std::vector<Contact> contacts;

  std::vector<Reaction> reactions;        // all constraints, in model order
  std::vector<Output> outputs;            // everything that can be asked for, in the order of docs/model-format.md
  std::vector<Event> events;              // of the model, in its order
  Ref energy, kinetic, potential, power;  // power: what dE/dt must be; may use multipliers and qddot
};

}  // namespace eomgen::system
