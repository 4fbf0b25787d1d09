// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/formulas.hpp"

#include <algorithm>

#include "print/letters.hpp"
#include "reading/trig.hpp"

namespace eomgen::print {

using reading::PowerOfSum;
using reading::Symbol;
using reading::SymbolKind;

Formula coordinate(std::uint32_t i, std::uint8_t order) { return reading::symbol({SymbolKind::coordinate, i, order}); }
Formula dotted(Formula letter, int order) {
  Formula result = reading::make_formula(FormulaKind::dot, {std::move(letter)});
  result.order = order;
  return result;
}
Formula index(std::uint32_t i) { return reading::number(static_cast<long>(i)); }
Formula partial(Formula of, Formula by) {
  return reading::make_formula(FormulaKind::partial, {std::move(of), std::move(by)});
}
Formula dot_product(Formula a, Formula b) {
  return reading::make_formula(FormulaKind::dot_product, {std::move(a), std::move(b)});
}

namespace {

constexpr std::size_t longest_in_a_list =
    3;  // terms of an acceleration that fits on a line with its coordinate and rate

Formula multiplier(std::uint32_t k) { return reading::symbol({SymbolKind::multiplier, k, 0}); }

// lambda times a derivative: numbers first, then lambda, then the rest.
Formula times_multiplier(std::uint32_t k, const Sum& slope) {
  const bool minus = reading::has_negative_leading_term(slope);
  const Formula f = arrange(minus ? -slope : slope);
  Formula result;
  if (f.kind == FormulaKind::product && f.args[0].kind == FormulaKind::number) {
    std::vector<Formula> factors(f.args);
    factors.insert(factors.begin() + 1, multiplier(k));
    result = reading::product(std::move(factors));
  } else if (f.kind == FormulaKind::number) {
    result = reading::product({f, multiplier(k)});
  } else if (f.kind == FormulaKind::fraction && f.args[0].kind == FormulaKind::symbol) {
    result = reading::fraction(reading::product({multiplier(k), f.args[0]}), f.args[1]);
  } else {
    result = reading::product({multiplier(k), f});
  }
  return minus ? reading::negative(std::move(result)) : result;
}

// Squares: (a + b)^2, a^2 b^2.
Formula squared(const Sum& w) {
  if (w.size() == 1) return arrange(w * w);
  return reading::make_formula(FormulaKind::power, {arrange(w), reading::number(2)});
}

Formula halved(std::vector<Formula> factors) {
  factors.insert(factors.begin(), reading::number(symbolic::Rational(1) / 2));
  return reading::product(std::move(factors));
}

/// J/2 times `squares`: 1/24 m l^2 (..), not 1/2 (1/12 m l^2) (..).
Formula with_half(const Sum& J, Formula squares) {
  if (J.size() > 1) return halved({arrange(J), std::move(squares)});
  return reading::product({arrange(symbolic::Rational(1) / 2 * J), std::move(squares)});
}

Formula component(const reading::DisplayRotation& spin, std::size_t k) {
  return mark("omega", {reading::number(static_cast<long>(k + 1)), reading::number(static_cast<long>(spin.frame))});
}

/// The expanded expression; 0 if that exceeds its budget.
Sum sum_of_squares(const std::vector<const Sum*>& components) {
  try {
    Sum together;
    for (const Sum* w : components) together += *w * *w;
    return reading::simplify(together);
  } catch (const work::BudgetExceeded&) {
    return {};
  }
}

/// w.Jw/2 with the fewest squares; `named`: with components that are defined separately.
std::vector<Formula> rotational_terms(const reading::DisplayRotation& spin, bool named) {
  std::vector<Formula> terms;
  std::array<bool, 3> done{};
  const auto square = [&](std::size_t k) {
    return named ? reading::make_formula(FormulaKind::power, {component(spin, k), reading::number(2)})
                 : squared(spin.w[k]);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (done[i] || spin.J[i][i].is_zero()) continue;
    std::vector<Formula> squares;
    std::vector<const Sum*> alike;
    for (std::size_t k = i; k < 3; ++k) {
      if (!(spin.J[k][k] == spin.J[i][i])) continue;
      done[k] = true;
      if (spin.w[k].is_zero()) continue;
      squares.push_back(square(k));
      alike.push_back(&spin.w[k]);
    }
    if (!named && alike.size() > 1) {
      const Sum together = sum_of_squares(alike);
      if (!together.is_zero() && together.size() < squares.size()) squares = {arrange(together)};  // sin^2 + cos^2
    }
    if (!squares.empty()) terms.push_back(with_half(spin.J[i][i], reading::sum(std::move(squares))));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = i + 1; k < 3; ++k) {
      if (spin.J[i][k].is_zero() || spin.w[i].is_zero() || spin.w[k].is_zero()) continue;
      const Formula a = named ? component(spin, i) : arrange(spin.w[i]),
                    b = named ? component(spin, k) : arrange(spin.w[k]);
      terms.push_back(reading::product({arrange(spin.J[i][k]), a, b}));
    }
  }
  return terms;
}

/// T as squares of velocities and of components of angular velocities; unchanged for a model without bodies, and where
/// translation and rotation together have fewer terms, as m L^2/8 + m L^2/24.
Formula kinetic_formula(const DisplayForm& form) {
  if (form.body_rotations.empty()) return arrange(form.kinetic);
  std::vector<Formula> terms =
      form.translation.is_zero() ? std::vector<Formula>{} : reading::arranged_terms(form.translation, Layout::grouped);
  for (const reading::DisplayRotation& spin : form.body_rotations) {
    for (Formula& term : rotational_terms(spin, false)) terms.push_back(std::move(term));
  }
  if (form.kinetic.size() < terms.size()) return arrange(form.kinetic);
  return reading::sum(std::move(terms));
}

// m r_dot . r_dot/2 + w.Jw/2, with named components of w.
void add_rotations(const Mechanics& m, const DisplayForm& form, const Formula& T, std::vector<Statement>& out) {
  std::vector<Formula> terms;
  for (const mechanics::PointMass& mass : m.masses) {
    const Formula place = reading::number(static_cast<long>(mass.place)), v = dotted(mark("r", {place}));
    terms.push_back(halved({mass_letter(m, mass), reading::make_formula(FormulaKind::dot_product, {v, v})}));
  }
  add_angular_velocities(form, out);
  for (const reading::DisplayRotation& spin : form.body_rotations) {
    for (Formula& term : rotational_terms(spin, true)) terms.push_back(std::move(term));
  }
  out.push_back({"energies", "kinetic energy", "", "", reading::relation({T, reading::sum(std::move(terms))})});
}

Formula read_or_dots(const Mechanics& m, symbolic::Ref expression) {
  try {
    return arrange(reading::display_sum(m, expression));
  } catch (const work::BudgetExceeded&) {
    return mark("...");  // too long to display
  }
}

// Q + sum lambda_k dpsi_k/dq, with a positive term first if there is one.
Formula right_side(const Equation& equation, const std::vector<PowerOfSum>& powers) {
  std::vector<Formula> terms = reading::arranged_terms(with_brackets(equation.force, powers), Layout::terms);
  for (const reading::MultiplierTerm& term : equation.multipliers)
    terms.push_back(times_multiplier(term.constraint, term.slope));
  const auto positive =
      std::find_if(terms.begin(), terms.end(), [](const Formula& f) { return f.kind != FormulaKind::negative; });
  if (positive != terms.end()) std::rotate(terms.begin(), positive, positive + 1);
  return reading::sum(std::move(terms));
}

}  // namespace

Formula momentum_form(const Equation& equation, const std::vector<PowerOfSum>& powers, bool joined) {
  std::vector<Formula> terms;
  if (!equation.momentum.is_zero()) {
    terms.push_back(reading::make_formula(FormulaKind::rate, {arrange(equation.momentum, Layout::terms)}));
  }
  const Sum slope = with_brackets(-equation.slope, powers);
  for (Formula& term :
       joined ? reading::arranged_fractions(slope, Layout::terms) : reading::arranged_terms(slope, Layout::terms))
    terms.push_back(std::move(term));
  return reading::relation({reading::sum(std::move(terms)), right_side(equation, powers)});
}

Formula explicit_form(const Equation& equation, const std::vector<PowerOfSum>& powers, bool joined) {
  const Sum expanded = with_brackets(equation.expanded, powers);
  return reading::relation(
      {joined ? reading::arrange_fractions(expanded, Layout::terms) : arrange(expanded, Layout::terms),
       right_side(equation, powers)});
}

void add_angular_velocities(const DisplayForm& form, std::vector<Statement>& out) {
  for (const reading::DisplayRotation& spin : form.body_rotations) {
    for (std::size_t k = 0; k < 3; ++k) {
      out.push_back({"energies", "angular velocity of " + spin.name, "", "",
                     reading::relation({component(spin, k), arrange(spin.w[k])})});
    }
  }
}

void add_energies(const Mechanics& m, const DisplayForm& form, std::vector<Statement>& out) {
  const bool two = form.approach == system::Approach::two;
  const Letters letters(*m.model, two);
  if (form.is_unexpanded && !form.body_rotations.empty()) add_rotations(m, form, mark(letters.T), out);
  if (form.is_unexpanded) return;
  const auto add = [&](std::string name, Formula left, const Sum& right) {
    out.push_back({"energies", std::move(name), "", "", reading::relation({std::move(left), arrange(right)})});
  };
  out.push_back({"energies", two ? "constrained kinetic energy" : "kinetic energy", "", "",
                 reading::relation({mark(letters.T), kinetic_formula(form)})});
  const bool moving = form.by_degree && !((*form.by_degree)[1].is_zero() && (*form.by_degree)[2].is_zero());
  if (moving) {
    for (int k = 0; k < 3; ++k) {
      add("T" + std::to_string(2 - k), mark(letters.T, {reading::number(2 - k)}),
          (*form.by_degree)[static_cast<std::size_t>(k)]);
    }
  }
  add(two ? "constrained potential energy" : "potential energy", mark(letters.U),
      with_powers(form.potential, form.powers));
}

void add_lagrangian(const Mechanics& m, const DisplayForm& form, std::vector<Statement>& out) {
  if (form.is_unexpanded) return;
  const Formula L = mark(Letters(*m.model, form.approach == system::Approach::two).L);
  std::vector<Formula> terms = form.body_rotations.empty() ? reading::arranged_terms(form.kinetic, Layout::grouped)
                                                           : std::vector<Formula>{kinetic_formula(form)};
  if (!form.potential.is_zero()) {
    for (Formula& term : reading::arranged_terms(-with_powers(form.potential, form.powers), Layout::grouped))
      terms.push_back(std::move(term));
  }
  out.push_back({"lagrangian", "Lagrangian", "", "", reading::relation({L, reading::sum(std::move(terms))})});
}

void add_constraints(const Mechanics& m, const DisplayForm& form, std::vector<Statement>& out) {
  const Letters letters(*m.model, false);
  for (std::uint32_t f = 0; f < m.model->functions.size(); ++f) {
    const model::Function& function = m.model->functions[f];
    const std::optional<Formula> written = reading::as_written(*m.model, function.expression);
    if (!written) continue;
    out.push_back({"constraints", function.name, "", "function of time",
                   reading::relation({reading::symbol({SymbolKind::function, f, 0}), *written})});
  }
  for (const reading::DisplayConstraint& c : form.constraints) {
    const auto add = [&](std::string role, Formula formula) {
      out.push_back({"constraints", c.label, "", std::move(role), std::move(formula)});
    };
    const Formula zero = reading::number(0);
    const Formula psi = constraint_letter(letters, m, c.constraint);
    const auto as_read = [&] {
      if (!(c.holonomic ? c.psi_skip_reason : c.rate_skip_reason).empty()) return mark("...");
      return arrange(c.holonomic ? c.psi : c.rate, c.holonomic ? Layout::grouped : Layout::terms);
    };
    const std::optional<Formula> as_given = reading::as_written(*m.model, m.constraints[c.constraint].model_expression);
    const Formula written = as_given ? *as_given : as_read();
    const auto add_sum = [&](const char* role, const Sum& sum, const std::string& why) {
      if (why.empty())
        add(role, reading::relation({arrange(sum, Layout::terms), zero}));
      else
        out.push_back(left_out("constraints", c.label, role, why));
    };
    if (c.fixes) {
      const std::uint32_t q = c.fixes->coordinate;
      add("fixes a coordinate", reading::relation({psi, written, zero}));
      std::vector<Formula> motion{reading::relation({coordinate(q, 0), arrange(c.value)}),
                                  reading::relation({coordinate(q, 1), arrange(c.value_rate)}),
                                  reading::relation({coordinate(q, 2), arrange(c.value_acceleration, Layout::terms)})};
      if (c.value_acceleration.size() > longest_in_a_list) {
        for (Formula& f : motion) add("fixes a coordinate", std::move(f));
      } else {
        add("fixes a coordinate", reading::make_formula(FormulaKind::list, std::move(motion)));
      }
    } else if (!c.holonomic) {
      const mechanics::Integrability found = m.classification[c.constraint].integrable;
      add(found == mechanics::Integrability::yes  ? "binds velocities, integrable"
          : found == mechanics::Integrability::no ? "binds velocities, not integrable"
                                                  : "binds velocities, integrability unknown",
          // Equations by parts define it.
          form.is_unexpanded ? reading::relation({dotted(psi), written, zero}) : reading::relation({written, zero}));
      for (const mechanics::ConstraintIntegral& integral : m.integrals) {
        if (integral.label == c.label)
          add("its integral",
              reading::relation({reading::make_formula(FormulaKind::rate, {read_or_dots(m, integral.psi)}), zero}));
      }
      add_sum("its time derivative", c.acceleration, c.acceleration_skip_reason);
    } else {
      add("keeps its multiplier", reading::relation({psi, written, zero}));
      add_sum("its first time derivative", c.rate, c.rate_skip_reason);
      add_sum("its second time derivative", c.acceleration, c.acceleration_skip_reason);
    }
  }
}

namespace {

constexpr std::size_t max_terms = 300;  // terms of a readable equation

std::size_t longest_equation(const DisplayForm& form) {
  std::size_t longest = 0;
  for (const Equation& e : form.equations) longest = std::max(longest, e.expanded.size() + e.force.size());
  return longest;
}

}  // namespace

void add_equations(const Mechanics& m, const DisplayForm& form, std::vector<Statement>& out) {
  const auto add = [&](const char* key, bool of_motion, auto&& formula) {
    for (const Equation& equation : form.equations) {
      if (equation.of_motion != of_motion) continue;
      out.push_back({key, "", m.model->coordinates[equation.coordinate].name, of_motion ? "motion" : "constraint force",
                     formula(equation)});
    }
  };
  if (form.is_unexpanded) return add_equations_by_parts(m, form, out);
  if (const std::size_t terms = longest_equation(form); terms > max_terms) {
    add_equations_by_parts(m, form, out);
    out.push_back(left_out("equations written out", "", "", "the longest has " + std::to_string(terms) + " terms"));
    return;
  }
  for (const bool of_motion : {true, false})
    add("equations", of_motion, [&](const Equation& e) { return momentum_form(e, form.powers); });
  for (const bool of_motion : {true, false})
    add("explicit", of_motion, [&](const Equation& e) { return explicit_form(e, form.powers); });
}

void add_states(const Mechanics& m, std::vector<Statement>& out) {
  for (const auto& [symbol, rate] : m.dag->rates()) {
    if (symbol.kind != SymbolKind::state) continue;
    const model::State& state = m.model->states[symbol.index];
    if (state.discrete) continue;  // its rate is 0
    const std::optional<Formula> written = reading::as_written(*m.model, state.rate);
    out.push_back({"states", state.name, "", "state of first order",
                   reading::relation({dotted(reading::symbol(symbol)), written ? *written : read_or_dots(m, rate)})});
  }
}

void add_resets(const Mechanics& m, std::vector<Statement>& out) {
  using Target = model::Assignment::Target;
  const auto add = [&](const std::string& name, const char* role, const model::Reset& reset) {
    for (const model::Assignment& set : reset.set) {
      const Formula target = set.target == Target::state
                                 ? reading::symbol({SymbolKind::state, set.index, 0})
                                 : coordinate(set.index, set.target == Target::velocity ? 1 : 0);
      const std::optional<Formula> value = reading::as_written(*m.model, set.value);
      if (value)
        out.push_back({"resets", name, "", role, reading::relation({target, *value})});
      else
        out.push_back(left_out("resets", name, role, "its formula has no display form"));
    }
  };
  for (const model::Event& event : m.model->events) add(event.name, "event", event.reset);
  for (const model::Sample& sample : m.model->samples) add(sample.name, "sample", sample.reset);
}

void add_reactions(const DisplayForm& form, std::vector<Statement>& out) {
  for (const reading::DisplayReaction& reaction : form.reactions) {
    if (!reaction.value) continue;
    const Sum value = with_brackets(*reaction.value, form.powers);
    const bool long_sum = value.size() > 8;  // lines break between terms, not within brackets
    out.push_back({"reactions", reaction.label, "", "",
                   reading::relation(
                       {multiplier(reaction.constraint), arrange(value, long_sum ? Layout::terms : Layout::grouped)})});
  }
}

/// Approach II does not close with friction: the law depends on the multiplier of a constraint that it eliminates,
/// section 2.11.9 of the source.
void note_normal_forces(const Mechanics& m, const DisplayForm& form, std::vector<Statement>& out) {
  if (form.approach != system::Approach::two) return;
  for (const mechanics::Contact& contact : m.contacts) {
    const auto eliminated = [&](const reading::DisplayConstraint& c) {
      return c.fixes && std::find(contact.constraints.begin(), contact.constraints.end(), c.constraint) !=
                            contact.constraints.end();
    };
    if (contact.dimensions() == 0 || std::none_of(form.constraints.begin(), form.constraints.end(), eliminated))
      continue;
    out.push_back(left_out("friction", contact.name, "multiplier",
                           "approach II eliminates it, so that its equations do not close with friction; approach I "
                           "gives it as a function of the motion"));
  }
}

void add_statements(const Mechanics& m, const DisplayForm& form, const std::vector<std::string>& show,
                    std::vector<Statement>& out) {
  const auto wanted = [&](const char* key) {
    return std::any_of(show.begin(), show.end(), [&](const std::string& s) { return s == key || s == "all"; });
  };
  // A statement that exceeds its budget is omitted with the reason; the others are kept.
  const auto add = [&](const char* key, const auto& statements) {
    if (!wanted(key)) return;
    try {
      statements();
    } catch (const work::BudgetExceeded& over) {
      out.push_back(left_out(key, "", "", over.what()));
    }
  };
  add("constraints", [&] { add_constraints(m, form, out); });
  add("energies", [&] { add_energies(m, form, out); });
  add("lagrangian", [&] { add_lagrangian(m, form, out); });
  add("equations", [&] { add_equations(m, form, out); });
  add("equations", [&] {
    add_states(m, out);
    add_resets(m, out);
  });
  add("reactions", [&] { add_reactions(form, out); });
  add("reactions", [&] { add_constraint_forces(m, form, out); });
  add("friction", [&] {
    add_contacts(m, out);
    note_normal_forces(m, form, out);
  });
  std::vector<std::string> of_geometry;
  for (const char* key : {"basis", "metric", "line_element", "christoffel"}) {
    if (wanted(key)) of_geometry.emplace_back(key);
  }
  if (!of_geometry.empty()) add_geometry(m, of_geometry, out);
  if (wanted("basis")) {
    add_euler_bases(m, out);
    add_system_basis(m, out);
  }
  if (std::find(show.begin(), show.end(), "kinematics") != show.end()) add_kinematics(m, out);
  if (std::find(show.begin(), show.end(), "regressor") != show.end()) add_regressor(m, out);
  if (std::find(show.begin(), show.end(), "forces") != show.end()) add_body_forces(m, out);
  if (std::find(show.begin(), show.end(), "contravariant") != show.end()) add_contravariant(m, out);
  if (std::find(show.begin(), show.end(), "balance") != show.end()) add_balance(m, out);
  add("frenet", [&] { add_frenet(m, std::find(show.begin(), show.end(), "frenet") != show.end(), out); });
  add("singular", [&] { add_singular(m, out); });
}

}  // namespace eomgen::print
