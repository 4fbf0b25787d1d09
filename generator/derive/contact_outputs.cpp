// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/contact_outputs.hpp"

#include "mechanics/contact_forces.hpp"

namespace eomgen::derive {
namespace {

using symbolic::Dag;
using symbolic::Ref;
using symbolic::SymbolKind;
using system::EquationSystem;
using system::OutputKind;

/// The slip velocity along each tangent, and its coefficients of the rates of the free coordinates, in which it is
/// linear.
void add_slip_outputs(mechanics::Mechanics& m, std::uint32_t index, EquationSystem& s) {
  const mechanics::Contact& contact = m.contacts[index];
  const bool vector = contact.dimensions() > 1;
  for (std::uint32_t a = 0; a < contact.dimensions(); ++a) {
    const std::string name = contact.name + (vector ? "." + std::to_string(a + 1) : "");
    s.outputs.push_back(
        {"slip." + name, contact.slip[a], OutputKind::slip, index, a, "", vector ? "slip." + contact.name : ""});
    if (contact.first_input) continue;  // a run gets its rows from the function `contacts`
    for (const std::uint32_t i : s.free) {
      const Ref slope = symbolic::partial_derivative(*m.dag, {SymbolKind::coordinate, i, 1})(contact.slip[a]);
      s.outputs.push_back(
          {"contact.slope." + name + "." + m.model->coordinates[i].name, slope, OutputKind::slip_slope, index, a});
    }
    const Ref phi = m.dag->symbol({SymbolKind::friction, contact.first + a, 0});
    s.outputs.push_back({"contact.phi." + name, phi, OutputKind::friction_component, index, a});
  }
}

}  // namespace

void add_contact_outputs(mechanics::Mechanics& m, EquationSystem& s) {
  Dag& dag = *m.dag;
  for (std::uint32_t j = 0; j < m.contacts.size(); ++j) {
    const mechanics::Contact& contact = m.contacts[j];
    const auto phi = [&](std::size_t a) {
      return dag.symbol({SymbolKind::friction, contact.first + static_cast<std::uint32_t>(a), 0});
    };
    if (contact.directions.empty() && contact.dimensions() > 0)
      s.outputs.push_back({"friction." + contact.name, phi(0), OutputKind::friction, j});
    for (std::uint32_t axis = 0; axis < 3 && !contact.directions.empty(); ++axis) {
      Ref sum = dag.zero();
      for (std::size_t a = 0; a < contact.dimensions(); ++a) {
        sum = dag.add(sum, dag.mul(contact.directions[a][axis], phi(a)));
      }
      const std::string vector = "friction." + contact.name;
      s.outputs.push_back({vector + "." + std::to_string(axis + 1), sum, OutputKind::friction, j, axis, "", vector});
    }
    if (contact.body_contact && m.model->constraints[*contact.body_contact].is_rolling_with_friction()) {
      const std::string vector = "reaction." + contact.name;
      for (std::uint32_t a = 0; a < 2; ++a)
        s.outputs.push_back({vector + "." + std::to_string(a + 1), mechanics::rolling_friction(m, contact, a),
                             OutputKind::rolling_reaction, j, a, "", vector});
    }
    add_slip_outputs(m, j, s);
    if (contact.unilateral)
      s.outputs.push_back({"gap." + contact.name, m.constraints[contact.constraints[0]].psi, OutputKind::gap, j});
    if (contact.first_input) {
      s.outputs.push_back({"mode." + contact.name, mechanics::contact_mode(m, contact), OutputKind::mode, j});
      continue;
    }
    const Ref slides = contact.width ? dag.one() : dag.symbol(system::slip_direction_symbol(j));
    const Ref open_mode = dag.select(dag.symbol(system::normal_sign_symbol(j)), dag.zero(), dag.integer(2), slides);
    s.outputs.push_back({"mode." + contact.name, contact.unilateral ? open_mode : slides, OutputKind::mode, j});
    if (!contact.unilateral) continue;
    s.outputs.push_back({"contact.restitution." + contact.name, contact.restitution, OutputKind::restitution, j});
    if (!contact.gram.empty() && contact.gram[0] != dag.one())
      s.outputs.push_back({"contact.scale." + contact.name, dag.call(symbolic::Op::sqrt, contact.gram[0]),
                           OutputKind::normal_scale, j});
  }
}

}  // namespace eomgen::derive
