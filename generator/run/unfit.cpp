// SPDX-License-Identifier: GPL-3.0-or-later
// Which solvers are for which scenes and models, and why not.
#include <algorithm>

#include "run/runner.hpp"

namespace eomgen::run {

std::string unfit(const std::string& solver, const Scene& scene) {
  if (!method_named(solver).series) return "";
  // The series of the motion holds them still; a table does so between its jumps.
  for (const Signal& signal : scene.inputs) {
    if (signal.moves()) return "its series knows inputs that stand still or jump, and one here is an expression of t";
  }
  return "";
}

std::string not_variational(bool contacts, bool on_velocities, bool kinks, bool integrals) {
  if (contacts)
    return "the model has contacts with friction, or that can be left, and no discrete Lagrangian has these";
  if (on_velocities)
    return "a constraint on velocities does not follow from a Lagrangian; variational integrators take constraints on "
           "positions";
  if (kinks) return "the equations have kinks (abs, sign, min, max), where the discrete Lagrangian has no derivative";
  if (integrals) return "an integral of a function of time is a state of this model, which has no momentum";
  return "";
}

std::string not_variational(const Code& code) {
  const bool on_velocities = std::find(code.holonomic.begin(), code.holonomic.end(), false) != code.holonomic.end();
  const std::string why =
      not_variational(!code.contacts.empty(), on_velocities, !code.kinks.empty(), code.integrals > 0);
  return why.empty() && (code.momenta == nullptr || code.mass == nullptr) ? "the code was compiled without its momenta"
                                                                          : why;
}

std::string not_constrained(bool contacts, bool constraints) {
  if (contacts)
    return "the model has contacts with friction, or that can be left: which constraints hold changes on the way, and "
           "it keeps one set of them";
  if (!constraints)
    return "its equations have no constraints with multipliers, which it would keep; radau5 is that method without "
           "constraints";
  return "";
}

std::string unfit(const std::string& solver, const Code& code) {
  const eom::MethodInfo& method = method_named(solver);
  if (method.variational) return not_variational(code);
  if (!method.constrained) return "";
  const std::string why = not_constrained(!code.contacts.empty(), code.active_constraints > 0);
  return why.empty() && (code.constraints == nullptr || code.mass == nullptr)
             ? "the code was compiled without its constraints"
             : why;
}

std::string instead_of(const std::string& solver) {
  return method_named(solver).variational
             ? "take midpoint, which is symplectic as well, dop853 or auto"
             : "take radau5, which projects where there is something to keep, dop853 or auto";
}

}  // namespace eomgen::run
