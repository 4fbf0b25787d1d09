// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/formulas.hpp"

#include <algorithm>

namespace eomgen::print {

using mechanics::Mechanics;
using reading::arrange;
using reading::Equation;
using reading::Form;
using reading::Formula;
using reading::Layout;
using reading::mark;
using reading::ReadingForm;
using reading::Sum;
using reading::Symbol;
using reading::SymbolKind;

namespace {

Formula coordinate(std::uint32_t i, std::uint8_t order) { return reading::symbol({SymbolKind::coordinate, i, order}); }
Formula multiplier(std::uint32_t k) { return reading::symbol({SymbolKind::multiplier, k, 0}); }

// Q + sum lambda_k dpsi_k/dq
Formula right_side(const Equation& equation) {
  std::vector<Formula> terms = reading::arranged_terms(equation.force, Layout::terms);
  for (const reading::MultiplierTerm& term : equation.multipliers) {
    // one term of slope: its factors around lambda; several: lambda (..)
    const Formula slope = arrange(term.slope);
    const bool minus = slope.form == Form::negative;
    Formula factor = reading::product({multiplier(term.constraint), minus ? slope.args[0] : slope});
    const Formula& inside = minus ? slope.args[0] : slope;
    if (inside.form == Form::product && inside.args[0].form == Form::number) {
      std::vector<Formula> rest(inside.args.begin() + 1, inside.args.end());
      rest.insert(rest.begin(), multiplier(term.constraint));
      rest.insert(rest.begin(), inside.args[0]);
      factor = reading::product(std::move(rest));
    } else if (inside.form == Form::number) {
      factor = reading::product({inside, multiplier(term.constraint)});
    }
    terms.push_back(minus ? reading::negative(std::move(factor)) : std::move(factor));
  }
  return reading::sum(std::move(terms));
}

}  // namespace

Formula momentum_form(const Equation& equation) {
  std::vector<Formula> terms;
  if (!equation.momentum.is_zero()) {
    terms.push_back(reading::wrap(Form::rate, {arrange(equation.momentum, Layout::terms)}));
  }
  for (Formula& term : reading::arranged_terms(-equation.slope, Layout::terms)) terms.push_back(std::move(term));
  return reading::relation({reading::sum(std::move(terms)), right_side(equation)});
}

Formula explicit_form(const Equation& equation) {
  return reading::relation({arrange(equation.expanded, Layout::terms), right_side(equation)});
}

void add_energies(const ReadingForm& form, std::vector<Statement>& out) {
  if (form.by_parts) return;
  const bool two = form.approach == system::Approach::two;
  const auto add = [&](std::string name, Formula left, const Sum& right) {
    out.push_back({"energies", std::move(name), "", "", reading::relation({std::move(left), arrange(right)})});
  };
  add(two ? "constrained kinetic energy" : "kinetic energy", mark(two ? "T~" : "T"), form.kinetic);
  const bool moving = form.by_degree && !((*form.by_degree)[1].is_zero() && (*form.by_degree)[2].is_zero());
  if (moving) {
    for (int k = 0; k < 3; ++k) {
      add("T" + std::to_string(2 - k), mark("T~", {reading::number(2 - k)}), (*form.by_degree)[static_cast<std::size_t>(k)]);
    }
  }
  add(two ? "constrained potential energy" : "potential energy", mark(two ? "U~" : "U"), form.potential);
}

void add_lagrangian(const ReadingForm& form, std::vector<Statement>& out) {
  if (form.by_parts) return;
  const Formula L = mark(form.approach == system::Approach::two ? "L~" : "L");
  std::vector<Formula> terms = reading::arranged_terms(form.kinetic, Layout::grouped);
  for (Formula& term : reading::arranged_terms(-form.potential, Layout::grouped)) terms.push_back(std::move(term));
  out.push_back({"lagrangian", "Lagrangian", "", "", reading::relation({L, reading::sum(std::move(terms))})});
}

void add_constraints(const Mechanics& m, const ReadingForm& form, std::vector<Statement>& out) {
  for (std::uint32_t f = 0; f < m.model->functions.size(); ++f) {
    try {
      const Sum value = reading::read(m, m.function_value[f]);
      out.push_back({"constraints", m.model->functions[f].name, "", "function of time",
                     reading::relation({reading::symbol({SymbolKind::function, f, 0}), arrange(value)})});
    } catch (const reading::TermBudget&) {
      continue;
    }
  }
  for (const reading::ReadConstraint& c : form.constraints) {
    const auto add = [&](std::string role, Formula formula) {
      out.push_back({"constraints", c.label, "", std::move(role), std::move(formula)});
    };
    const Formula zero = reading::number(0);
    const Formula psi = form.constraints.size() == 1 ? mark("psi") : mark("psi", {reading::number(c.constraint + 1)});
    if (c.fixes) {
      const std::uint32_t q = c.fixes->coordinate;
      add("fixes a coordinate", reading::relation({psi, arrange(c.psi), zero}));
      add("fixes a coordinate", reading::wrap(Form::list, {reading::relation({coordinate(q, 0), arrange(c.value)}),
                                                           reading::relation({coordinate(q, 1), arrange(c.value_rate)}),
                                                           reading::relation({coordinate(q, 2), arrange(c.value_acceleration)})}));
    } else {
      add("keeps its multiplier", reading::relation({psi, arrange(c.psi), zero}));
      add("its first time derivative", reading::relation({arrange(c.rate, Layout::terms), zero}));
      add("its second time derivative", reading::relation({arrange(c.acceleration, Layout::terms), zero}));
    }
  }
}

// Too long to be written out: sum m r_ddot . dr/dq_i = -dU/dq_i + Q_i, eq. (3.20).
Formula by_parts(const Mechanics& m, const Equation& equation) {
  std::vector<Formula> left, right;
  const Formula q = coordinate(equation.coordinate, 0);
  for (const mechanics::PointMass& mass : m.masses) {
    std::uint32_t place = 0;
    for (std::uint32_t i = 0; i < m.model->places.size(); ++i) {
      if (m.model->places[i].name == mass.name) place = i;
    }
    const Formula r = mark("r", {reading::number(static_cast<long>(place))});
    Formula acceleration = reading::wrap(Form::dot, {r});
    acceleration.order = 2;
    left.push_back(reading::product({mark("m", {reading::number(static_cast<long>(place))}),
                                     reading::wrap(Form::dot_product, {acceleration, reading::wrap(Form::partial, {r, q})})}));
  }
  right.push_back(reading::negative(reading::wrap(Form::partial, {mark("U"), q})));
  right.push_back(mark("Q", {q}));
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    right.push_back(reading::product({multiplier(k), reading::wrap(Form::partial, {mark("psi", {reading::number(k + 1)}), q})}));
  }
  return reading::relation({reading::sum(std::move(left)), reading::sum(std::move(right))});
}

void add_equations(const Mechanics& m, const ReadingForm& form, std::vector<Statement>& out) {
  const auto add = [&](const char* key, bool of_motion, auto&& formula) {
    for (const Equation& equation : form.equations) {
      if (equation.of_motion != of_motion) continue;
      out.push_back({key, "", m.model->coordinates[equation.coordinate].name, of_motion ? "motion" : "constraint force",
                     formula(equation)});
    }
  };
  if (form.by_parts) {
    for (const bool of_motion : {true, false}) add("equations", of_motion, [&](const Equation& e) { return by_parts(m, e); });
    return;
  }
  for (const bool of_motion : {true, false}) add("equations", of_motion, momentum_form);
  for (const bool of_motion : {true, false}) add("explicit", of_motion, explicit_form);
}

void add_reactions(const ReadingForm& form, std::vector<Statement>& out) {
  for (const reading::ReadReaction& reaction : form.reactions) {
    if (!reaction.value) continue;
    out.push_back({"reactions", reaction.label, "", "",
                   reading::relation({multiplier(reaction.constraint), arrange(*reaction.value)})});
  }
}

void add_lagrangian(const ReadingForm& form, std::vector<Statement>& out);

std::vector<Statement> statements(const Mechanics& m, const ReadingForm& form, const std::vector<std::string>& show) {
  const auto wanted = [&](const char* key) {
    return std::any_of(show.begin(), show.end(), [&](const std::string& s) { return s == key || s == "all"; });
  };
  std::vector<Statement> out;
  if (wanted("constraints")) add_constraints(m, form, out);
  if (wanted("energies")) add_energies(form, out);
  if (wanted("lagrangian")) add_lagrangian(form, out);
  if (wanted("equations")) add_equations(m, form, out);
  if (wanted("reactions")) add_reactions(form, out);
  return out;
}

}  // namespace eomgen::print
