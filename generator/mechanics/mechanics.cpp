// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/mechanics.hpp"

#include <algorithm>

#include "mechanics/integrability.hpp"
#include "mechanics/stages.hpp"
#include "mechanics/vanishes.hpp"

namespace eomgen::mechanics {
namespace {

void add_symbols(Mechanics& m) {
  Dag& dag = *m.dag;
  m.t = dag.symbol({SymbolKind::time, 0, 0});
  for (std::uint32_t i = 0; i < m.model->coordinates.size(); ++i) {
    m.q.push_back(dag.symbol({SymbolKind::coordinate, i, 0}));
    m.qdot.push_back(dag.symbol({SymbolKind::coordinate, i, 1}));
    m.qddot.push_back(dag.symbol({SymbolKind::coordinate, i, 2}));
  }
}

// Functions and parameters. Loops of joints need them before everything else that has a value.
void add_known_values(Mechanics& m, Lowering& lower) {
  m.function_value.clear();
  m.parameter_value.clear();
  for (const model::Function& function : m.model->functions)
    m.function_value.push_back(lower.scalar(function.expression));
  for (const model::Parameter& parameter : m.model->parameters)
    m.parameter_value.push_back(lower.scalar(parameter.value));
}

void add_values(Mechanics& m, Lowering& lower) {
  for (const model::Event& event : m.model->events) m.event.push_back(lower.scalar(event.when));
  add_known_values(m, lower);
  for (std::uint32_t i = 0; i < m.model->places.size(); ++i) m.place_position.emplace_back(lower.position(i));
  for (const model::Definition& definition : m.model->definitions) {
    m.scalar_definition.push_back(definition.vector ? m.dag->zero() : lower.scalar(definition.expression));
  }
}

// The rate of an integral must be known before an expression that contains it is differentiated, hence before the
// Lowering is constructed. Inner integrals come first.
void add_integrals(Mechanics& m) {
  for (std::uint32_t i = 0; i < m.model->states.size(); ++i) {
    const model::State& state = m.model->states[i];
    if (state.integral) m.dag->set_rate(state_symbol(*m.model, i), Lowering(m).scalar(state.rate));
  }
}

// The same for states of first order, whose rates have no derivatives of states.
void add_states(Mechanics& m) {
  Lowering lower(m);
  m.stored = m.dag->zero();
  for (std::uint32_t i = 0; i < m.model->states.size(); ++i) {
    const model::State& state = m.model->states[i];
    if (state.integral) continue;
    m.dag->set_rate(state_symbol(*m.model, i), lower.scalar(state.rate));
    m.stored = m.dag->add(m.stored, lower.scalar(state.energy));
  }
}

// Positivity of parameters that are declared positive, and of coordinates whose range starts at 0 or above.
void add_assumptions(Mechanics& m, Lowering& lower) {
  Dag& dag = *m.dag;
  for (std::uint32_t i = 0; i < m.model->parameters.size(); ++i) {
    if (m.model->parameters[i].positive) dag.assume_positive({SymbolKind::parameter, i, 0});
  }
  for (std::uint32_t i = 0; i < m.model->coordinates.size(); ++i) {
    const model::NodeId bound = m.model->coordinates[i].lower;
    if (bound == model::no_node) continue;
    const Ref lowest = lower.scalar(bound);
    const bool known = dag.is_constant(lowest) && !cln::minusp(dag.value(lowest));
    if (known || dag.is_positive(lowest)) dag.assume_positive({SymbolKind::coordinate, i, 0});
  }
}

// A coordinate without kinetic energy and constraint has no equation.
void require_equations(const Mechanics& m) {
  Dag& dag = *m.dag;
  for (const std::uint32_t i : m.free) {
    symbolic::Derivation by_rate = symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 1});
    std::vector<Ref> presence;
    for (const PointMass& mass : m.masses) {
      for (const Ref v : mass.velocity) presence.push_back(by_rate(v));
    }
    for (const BodyRotation& spin : m.body_rotations) {
      for (const Ref h : angular_momentum(dag, spin)) presence.push_back(by_rate(h));
    }
    presence.push_back(by_rate(m.kinetic_given));
    for (const std::uint32_t k : m.active) presence.push_back(m.constraints[k].gradient[i]);
    if (!vanishes(dag, presence)) continue;
    const model::Coordinate& coordinate = m.model->coordinates[i];
    throw Error(
        "mechanics", m.model->where(coordinate.span),
        "nothing that has mass moves with coordinate '" + coordinate.name + "', so it has no equation of motion",
        "give it inertia (a mass whose position depends on it, or a kinetic energy), fix it by a constraint, or remove "
        "it");
  }
  if (m.q.empty()) {
    throw Error("mechanics", SourceLocation{m.model->file, 0, 0, 1, ""}, "the model has no coordinates",
                "add a [[particle]] with a position, or [coordinates] and [energy]");
  }
}

}  // namespace

bool Mechanics::is_eliminated(std::uint32_t coordinate) const {
  return std::any_of(fixed.begin(), fixed.end(), [=](const FixedCoordinate& f) { return f.coordinate == coordinate; });
}

long Mechanics::degrees_of_freedom() const {
  const auto holds = [this](std::uint32_t k) { return !constraints[k].unilateral; };
  return static_cast<long>(free.size()) - static_cast<long>(std::count_if(active.begin(), active.end(), holds));
}

Ref Mechanics::velocity_form(const Constraint& constraint) const {
  Ref sum = constraint.rate;
  for (std::size_t i = 0; i < qdot.size(); ++i) sum = dag->add(sum, dag->mul(constraint.gradient[i], qdot[i]));
  return sum;
}

void add_masses(Mechanics& m, Lowering& lower) {
  Dag& dag = *m.dag;
  m.kinetic_given = lower.scalar(m.model->energy.kinetic);
  m.kinetic = m.kinetic_given;
  const auto add = [&](std::uint32_t place, model::NodeId heavy, const model::Span& span) {
    PointMass mass;
    mass.name = m.model->places[place].name;
    mass.place = place;
    mass.mass = lower.scalar(heavy);
    mass.position = lower.position(place);
    mass.velocity = lower.ddt(mass.position, span);
    const Ref twice = dag.mul(mass.mass, lower.dot(mass.velocity, mass.velocity));
    m.kinetic = dag.add(m.kinetic, dag.div(twice, dag.integer(2)));
    m.masses.push_back(std::move(mass));
  };
  for (const model::Particle& particle : m.model->particles) add(particle.place, particle.mass, particle.span);
  for (const model::Body& body : m.model->bodies) add(body.place, body.mass, body.span);
}

namespace {

/// None if the contacts could hold more directions than are free, and their forces are not to be inputs.
std::optional<Mechanics> built(std::shared_ptr<const model::Model> model, bool contact_inputs) {
  Mechanics m;
  m.model = std::move(model);
  m.dag = std::make_shared<Dag>();
  add_symbols(m);
  add_integrals(m);
  {
    Lowering lower(m);
    add_assumptions(m, lower);
  }
  add_states(m);
  Lowering lower(m);
  add_masses(m, lower);
  add_bodies(m, lower);
  add_forces(m, lower);
  add_constraints(m, lower);
  add_joints(m, lower);
  add_contacts(m, lower);
  if (contact_inputs || needs_contact_inputs(m)) require_contact_inputs(m);
  eliminate_coordinates(m);
  drop_blocked_directions(m);
  number_contact_inputs(m);
  list_active_constraints(m);
  if (!m.constraints.empty()) {
    add_known_values(m, lower);
    drop_repeated_equations(m);
    drop_dependent_equations(m, lower);
  }
  if (!m.has_contact_inputs() && !find_blocked_directions(m)) return std::nullopt;
  add_values(m, lower);
  check_friction_coefficients(m);
  require_equations(m);
  classify_constraints(m);
  return m;
}

}  // namespace

Mechanics build_mechanics(std::shared_ptr<const model::Model> model) {
  std::optional<Mechanics> result = built(model, false);
  return result ? *std::move(result) : *built(std::move(model), true);
}

symbolic::Symbol state_symbol(const model::Model& model, std::uint32_t index) {
  return {model.states[index].integral ? SymbolKind::integral : SymbolKind::state, index, 0};
}

Ref lower_scalar(Mechanics& mechanics, model::NodeId expression) { return Lowering(mechanics).scalar(expression); }
Vec3 lower_vector(Mechanics& mechanics, model::NodeId expression) { return Lowering(mechanics).vector(expression); }

Mechanics::Mechanics() = default;
Mechanics::Mechanics(const Mechanics&) = default;
Mechanics::Mechanics(Mechanics&&) noexcept = default;
Mechanics& Mechanics::operator=(const Mechanics&) = default;
Mechanics& Mechanics::operator=(Mechanics&&) noexcept = default;
Mechanics::~Mechanics() = default;

}  // namespace eomgen::mechanics
