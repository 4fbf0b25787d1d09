// SPDX-License-Identifier: GPL-3.0-or-later
// Iteration over every expression of an EquationSystem, for code that rewrites or searches all of them. It omits
// EquationSystem::redundant, which only the initial state uses (its psi is also an output), and EquationSystem::apart,
// which depends on modes only.
#pragma once

#include "system/equation_system.hpp"

namespace eomgen::system {

/// The role of an expression.
enum class Part {
  motion,       // M, f, A, gamma, the rates of integrals, the quasi-velocity equations, the solution
  slip,         // slip of a contact: the mode of the contact changes at its sign changes
  contact,      // the rest of a contact's law
  constraints,  // psi and b, for initial states and projection
  shown         // reactions, outputs, events, energies
};

/// Calls visit(expression, part) with references; `system` may be const.
template <class System, class Visit>
void for_each_expression(System& system, Visit&& visit) {
  const auto all = [&visit](auto& list, Part part) {
    for (auto& r : list) visit(r, part);
  };
  for (auto* list : {&system.M, &system.f, &system.A, &system.gamma}) all(*list, Part::motion);
  for (auto& integral : system.integrals) visit(integral.rate, Part::motion);
  if (system.quasi) {
    all(system.quasi->M, Part::motion);
    all(system.quasi->f, Part::motion);
  }
  if (system.solution) {
    all(system.solution->qddot, Part::motion);
    all(system.solution->lambda, Part::motion);
    for (auto& pivot : system.solution->pivots) {
      visit(pivot.pivot, Part::motion);
      visit(pivot.scale, Part::motion);
    }
  }
  for (auto& contact : system.contacts) {
    all(contact.slip, Part::slip);
    all(contact.slip_rate, Part::contact);
    all(contact.gram, Part::contact);
    for (auto& direction : contact.directions) all(direction, Part::contact);
    for (auto* r : {&contact.normal, &contact.static_coefficient, &contact.dynamic_coefficient, &contact.restitution})
      visit(*r, Part::contact);
    if (contact.width) visit(*contact.width, Part::contact);
  }
  for (auto* list : {&system.psi, &system.b}) all(*list, Part::constraints);
  for (auto& reaction : system.reactions) visit(reaction.value, Part::shown);
  for (auto& output : system.outputs) visit(output.value, Part::shown);
  for (auto& event : system.events) visit(event.value, Part::shown);
  for (auto* r : {&system.kinetic, &system.potential, &system.energy, &system.power}) visit(*r, Part::shown);
}

}  // namespace eomgen::system
