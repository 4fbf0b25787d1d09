// SPDX-License-Identifier: GPL-3.0-or-later
// Iteration over every expression of an EquationSystem, for code that rewrites or searches all of them. It omits
// EquationSystem::redundant, which only the initial state uses (its psi is also an output), and EquationSystem::apart,
// which depends on modes only.
#pragma once

#include "system/equation_system.hpp"

namespace eomgen::system {

/// The role of an expression.
enum class ExpressionRole {
  motion,       // M, f, A, gamma, the rates of states of first order, the quasi-velocity equations, the solution
  slip,         // slip of a contact: the mode of the contact changes at its sign changes
  contact,      // the rest of a contact's law
  constraints,  // psi and b, for initial states and projection
  output,       // reactions, outputs, events, energies
  reset         // new values and conditions of resets, which are evaluated between two segments of the motion
};

/// Calls visit(expression, part) with references; `system` may be const.
template <class System, class Visit>
void for_each_expression(System& system, Visit&& visit) {
  const auto all = [&visit](auto& list, ExpressionRole part) {
    for (auto& r : list) visit(r, part);
  };
  for (auto* list : {&system.M, &system.f, &system.A, &system.gamma}) all(*list, ExpressionRole::motion);
  for (auto& state : system.states) visit(state.rate, ExpressionRole::motion);
  if (system.quasi) {
    all(system.quasi->M, ExpressionRole::motion);
    all(system.quasi->f, ExpressionRole::motion);
  }
  if (system.solution) {
    all(system.solution->qddot, ExpressionRole::motion);
    all(system.solution->lambda, ExpressionRole::motion);
    for (auto& pivot : system.solution->pivots) {
      visit(pivot.pivot, ExpressionRole::motion);
      visit(pivot.scale, ExpressionRole::motion);
    }
    if (system.solution->forces) {
      auto& forces = *system.solution->forces;
      for (auto* list : {&forces.matrix, &forces.side, &forces.values, &forces.qddot})
        all(*list, ExpressionRole::motion);
    }
  }
  if (system.residual) {
    auto& residual = *system.residual;
    for (auto* list : {&residual.inertia, &residual.applied, &residual.by_q, &residual.by_qdot, &residual.qddot_by_q,
                       &residual.qddot_by_qdot, &residual.M_inverse})
      all(*list, ExpressionRole::motion);
    if (residual.slopes) {
      for (auto& step : residual.slopes->steps) {
        for (auto& stored : step.stores) visit(stored.value, ExpressionRole::motion);
        all(step.loop.values, ExpressionRole::motion);
      }
    }
    for (auto& pivot : residual.pivots) {
      visit(pivot.pivot, ExpressionRole::motion);
      visit(pivot.scale, ExpressionRole::motion);
    }
  }
  for (auto& contact : system.contacts) {
    all(contact.slip, ExpressionRole::slip);
    all(contact.slip_rate, ExpressionRole::contact);
    all(contact.gram, ExpressionRole::contact);
    for (auto& direction : contact.directions) all(direction, ExpressionRole::contact);
    for (auto* r : {&contact.normal, &contact.static_coefficient, &contact.dynamic_coefficient, &contact.restitution})
      visit(*r, ExpressionRole::contact);
    if (contact.width) visit(*contact.width, ExpressionRole::contact);
  }
  for (auto& contact : system.contacts_with_inputs) {
    const auto row = [&](auto& of, ExpressionRole part) {
      visit(of.rate, part);
      visit(of.bias, ExpressionRole::contact);
      all(of.slopes, ExpressionRole::contact);
    };
    if (contact.normal) row(*contact.normal, ExpressionRole::contact);
    for (auto& slip : contact.slip) row(slip, ExpressionRole::slip);
    for (auto* r : {&contact.gap, &contact.normal_scale, &contact.given_normal, &contact.static_coefficient,
                    &contact.dynamic_coefficient, &contact.restitution})
      visit(*r, ExpressionRole::contact);
    if (contact.width) visit(*contact.width, ExpressionRole::contact);
  }
  for (auto* list : {&system.psi, &system.b}) all(*list, ExpressionRole::constraints);
  for (auto& reaction : system.reactions) visit(reaction.value, ExpressionRole::output);
  for (auto& output : system.outputs) visit(output.value, ExpressionRole::output);
  const auto reset = [&visit](auto& of) {
    for (auto& entry : of.set) visit(entry.value, ExpressionRole::reset);
    if (of.condition) visit(*of.condition, ExpressionRole::reset);
  };
  for (auto& event : system.events) {
    visit(event.value, ExpressionRole::output);
    reset(event.reset);
  }
  for (auto& sample : system.samples) reset(sample.reset);
  for (auto* r : {&system.kinetic, &system.potential, &system.energy, &system.power}) visit(*r, ExpressionRole::output);
}

}  // namespace eomgen::system
