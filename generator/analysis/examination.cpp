// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/examination.hpp"

#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>

#include "conservation/conservative.hpp"
#include "conservation/conserved.hpp"
#include "conservation/zero_parameters.hpp"
#include "derive/formulations/lagrange.hpp"
#include "pipeline/charts.hpp"
#include "reading/reading.hpp"
#include "symbolic/decimal.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {
namespace {

print::PrintedFormula item_of(const mechanics::Mechanics& m, symbolic::Ref expression) {
  return print::render_expression(m, "", "", expression);
}
std::string shown(const mechanics::Mechanics& m, symbolic::Ref expression) { return item_of(m, expression).text; }
/// The same, listed as left out if it is too long.
std::string shown(const mechanics::Mechanics& m, symbolic::Ref expression, const std::string& what,
                  Examination& found) {
  const print::PrintedFormula item = item_of(m, expression);
  if (!item.left_out.empty()) found.left_out.push_back({what, item.left_out});
  return item.text;
}

/// A comparison, which the model holds as if(a < b, 1, 0) or if(a < b, 0, 1).
std::string comparison(mechanics::Mechanics& m, model::NodeId condition) {
  const model::Node node = m.model->arena[condition];
  const auto side = [&](std::size_t k) { return shown(m, mechanics::lower_scalar(m, node.args[k])); };
  const bool less = cln::plusp(m.model->arena[node.args[2]].value);
  return less ? side(0) + " < " + side(1) : side(1) + " <= " + side(0);
}

void add_resets(mechanics::Mechanics& m, Examination& found) {
  const auto add = [&](const std::string& name, model::NodeId when, bool sample, const model::Reset& reset) {
    if (reset.set.empty() && reset.condition == model::no_node) return;
    ExaminedReset one{name, shown(m, mechanics::lower_scalar(m, when)), "", {}, sample};
    if (reset.condition != model::no_node) one.condition = comparison(m, reset.condition);
    for (const model::Assignment& target : reset.set) {
      using Target = model::Assignment::Target;
      const std::string to =
          target.target == Target::state ? m.model->states[target.index].name : m.model->coordinates[target.index].name;
      one.set.emplace_back(to + (target.target == Target::velocity ? "_dot" : ""),
                           shown(m, mechanics::lower_scalar(m, target.value)));
    }
    found.resets.push_back(std::move(one));
  };
  for (const model::Event& event : m.model->events) add(event.name, event.when, false, event.reset);
  for (const model::Sample& sample : m.model->samples) add(sample.name, sample.every, true, sample.reset);
}

std::string treatment_of(const mechanics::Mechanics& m, const mechanics::Constraint& c, bool joint) {
  std::string use = "keeps a multiplier";
  for (const mechanics::FixedCoordinate& fixed : m.fixed) {
    if (m.constraints[fixed.constraint].label == c.label) use = "fixes " + m.model->coordinates[fixed.coordinate].name;
  }
  if (c.redundancy == mechanics::Redundancy::identity) use = "holds identically, without a multiplier";
  if (c.redundancy == mechanics::Redundancy::redundant) use = "follows from the others, without a multiplier; watched";
  if (!c.determined && !joint) use += "; the motion does not determine its force";
  return use;
}

void add_constraints(const mechanics::Mechanics& m, Examination& found) {
  for (std::size_t k = 0; k < m.constraints.size(); ++k) {
    const mechanics::Constraint& c = m.constraints[k];
    const auto of_joint = [&](const model::Joint& joint) { return joint.name == c.name; };
    const bool joint = std::any_of(m.model->joints.begin(), m.model->joints.end(), of_joint);
    ConstraintClass one;
    one.name = c.label;
    one.kind = c.holonomic() ? "holonomic" : "velocity";
    one.integrable = mechanics::name(m.classification[k].integrable);
    if (c.holonomic())
      one.integral =
          shown(m, c.psi, "the constraint " + c.label, found) + " = 0";  // a holonomic constraint is its own integral
    for (const mechanics::ConstraintIntegral& i : m.integrals) {
      if (i.label != c.label) continue;
      one.integral = shown(m, i.psi) + " = constant";
      for (const std::uint32_t part : i.constraints) one.integral_of.push_back(m.constraints[part].label);
    }
    one.redundant = !m.is_independent(static_cast<std::uint32_t>(k));
    if (!joint) one.determined = c.determined;
    one.treatment = treatment_of(m, c, joint);
    one.reason = m.classification[k].reason;
    found.constraints.push_back(std::move(one));
  }
}

void add_joints(const mechanics::Mechanics& m, Examination& found) {
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const model::Joint& joint = m.model->joints[i];
    ExaminedJoint one{joint.name,
                      joint.type,
                      {m.model->frames[joint.frames[0]].name, m.model->frames[joint.frames[1]].name},
                      m.model->frames[joint.axes].name,
                      {},
                      {}};
    for (std::size_t j = 0; j < model::joint_components; ++j) {
      (m.joints[i].determined[j] ? one.reactions : one.undetermined)
          .push_back(fmt::format("reaction.{}.{}", joint.name, j + 1));
    }
    found.joints.push_back(std::move(one));
  }
}

void add_forces(mechanics::Mechanics& m, Examination& found) {
  for (const conservation::ForceClassification& force : conservation::classify_forces(m)) {
    ForceClass one;
    one.name = force.name;
    one.conservative = conservation::name(force.conservative);
    if (force.potential) one.potential = item_of(m, *force.potential);
    for (const conservation::DomainCondition& c : force.domain)
      one.domain.push_back(shown(m, c.expression) + " " + c.relation);
    one.many_valued = force.many_valued;
    one.in_energy = force.in_energy;
    one.reason = force.reason;
    if (force.work) one.reason += ", of " + shown(m, *force.work) + " each time";
    found.forces.push_back(std::move(one));
  }
}

void add_contacts(const mechanics::Mechanics& m, Examination& found) {
  for (const mechanics::Contact& contact : m.contacts) {
    ExaminedContact one;
    one.name = contact.name;
    const std::size_t equations = contact.constraints.size();
    one.kind = equations == 0 ? "coordinate" : equations == 1 ? "surface" : "curve";
    one.law = contact.dimensions() == 0 ? "none" : contact.width ? "smooth" : "coulomb";
    for (const symbolic::Ref w : contact.slip)
      one.slip.push_back(shown(m, w, fmt::format("slip.{}.{}", contact.name, one.slip.size() + 1), found));
    one.unilateral = contact.unilateral;
    found.contacts.push_back(std::move(one));
  }
}

void add_singular(const mechanics::Mechanics& m, Examination& found) {
  for (const print::PrintedFormula& item : print::render_singular(m)) {
    if (item.left_out.empty())
      found.singular.push_back({item, item.role});
    else
      found.left_out.push_back({"singular sets: " + item.name, item.left_out});
  }
}

void add_charts(const mechanics::Mechanics& m, Examination& found) {
  for (const model::ChartPair& chart : pipeline::list_charts(m)) {
    ExaminedChart one{chart.of, chart.own, chart.second, {}, chart.refusal};
    for (const std::uint32_t q : chart.angles) one.angles.push_back(m.model->coordinates[q].name);
    found.charts.push_back(std::move(one));
  }
}

// Formats a number as a decimal, and a dependent parameter as its expression. Throws Error at `span` if an expression
// of numbers is undefined, as sqrt(-1).
std::string value_of(const mechanics::Mechanics& m, symbolic::Ref value, const std::string& what,
                     const model::Span& span) {
  constexpr int digits = 20;
  if (m.dag->symbols({value}).empty()) try {
      symbolic::evaluate(
          *m.dag, {value}, [](const symbolic::Symbol&) -> cln::cl_R { return 0; }, digits);
    } catch (const std::domain_error& error) {
      throw Error("mechanics", m.model->where(span), fmt::format("{} has no value: {}", what, error.what()),
                  "check the numbers that it is computed from");
    }
  return m.dag->is_constant(value) ? symbolic::decimal_text(m.dag->value(value)) : shown(m, value);
}

void fill_in(std::shared_ptr<const model::Model> read, Examination& found) {
  const model::Model& model = *read;
  mechanics::Mechanics m = mechanics::build_mechanics(std::move(read));
  bool has_all_units = true;
  const auto unit_of = [&has_all_units](const auto& quantity) {
    has_all_units = has_all_units && quantity.unit.dimension.has_value();
    return quantity.unit.text;
  };
  for (std::uint32_t i = 0; i < model.coordinates.size(); ++i)
    found.coordinates.push_back({model.coordinates[i].name, unit_of(model.coordinates[i]), m.is_eliminated(i)});
  found.degrees_of_freedom = m.degrees_of_freedom();
  for (std::uint32_t i = 0; i < model.states.size(); ++i) {
    const model::State& state = model.states[i];
    if (state.integral) continue;
    if (state.discrete) {
      found.discrete.push_back({state.name, unit_of(state)});
      continue;
    }
    found.states.push_back({state.name, unit_of(state), shown(m, m.dag->rates().at(mechanics::state_symbol(model, i))),
                            state.energy != model::no_node});
  }
  add_resets(m, found);
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const model::Parameter& p = model.parameters[i];
    found.parameters.push_back({p.name, unit_of(p),
                                value_of(m, m.parameter_value[i], fmt::format("parameter '{}'", p.name), p.span),
                                p.written});
  }
  for (const model::Input& input : model.inputs) {  // of the model as read: without those of contacts
    const bool given = input.default_value != model::no_node;
    found.inputs.push_back(
        {input.name, unit_of(input),
         given ? value_of(m, mechanics::lower_scalar(m, input.default_value), fmt::format("input '{}'", input.name),
                          m.model->arena[input.default_value].span)
               : "0",
         ""});
  }
  found.has_all_units = has_all_units;
  add_constraints(m, found);
  add_joints(m, found);
  add_contacts(m, found);
  add_charts(m, found);
  add_forces(m, found);
  system::EquationSystem system = derive::lagrange(m, system::Approach::two);
  const std::vector<conservation::ConservedQuantity> conserved = conservation::conserved_quantities(m, system);
  for (const auto& list : {conserved, conservation::conserved_where_zero(m, system, conserved)}) {
    for (const conservation::ConservedQuantity& c : list) {
      found.conserved.push_back({c.name, c.title, item_of(m, c.expression), conservation::name(c.certainty), {}});
      for (const std::uint32_t p : c.zero_parameters)
        found.conserved.back().where_zero.push_back(model.parameters[p].name);
    }
  }
  add_singular(m, found);
}

}  // namespace

Examination examine(std::shared_ptr<const model::Model> model, bool partial) {
  const work::Stage stage("examining the model");
  Examination found;
  try {
    fill_in(std::move(model), found);
  } catch (const work::Interrupted&) {
    if (!partial) throw;
    found.interrupted = true;
  }
  return found;
}

}  // namespace eomgen::analysis
