// SPDX-License-Identifier: GPL-3.0-or-later
// Findings beyond the equations: conserved quantities, Routh's reduction, steady motions, singular sets, the
// certificate.
#include <array>
#include <eom/output/decimal.hpp>

#include "print/article_parts.hpp"

namespace eomgen::print {

using system::OutputKind;

namespace {

/// 1.5e-07 -> 1.5\cdot 10^{-7}
std::string number_in_latex(double value) {
  std::array<char, 32> digits{};
  const auto end =
      eom::decimals::write_decimal(digits.data(), digits.data() + digits.size(), value == 0 ? 0.0 : value, 6);
  std::string text(digits.data(), end);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  return text.substr(0, e) + "\\cdot 10^{" + std::to_string(std::stoi(text.substr(e + 1))) + "}";
}

Formula letter_of(const Article& a, const ConservedFinding& c) {
  const Formula axis = reading::number(static_cast<long>(c.part) + 1);
  switch (c.kind) {
    case OutputKind::momentum: return reading::symbol(reading::momentum_symbol(c.index));
    case OutputKind::linear_momentum: return mark(free_letter(a.model, "G", "cal G"), {axis});
    case OutputKind::angular_momentum: return mark(free_letter(a.model, "H", "cal H"), {axis});
    case OutputKind::energy: return mark("cal E");  // E denotes the fixed axes
    default: return mark(free_letter(a.model, "h", "cal H"));
  }
}

std::string reason_of(const Article& a, const ConservedFinding& c) {
  const auto rates = [&](const char* what) {
    return std::string(
               "its rate is the power of moving constraints, of friction and of forces that are in no potential, less "
               "the slope of ") +
           what + " by the time, and all of this vanishes";
  };
  switch (c.kind) {
    case OutputKind::momentum: {
      const std::string q = a.coordinate_math(c.index);
      return q + " is cyclic: the Lagrangian of Approach II has " + a.coordinate_math(c.index, 1) + " but not " + q +
             ", and along " + q +
             " neither a force beyond the potential nor a constraint that keeps its multiplier acts";
    }
    case OutputKind::energy: return rates("the Lagrangian");
    case OutputKind::jacobi:
      return "the Lagrangian of Approach II is free of the time, and no constraint that keeps its multiplier moves; "
             "the energy itself is not conserved, since constraints do work";
    case OutputKind::applied_energy:
      return "all forces have potentials, which are added here to $U$, and the Lagrangian is free of the time";
    case OutputKind::linear_momentum:
      return "a displacement of the whole along this axis changes neither energies nor constraints, and no force acts "
             "along it";
    case OutputKind::angular_momentum:
      return c.index == 0
                 ? "a turn of the whole about this axis changes neither energies nor constraints, and no moment acts "
                   "about it"
                 : "a turn of this body about this axis through that point violates no constraint, and no moment acts "
                   "about it";
    default: return "the constraint on velocities is the rate of it";
  }
}

/// Nothing if it is too long to write out.
std::optional<Formula> value_of(Article& a, const ConservedFinding& c) {
  try {
    const reading::Sum sum = c.named ? *c.named : reading::display_sum(a.m, c.expression);
    Formula value = a.with_letters(reading::arrange(with_powers(sum, a.powers)));
    const std::string why = a.out.reason_too_long(value);
    if (why.empty()) return value;
    a.left_out.push_back({c.title, why});
    return std::nullopt;
  } catch (const work::BudgetExceeded& over) {
    a.left_out.push_back({c.title, over.what()});
    return std::nullopt;
  }
}

std::string eigenvalues_of(const SteadyFinding& s) {
  std::vector<std::string> parts;
  for (const std::complex<double>& e : s.eigenvalues) {
    if (e.imag() == 0)
      parts.push_back("$" + number_in_latex(e.real()) + "$");
    else
      parts.push_back("$" + (e.real() == 0 ? "" : number_in_latex(e.real())) + " \\pm " + number_in_latex(e.imag()) +
                      "\\,\\mathrm{i}$");
  }
  if (s.zero_eigenvalues > 0)
    parts.push_back(s.zero_eigenvalues == 1 ? "one zero" : std::to_string(s.zero_eigenvalues) + " zeros");
  return enumeration(parts);
}

void write_steady_motion(Article& a, const SteadyFinding& s) {
  std::vector<std::string> values;
  for (const auto& [symbol, value] : s.values)
    values.push_back(a.out.math(reading::symbol(symbol)) + "~$= " + number_in_latex(value) + "$");
  std::string text = "\\textbf{" + escape_user_text(s.kind) + "}: ";
  for (std::size_t i = 0; i < values.size(); ++i) text += (i > 0 ? ", " : "") + values[i];
  text += ". ";
  if (s.family_dimension > 0)
    text += "One of a family of " + std::to_string(s.family_dimension) +
            (s.family_dimension == 1 ? " dimension. " : " dimensions. ");
  text += "\\emph{" + escape_user_text(s.stability) + "}: " + escape_user_text(s.reason) +
          ". Eigenvalues of the linearised equations: " + eigenvalues_of(s) + ".";
  a.out.paragraph(text);
}

}  // namespace

void write_conserved_quantities(Article& a) {
  a.out.section("Conserved quantities");
  const std::vector<ConservedFinding>& all = a.findings->conserved;
  if (all.empty())
    a.out.paragraph(
        "None was found: no coordinate is cyclic, neither the energy nor Jacobi's integral is conserved, nor a "
        "momentum along or about a fixed axis.");
  for (const ConservedFinding& c : all) {
    const std::string title = c.kind == OutputKind::momentum ? "generalised momentum of " + a.coordinate_math(c.index)
                                                             : escape_user_text(c.title);
    a.out.paragraph("The " + title + " is conserved: " + reason_of(a, c) +
                    (c.proven ? "." : " (shown by numbers, in 40 digits)."));
    const std::optional<Formula> value = value_of(a, c);
    if (!value) continue;
    a.out.display({c.kind == OutputKind::integral ? *value : reading::relation({letter_of(a, c), *value})});
  }
}

void write_routh(Article& a) {
  if (!a.findings->routh) return;
  const reading::RouthForm& form = *a.findings->routh;
  std::vector<std::string> names;
  for (const std::uint32_t c : form.cyclic) names.push_back(a.coordinate_math(c));
  a.out.section("Routh's reduction");
  if (form.is_unexpanded) {
    a.out.paragraph("The reduction by " + enumeration(names) +
                    " is too long to be written out, or the momenta do not give the rates.");
    return;
  }
  std::vector<Formula> rates;
  for (std::size_t i = 0; i < form.cyclic.size(); ++i) {
    rates.push_back(reading::relation({reading::symbol({symbolic::SymbolKind::coordinate, form.cyclic[i], 1}),
                                       reading::arrange_fractions(form.rates[i])}));
  }
  a.out.paragraph("The momenta of the cyclic coordinates are constants of the motion, and give the rates");
  a.out.display(rates);
  a.out.paragraph(
      "With these the Routhian, the Lagrangian of Approach II less " +
      std::string(form.cyclic.size() == 1 ? "the product of momentum and rate" : "the products of momenta and rates") +
      ", is");
  a.out.display(
      {reading::relation({mark("cal R"), reading::arrange_fractions(-with_powers(-form.routhian, form.powers))})});
  if (form.equations.empty()) return;
  a.out.paragraph(form.equations.size() == 1 ? "and one equation is left:" : "and the equations that are left are");
  for (const reading::Equation& equation : form.equations)
    a.out.numbered_display(a.out.next_number(), a.with_letters(explicit_form(equation, form.powers, true)));
  if (!form.energy) return;
  a.out.paragraph("The reduced motion keeps");
  a.out.display({reading::relation(
      {mark(free_letter(a.model, "h", "cal H")), reading::arrange_fractions(with_powers(*form.energy, form.powers))})});
}

void write_steady_motions(Article& a) {
  a.out.section("Equilibria and steady motions");
  const Findings& found = *a.findings;
  if (!found.steady_skip_reason.empty()) {
    a.out.paragraph("None is given here: " + escape_user_text(found.steady_skip_reason) + ".");
    return;
  }
  std::string text = "At the parameters of the default scene";
  for (std::size_t i = 0; i < found.held.size(); ++i) {
    text += (i == 0 ? ", with " : ", ") + escape_user_text(found.held[i].first) + " held at $" +
            number_in_latex(found.held[i].second) + "$";
  }
  a.out.paragraph(text + ", " +
                  (found.steady.empty()
                       ? "a search has found no equilibrium and no steady motion."
                       : "a search has found these, in SI units; it does not prove that there are no others.") +
                  (found.steady.empty() ? "" : " In a steady motion only ignorable coordinates change."));
  for (const SteadyFinding& s : found.steady) write_steady_motion(a, s);
}

void write_singular_sets(Article& a) {
  std::vector<Statement> all;
  add_singular(a.m, all);
  if (all.empty()) return;
  a.out.section("Where the equations fail");
  for (const char* role : {"both", "I", "II"}) {
    std::vector<Formula> shown;
    for (const Statement& s : all) {
      if (s.left_out.empty() && s.role == role) shown.push_back(s.formula);
    }
    if (shown.empty()) continue;
    a.out.paragraph(std::string(role) == "both"
                        ? "By both approaches they have no solution, or a force has no value, where"
                        : "By Approach " + std::string(role) + " this is so where");
    a.out.display(shown);
  }
  for (const Statement& s : all) {
    if (!s.left_out.empty()) a.left_out.push_back({"singular sets: " + s.name, s.left_out});
  }
}

void write_certificate(Article& a) {
  if (a.findings != nullptr) {
    a.out.section("Certificate");
    a.out.paragraph("The equations above and the formulations " + escape_user_text(a.findings->checked_formulations) +
                    " were compared with d'Alembert's principle, evaluated from the model alone: " +
                    escape_user_text(a.findings->certificate) + ".");
  }
  if (a.left_out.empty()) return;
  a.out.section("Left out");
  for (const work::LeftOut& l : a.left_out)
    a.out.paragraph(escape_user_text(l.what) + ": " + escape_user_text(l.why) + ".");
}

}  // namespace eomgen::print
