// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/equations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "derive/contact_outputs.hpp"
#include "mechanics/contact_forces.hpp"
#include "mechanics/particle_force.hpp"

namespace eomgen::derive {
namespace {

using system::EquationSystem;
using system::OutputKind;

Symbol coordinate(std::uint32_t i, std::uint8_t order) { return {SymbolKind::coordinate, i, order}; }

/// Imposes the constraints, then expands functions of time.
struct FinalSubstitution {
  symbolic::Substitution imposed, written;
  Ref operator()(Ref r) { return written(imposed(r)); }
};

symbolic::Substitution at_rest(const Mechanics& m, const EquationSystem& s) {
  std::map<Symbol, Ref> zero;
  for (const std::uint32_t i : s.free) zero[coordinate(i, 1)] = m.dag->zero();
  return {*m.dag, std::move(zero)};
}

void add_constraints(Mechanics& m, EquationSystem& s, FinalSubstitution& finish) {
  Dag& dag = *m.dag;
  symbolic::Derivation bias = symbolic::total_time_derivative(dag, m.q.size(), m.model->functions.size(), true);
  for (const std::uint32_t k : s.active) {
    // The fixed coordinates are imposed first, so that A has only the columns of free coordinates.
    const mechanics::Constraint& constraint = m.constraints[k];
    const Ref psi = finish.imposed(constraint.psi);
    s.holonomic.push_back(constraint.holonomic());
    s.psi.push_back(finish(psi));
    for (const std::uint32_t i : s.free) {
      s.A.push_back(constraint.holonomic() ? finish(symbolic::partial_derivative(dag, coordinate(i, 0))(psi))
                                           : finish(constraint.gradient[i]));
    }
    const Ref rate = constraint.holonomic() ? bias(psi) : finish.imposed(m.velocity_form(constraint));  // A qdot + b
    s.b.push_back(finish(at_rest(m, s)(rate)));
    s.gamma.push_back(finish(bias(rate)));
  }
}

// Equations that are not imposed, but hold if the active constraints do.
void add_redundant(Mechanics& m, EquationSystem& s, FinalSubstitution& finish) {
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    if (m.constraints[k].redundancy != mechanics::Redundancy::redundant) continue;
    const mechanics::Constraint& c = m.constraints[k];
    const std::uint8_t order = c.holonomic() ? 0 : 1;
    const Ref psi = finish.imposed(c.holonomic() ? c.psi : m.velocity_form(c));
    const Ref b =
        c.holonomic() ? symbolic::explicit_time_derivative(*m.dag, m.model->functions.size())(psi) : at_rest(m, s)(psi);
    system::RedundantConstraint watched{k, finish(psi), {}, finish(b)};
    for (const std::uint32_t i : s.free)
      watched.A.push_back(finish(symbolic::partial_derivative(*m.dag, coordinate(i, order))(psi)));
    s.redundant.push_back(std::move(watched));
  }
}

// The (b) equations: row c of M qddot - f = sum_k lambda_k dpsi_k/dq_c, from the last fixed coordinate to the first. A
// constraint's gradient has only coordinates that were fixed with it or before it, so this is a back substitution.
void add_reactions(Mechanics& m, const FullEquations& full, EquationSystem& s) {
  Dag& dag = *m.dag;
  const std::size_t n = m.q.size();
  std::vector<Ref> lambda(m.constraints.size(), dag.zero());
  for (const std::uint32_t k : s.active) lambda[k] = dag.symbol({SymbolKind::multiplier, k, 0});
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k)
    if (m.constraints[k].force_input) lambda[k] = dag.symbol({SymbolKind::multiplier, k, 0});
  for (auto fixed = m.fixed.rbegin(); fixed != m.fixed.rend(); ++fixed) {
    const std::uint32_t c = fixed->coordinate;
    Ref force = dag.neg(full.f[c]);
    for (std::uint32_t i = 0; i < n; ++i) force = dag.add(force, dag.mul(full.M[c * n + i], m.qddot[i]));
    for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
      if (k != fixed->constraint) force = dag.sub(force, dag.mul(m.constraints[k].gradient[c], lambda[k]));
    }
    lambda[fixed->constraint] = dag.div(force, m.constraints[fixed->constraint].gradient[c]);
  }
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    s.reactions.push_back({k, m.constraints[k].label, lambda[k]});
  }
}

/// N = sum lambda_k grad psi_k on every particle with coordinates that move nothing else, if the motion determines it.
void add_constraint_forces(Mechanics& m, EquationSystem& s) {
  Dag& dag = *m.dag;
  std::vector<Ref> Q(m.q.size(), dag.zero());
  std::vector<bool> open(m.q.size(), false);  // constraints with undetermined forces act along it
  for (const system::Reaction& reaction : s.reactions) {
    const mechanics::Constraint& c = m.constraints[reaction.constraint];
    for (std::size_t i = 0; i < Q.size(); ++i) {
      if (dag.is_zero(c.gradient[i])) continue;
      Q[i] = dag.add(Q[i], dag.mul(reaction.value, c.gradient[i]));
      open[i] = open[i] || !c.determined;
    }
  }
  for (std::size_t p = 0; p < m.masses.size(); ++p) {
    const mechanics::PointMass& mass = m.masses[p];
    const auto is_mass = [&](const model::Body& body) { return body.place == mass.place; };
    if (std::any_of(m.model->bodies.begin(), m.model->bodies.end(), is_mass)) continue;
    bool bound = false, determined = true;
    for (const Symbol& q : dag.symbols({mass.position[0], mass.position[1], mass.position[2]})) {
      if (q.kind != SymbolKind::coordinate) continue;
      bound = bound || !dag.is_zero(Q[q.index]);
      determined = determined && !open[q.index];
    }
    if (!bound || !determined) continue;
    const std::optional<Vec3> force = mechanics::force_on_particle(m, p, Q);
    if (!force) continue;
    const std::string vector = mass.name + ".constraint_force";
    for (std::uint32_t k = 0; k < 3; ++k)
      s.outputs.push_back(
          {vector + std::to_string(k + 1), (*force)[k], OutputKind::constraint_force, mass.place, k, "N", vector});
  }
}

/// Multipliers; for joints, the force on B and the moment about its point instead. Both as far as the motion determines
/// them.
void add_reaction_outputs(Mechanics& m, EquationSystem& s) {
  Dag& dag = *m.dag;
  for (const system::Reaction& reaction : s.reactions) {
    const auto of = [&](const mechanics::JointReaction& j) {
      return reaction.constraint >= j.first && reaction.constraint < j.first + j.equations();
    };
    if (!m.constraints[reaction.constraint].determined) continue;
    const mechanics::Constraint& constraint = m.constraints[reaction.constraint];
    const std::string vector = constraint.name == constraint.label ? "" : "reaction." + constraint.name;
    if (std::none_of(m.joints.begin(), m.joints.end(), of))
      s.outputs.push_back({"reaction." + reaction.label, reaction.value, OutputKind::constraint_reaction,
                           reaction.constraint, 0, "", vector});
  }
  for (std::uint32_t i = 0; i < m.joints.size(); ++i) {
    const mechanics::JointReaction& joint = m.joints[i];
    const std::string vector = "reaction." + m.model->joints[i].name;
    for (std::uint32_t j = 0; j < joint.along.size(); ++j) {
      if (!joint.determined[j]) continue;
      Ref sum = dag.zero();
      for (std::size_t k = 0; k < joint.equations(); ++k)
        sum = dag.add(sum, dag.mul(joint.along[j][k], s.reactions[joint.first + k].value));
      s.outputs.push_back({vector + "." + std::to_string(j + 1), sum, OutputKind::joint_reaction, i, j, "", vector});
    }
  }
  add_constraint_forces(m, s);
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    const mechanics::Constraint& c = m.constraints[k];
    if (c.redundancy == mechanics::Redundancy::redundant)
      s.outputs.push_back(
          {"redundant." + c.label, c.holonomic() ? c.psi : m.velocity_form(c), OutputKind::redundant, k});
  }
}

void add_outputs(Mechanics& m, EquationSystem& s) {
  const auto add = [&s](std::string name, Ref value, OutputKind kind, const std::string& unit, std::uint32_t index = 0,
                        std::uint32_t part = 0) {
    s.outputs.push_back({std::move(name), value, kind, index, part, unit});
  };
  for (std::uint32_t i = 0; i < m.q.size(); ++i) {
    const model::Coordinate& c = m.model->coordinates[i];
    add(c.name, m.q[i], OutputKind::coordinate, c.unit.text, i);
    add(c.name + "_dot", m.qdot[i], OutputKind::rate, system::per_second(c.unit.text), i);
  }
  for (std::uint32_t i = 0; i < m.model->states.size(); ++i) {
    const model::State& state = m.model->states[i];
    if (!state.integral)
      add(state.name, m.dag->symbol(mechanics::state_symbol(*m.model, i)), OutputKind::state, state.unit.text, i);
  }
  add("energy", s.energy, OutputKind::energy, "J");
  add("kinetic", s.kinetic, OutputKind::kinetic, "J");
  add("potential", s.potential, OutputKind::potential, "J");
  add("power", s.power, OutputKind::power, "W");
  symbolic::Derivation ddt = symbolic::total_time_derivative(*m.dag, m.q.size(), m.model->functions.size());
  for (std::uint32_t i = 1; i < m.model->places.size(); ++i) {
    const Vec3& position = *m.place_position[i];
    const std::string& name = m.model->places[i].name;
    for (std::uint32_t k = 0; k < 3; ++k)
      add(name + ".position" + std::to_string(k + 1), position[k], OutputKind::position, "m", i, k);
    for (std::uint32_t k = 0; k < 3; ++k)
      add(name + ".velocity" + std::to_string(k + 1), ddt(position[k]), OutputKind::velocity, "m/s", i, k);
  }
  for (std::uint32_t f = 1; f < m.angular_velocity.size(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k)
      add(m.model->frames[f].name + ".omega" + std::to_string(k + 1), m.angular_velocity[f][k],
          OutputKind::angular_velocity, "rad/s", f, k);
  }
  add_reaction_outputs(m, s);
  for (std::uint32_t i = 0; i < m.model->definitions.size(); ++i) {
    const model::Definition& definition = m.model->definitions[i];
    if (!definition.vector)
      add(definition.name, m.scalar_definition[i], OutputKind::definition, definition.unit.text, i);
  }
  for (std::uint32_t i = 0; i < m.q.size(); ++i) {
    const model::Coordinate& c = m.model->coordinates[i];
    add(c.name + "_ddot", m.qddot[i], OutputKind::acceleration, system::per_second(c.unit.text, 2), i);
  }
}

// The place of a target in x.
std::size_t component(const Mechanics& m, const EquationSystem& s, const model::Assignment& target) {
  const eom::StateLayout layout = s.layout();
  if (target.target == model::Assignment::Target::state) {
    const auto found = std::find_if(s.states.begin(), s.states.end(), [&](const system::FirstOrderState& state) {
      return state.symbol.index == target.index;
    });
    return layout.first_order_begin() + static_cast<std::size_t>(found - s.states.begin());
  }
  const auto found = std::find(s.free.begin(), s.free.end(), target.index);
  const bool rate = target.target == model::Assignment::Target::velocity;
  if (found == s.free.end()) {
    std::string free;
    for (const std::uint32_t i : s.free)
      free += (free.empty() ? "" : ", ") + m.model->coordinates[i].name + (rate ? "_dot" : "");
    const std::string& name = m.model->coordinates[target.index].name;
    throw Error("derive", m.model->where(target.span),
                fmt::format("'{}{}' cannot be set: constraints determine the coordinate '{}', which is eliminated",
                            name, rate ? "_dot" : "", name),
                "set values that remain free: " + free);
  }
  return static_cast<std::size_t>(found - s.free.begin()) + (rate ? layout.rates_begin() : 0);
}

system::Reset lowered(Mechanics& m, const EquationSystem& s, const model::Reset& reset) {
  system::Reset result;
  for (const model::Assignment& assignment : reset.set)
    result.set.push_back({component(m, s, assignment), mechanics::lower_scalar(m, assignment.value)});
  if (reset.condition != model::no_node) result.condition = mechanics::lower_scalar(m, reset.condition);
  return result;
}

// A multiplier in an event is the reaction of that constraint: an expression if the constraint is eliminated.
void add_events(Mechanics& m, EquationSystem& s) {
  std::map<Symbol, Ref> forces;
  for (const system::Reaction& r : s.reactions) forces[{SymbolKind::multiplier, r.constraint, 0}] = r.value;
  symbolic::Substitution reacting(*m.dag, std::move(forces));
  for (std::size_t i = 0; i < m.event.size(); ++i)
    s.events.push_back({m.model->events[i].name, reacting(m.event[i]), lowered(m, s, m.model->events[i].reset)});
  for (const model::Sample& sample : m.model->samples) s.samples.push_back({sample.name, lowered(m, s, sample.reset)});
}

/// The row of a velocity w that is linear in the rates.
system::ContactRow contact_row(Mechanics& m, const EquationSystem& s, FinalSubstitution& finish, Ref w) {
  symbolic::Derivation bias = symbolic::total_time_derivative(*m.dag, m.q.size(), m.model->functions.size(), true);
  const Ref rate = finish.imposed(w);
  system::ContactRow row{finish(rate), finish(bias(rate)), {}};
  for (const std::uint32_t i : s.free)
    row.slopes.push_back(finish(symbolic::partial_derivative(*m.dag, coordinate(i, 1))(rate)));
  return row;
}

/// |grad psi| at the place of a contact; 1 where psi is a distance.
Ref normal_scale(Mechanics& m, const mechanics::Contact& contact, FinalSubstitution& finish) {
  return contact.gram.empty() ? m.dag->one() : m.dag->call(symbolic::Op::sqrt, finish(contact.gram[0]));
}

void add_contacts_with_inputs(Mechanics& m, EquationSystem& s, FinalSubstitution& finish) {
  Dag& dag = *m.dag;
  s.contact_inputs = mechanics::contact_inputs(m);
  if (m.model->impacts) {
    s.impact_law = static_cast<eom::contacts::ImpactLaw>(m.model->impacts->law);
    s.impact_order = static_cast<eom::contacts::ImpactOrder>(m.model->impacts->order);
  }
  for (const mechanics::Contact& contact : m.contacts) {
    system::ContactWithInputs result;
    result.name = contact.name;
    result.unilateral = contact.unilateral;
    result.rolls = contact.rolls;
    result.gap = result.given_normal = result.static_coefficient = result.dynamic_coefficient = result.restitution =
        dag.zero();
    result.normal_scale = normal_scale(m, contact, finish);
    result.friction_input = *contact.first_input;
    if (contact.constraints.empty()) {
      result.given_normal = finish(contact.normal);
    } else {
      const mechanics::Constraint& constraint = m.constraints[contact.constraints[0]];
      result.gap = finish(constraint.psi);
      result.normal = contact_row(m, s, finish, m.velocity_form(constraint));
      result.force_input = *constraint.force_input;
    }
    for (const Ref w : contact.slip) result.slip.push_back(contact_row(m, s, finish, w));
    if (contact.width)
      result.width = finish(*contact.width);
    else if (contact.dimensions() > 0)
      result.static_coefficient = finish(contact.static_coefficient);
    if (contact.dimensions() > 0) result.dynamic_coefficient = finish(contact.dynamic_coefficient);
    if (contact.unilateral) result.restitution = finish(contact.restitution);
    s.contacts_with_inputs.push_back(std::move(result));
  }
}

void add_contacts(Mechanics& m, EquationSystem& s, FinalSubstitution& finish) {
  if (m.has_contact_inputs()) return add_contacts_with_inputs(m, s, finish);
  symbolic::Derivation ddt = symbolic::total_time_derivative(*m.dag, m.q.size(), m.model->functions.size());
  for (const mechanics::Contact& contact : m.contacts) {
    system::Contact result;
    result.name = contact.name;
    result.first = contact.first;
    result.rolls = contact.rolls;
    result.reactions = contact.constraints;  // reactions are in the order of the constraints
    for (const Ref g : contact.gram) result.gram.push_back(finish(g));
    if (contact.constraints.empty()) result.normal = finish(contact.normal);
    for (const Ref w : contact.slip) {
      result.slip.push_back(finish(w));
      result.slip_rate.push_back(finish(ddt(w)));
    }
    for (const mechanics::BlockedDirection& held : contact.blocked) {
      result.blocked.push_back({held.by, {}});
      for (const Ref along : held.along) result.blocked.back().along.push_back(finish(along));
    }
    for (const Vec3& t : contact.directions) result.directions.push_back({finish(t[0]), finish(t[1]), finish(t[2])});
    if (contact.width)
      result.width = finish(*contact.width);
    else if (contact.dimensions() > 0)
      result.static_coefficient = finish(contact.static_coefficient);
    if (contact.dimensions() > 0) result.dynamic_coefficient = finish(contact.dynamic_coefficient);
    if (contact.unilateral) {
      const auto k = std::find(s.active.begin(), s.active.end(), contact.constraints[0]);
      result.unilateral = static_cast<std::uint32_t>(k - s.active.begin());
      result.restitution = finish(contact.restitution);
    }
    s.contacts.push_back(std::move(result));
  }
}

}  // namespace

std::vector<std::uint32_t> all_coordinates(const Mechanics& m) {
  std::vector<std::uint32_t> all(m.q.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

std::vector<Ref> generalized_forces(Mechanics& m) {
  std::vector<Ref> Q(m.q.size(), m.dag->zero());
  for (const std::vector<Ref>& force : m.force_components) {
    for (std::size_t i = 0; i < Q.size(); ++i) Q[i] = m.dag->add(Q[i], force[i]);
  }
  for (const mechanics::Contact& contact : m.contacts) {
    for (std::uint32_t a = 0; a < contact.dimensions(); ++a) {
      const Ref phi = m.dag->symbol({SymbolKind::friction, contact.first + a, 0});
      for (std::size_t i = 0; i < Q.size(); ++i) Q[i] = m.dag->add(Q[i], m.dag->mul(contact.tangents[a][i], phi));
    }
  }
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    if (!m.constraints[k].force_input) continue;
    const Ref lambda = m.dag->symbol({SymbolKind::multiplier, k, 0});
    for (std::size_t i = 0; i < Q.size(); ++i)
      Q[i] = m.dag->add(Q[i], m.dag->mul(m.constraints[k].gradient[i], lambda));
  }
  return Q;
}

EquationSystem assemble(Mechanics& m, const FullEquations& full, const FullEquations* motion, const char* formulation,
                        system::Approach approach) {
  Dag& dag = *m.dag;
  EquationSystem s;
  s.dag = m.dag;
  s.formulation = formulation;
  s.approach = approach;
  s.free = m.free;
  s.active = m.active;
  s.states = first_order_states(m);
  s.discrete = static_cast<std::size_t>(std::count_if(m.model->states.begin(), m.model->states.end(),
                                                      [](const model::State& state) { return state.discrete; }));
  const std::size_t all = m.q.size();
  if (motion != nullptr) {
    s.M = motion->M;
    s.f = motion->f;
  } else {
    for (const std::uint32_t i : s.free) {
      Ref f = full.f[i];
      for (const std::uint32_t k : s.free) s.M.push_back(full.M[i * all + k]);
      for (const mechanics::FixedCoordinate& c : m.fixed) {
        f = dag.sub(f, dag.mul(full.M[i * all + c.coordinate], c.acceleration));
      }
      s.f.push_back(f);
    }
  }
  add_reactions(m, full, s);
  s.kinetic = m.kinetic;
  s.potential = m.potential;
  s.energy = dag.add(dag.add(m.kinetic, m.potential), m.stored);
  s.power = power(m, s);
  add_outputs(m, s);
  add_events(m, s);
  add_contact_outputs(m, s);
  FinalSubstitution finish{constraint_substitution(m), time_function_substitution(m)};
  for (Ref* r : {&s.kinetic, &s.potential, &s.energy, &s.power}) *r = finish(*r);
  for (Ref& r : s.M) r = finish(r);
  for (Ref& r : s.f) r = finish(r);
  for (system::Reaction& reaction : s.reactions) reaction.value = finish(reaction.value);
  for (system::Output& output : s.outputs) output.value = finish(output.value);
  const auto finish_reset = [&finish](system::Reset& reset) {
    for (system::Reset::Entry& entry : reset.set) entry.value = finish(entry.value);
    if (reset.condition) reset.condition = finish(*reset.condition);
  };
  for (system::Event& event : s.events) {
    event.value = finish(event.value);
    finish_reset(event.reset);
  }
  for (system::Sample& sample : s.samples) finish_reset(sample.reset);
  add_constraints(m, s, finish);
  add_redundant(m, s, finish);
  add_contacts(m, s, finish);
  return s;
}

}  // namespace eomgen::derive
