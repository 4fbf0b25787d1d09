// SPDX-License-Identifier: GPL-3.0-or-later
// Approach II, (2.99)-(2.101): the integrable constraints are substituted into the Lagrangian first. Only the free
// coordinates have equations, without forces of imposed constraints.
#include "reading/approaches.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {

void derive_approach_two(const mechanics::Mechanics& m, GinacBridge& bridge,
                         const std::vector<DisplayRotation>& body_rotations, DisplayForm& form) {
  const std::map<Symbol, Sum> values = imposed_values(m, bridge);
  const Sum translation = translational_energy(m, bridge);
  if (!body_rotations.empty()) form.translation = simplify(bridge.substitute(translation, values));
  form.kinetic = simplify(bridge.substitute(kinetic_energy(translation, body_rotations), values));
  form.potential = bridge.substitute(bridge.sum(m.potential), values);
  form.lagrangian = form.kinetic - form.potential;
  form.by_degree = split_by_degree(form.kinetic);
  for (const std::uint32_t i : m.free) {
    form.equations.push_back(lagrange_equation(m, bridge, form.lagrangian, i, values));
  }
}

}  // namespace eomgen::reading
