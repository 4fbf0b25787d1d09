// SPDX-License-Identifier: GPL-3.0-or-later
// The contravariant form of the equations, and the bases of E^3N, as formulas.

#include "print/formulas.hpp"
#include "print/render.hpp"
#include "reading/contravariant.hpp"

namespace eomgen::print {

namespace {

Formula product_of(Formula factor, const Sum& sum) {
  return reading::product({std::move(factor), reading::arrange(sum, Layout::grouped)});
}

// m (qddot + curvature) = force + sum lambda component.
Formula equation_formula(const reading::ContravariantForm& form, const reading::ContravariantEquation& equation) {
  std::vector<Formula> inside{coordinate(equation.coordinate, 2)};
  for (Formula& term : reading::arranged_terms(equation.curvature, Layout::terms)) inside.push_back(std::move(term));
  const bool unit = form.mass == Sum(1);
  Formula left = reading::sum(std::move(inside));
  if (!unit) left = reading::product({reading::arrange(form.mass), std::move(left)});
  std::vector<Formula> right = reading::arranged_terms(equation.force, Layout::terms);
  for (const reading::MultiplierTerm& term : equation.multipliers) {
    const bool minus = reading::has_negative_leading_term(term.slope);
    Formula factor =
        product_of(reading::symbol({SymbolKind::multiplier, term.constraint, 0}), minus ? -term.slope : term.slope);
    right.push_back(minus ? reading::negative(std::move(factor)) : std::move(factor));
  }
  return reading::relation({left, reading::sum(std::move(right))});
}

Formula along(const std::vector<Sum>& components) {
  std::vector<Formula> terms;
  for (std::uint32_t k = 0; k < components.size(); ++k) {
    if (components[k].is_zero()) continue;
    const bool minus = reading::has_negative_leading_term(components[k]);
    Formula term =
        reading::product({reading::arrange(minus ? -components[k] : components[k]), mark("e", {index(k + 1)})});
    terms.push_back(minus ? reading::negative(std::move(term)) : std::move(term));
  }
  return reading::sum(std::move(terms));
}

}  // namespace

void add_contravariant(const Mechanics& m, std::vector<Statement>& out) {
  const reading::ContravariantForm form = reading::contravariant_form(m);
  if (!form.skip_reason.empty()) return out.push_back(left_out("contravariant", "", "", form.skip_reason));
  for (const reading::ContravariantEquation& equation : form.equations)
    out.push_back(
        {"contravariant", "", m.model->coordinates[equation.coordinate].name, "", equation_formula(form, equation)});
}

void add_system_basis(const Mechanics& m, std::vector<Statement>& out) {
  const std::optional<reading::SystemBasis> basis = reading::system_basis(m);
  if (!basis) return;
  std::string where = " basis of E^" + std::to_string(3 * basis->particles.size()) + " (";
  for (std::size_t i = 0; i < basis->particles.size(); ++i)
    where += (i > 0 ? "; " : "") + ("e_" + std::to_string(3 * i + 1)) + " to e_" + std::to_string(3 * i + 3) + ": '" +
             basis->particles[i] + "'";
  where += ")";
  const auto add = [&](const char* role, const std::vector<std::vector<Sum>>& vectors, bool raised) {
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      const Formula q = coordinate(basis->coordinates[i], 0);
      const Formula left = raised ? mark("a", {}, {q}) : mark("a", {q});
      out.push_back({"basis", "system", "", role + where, reading::relation({left, along(vectors[i])})});
    }
  };
  add("covariant", basis->covariant, false);
  add("contravariant", basis->contravariant, true);
}

}  // namespace eomgen::print
