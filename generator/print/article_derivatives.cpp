// SPDX-License-Identifier: GPL-3.0-or-later
// The energies, Lagrange's law and its partial derivatives, by both approaches.
#include <algorithm>

#include "print/article_parts.hpp"
#include "print/named_lengths.hpp"
#include "reading/partials.hpp"

namespace eomgen::print {

using reading::PartialDerivatives;

namespace {

bool equal(const PartialDerivatives& a, const PartialDerivatives& b) {
  return a.coordinate == b.coordinate && a.left_out.empty() && b.left_out.empty() && a.momentum == b.momentum &&
         a.rate == b.rate && a.kinetic == b.kinetic && a.potential == b.potential && a.force == b.force;
}

/// The indices of the components of angular velocities, and the axes along which they are taken.
std::string angular_velocity_legend(const Article& a) {
  std::vector<std::string> numbers, before;  // `before`: bodies with the axes before their last rotation
  for (const mechanics::BodyRotation& spin : a.m.body_rotations) {
    numbers.push_back(std::to_string(spin.frame) + " for " + bold(spin.name));
    if (spin.axes_angular_velocity != spin.w) before.push_back(bold(spin.name));
  }
  std::string text =
      "In $\\omega_{kb}$ the index $k$ is that of the axis and $b$ that of the body: " + enumeration(numbers) +
      ". The components are taken along the axes of the body";
  if (before.empty()) return text + ".";
  const bool all = before.size() == numbers.size();
  text += all ? " before its last rotation"
              : "; those of " + enumeration(before) + " along its axes before the last rotation";
  return text + ". The inertia does not change in that rotation.";
}

}  // namespace

void write_energies(Article& a) {
  a.out.section("Energies");
  const auto show = [&](const DisplayForm& form) {
    std::vector<Statement> all;
    if (!form.is_unexpanded) add_angular_velocities(form, all);
    add_energies(a.m, form, all);
    name_lengths(a.m, all, &a.letters);
    a.out.display(a.formulas(all));
    if (!form.rotations_skip_reason.empty()) a.left_out.push_back({"angular velocities", form.rotations_skip_reason});
  };
  const bool body_rotations = !a.one.body_rotations.empty();
  if (body_rotations) a.out.paragraph(angular_velocity_legend(a));
  show(a.one);
  if (a.approaches_differ()) {
    a.out.paragraph("With the constraints built in these are");
    show(a.two);
  }
  if (a.lengths.empty()) return;
  a.out.paragraph("Here and in the equations below,");
  a.out.display(a.formulas(a.lengths));
}

void write_lagrange_law(Article& a) {
  const Letters letters(a.model, false);
  const Formula q = mark("q"), rate = dotted(q);
  std::vector<Formula> left{
      reading::make_formula(FormulaKind::rate, {reading::make_formula(FormulaKind::partial, {mark(letters.T), rate})}),
      reading::negative(reading::make_formula(FormulaKind::partial, {mark(letters.T), q})),
      reading::make_formula(FormulaKind::partial, {mark(letters.U), q})};
  const std::string equation = a.out.math(reading::sum(std::move(left)));  // between $ and $
  const bool constrained = !a.one.constraints.empty();
  a.out.paragraph(std::string("Of every coordinate $q$, with its generalised force $Q_q$ beyond the potential") +
                  (constrained ? " and the forces of the constraints on the right side," : ","));
  a.out.raw("\\[\n" + equation.substr(1, equation.size() - 2) + " = Q_q" +
            (constrained ? " + \\sum_k \\" + free_letter(a.model, "lambda", "mu") + "_{k} f_{k q}" : "") + "\n\\]\n");
  if (!constrained) return;
  const bool holonomic =
      std::any_of(a.one.constraints.begin(), a.one.constraints.end(), [](const auto& c) { return c.holonomic; });
  const bool velocities =
      std::any_of(a.one.constraints.begin(), a.one.constraints.end(), [](const auto& c) { return !c.holonomic; });
  std::string text = "Here $f_{kq}$ is ";
  if (holonomic)
    text += "$\\partial\\" + std::string(letters.psi == "psi" ? "psi" : "Psi") +
            "_k/\\partial q$ of a holonomic constraint";
  if (velocities)
    text += std::string(holonomic ? ", and " : "") + "the factor of $\\dot{q}$ in a constraint on velocities";
  a.out.paragraph(text + ".");
}

void write_partial_derivatives(Article& a, const DisplayForm& form, std::vector<PartialDerivatives>& first) {
  if (form.is_unexpanded) {
    a.out.paragraph("The partial derivatives are too large to be written out (" +
                    escape_user_text(form.unexpanded_reason) + ").");
    return;
  }
  const bool two = form.approach == system::Approach::two;
  const Letters letters(a.model, two);
  std::vector<std::string> unchanged;
  std::vector<PartialDerivatives> all = reading::partial_derivatives(a.m, form);
  if (two) {
    const auto as_before = [&](const PartialDerivatives& p) {
      return std::any_of(first.begin(), first.end(), [&](const PartialDerivatives& f) { return equal(f, p); });
    };
    for (const PartialDerivatives& p : all) {
      if (as_before(p)) unchanged.push_back(a.coordinate_math(p.coordinate));
    }
    std::erase_if(all, as_before);
  } else {
    first = all;
  }
  a.out.paragraph(two ? all.empty() ? "The derivatives are those of Approach I."
                                    : "Of the energies with constraints built in:"
                      : "Of the energies above:");
  if (!unchanged.empty() && !all.empty())
    a.out.paragraph("Those by " + enumeration(unchanged) + " are as before. The others are");
  for (const PartialDerivatives& p : all) {
    if (!p.left_out.empty()) {
      a.left_out.push_back(
          {std::string("partial derivatives by ") + a.model.coordinates[p.coordinate].name, p.left_out});
      continue;
    }
    std::vector<Formula> shown;
    const auto partial = [&](const std::string& letter, std::uint8_t order) {
      return reading::make_formula(FormulaKind::partial, {mark(letter), coordinate(p.coordinate, order)});
    };
    const auto add = [&](std::vector<Formula> formulas) {  // on one line if they fit
      for (Formula& f : formulas) f = a.with_letters(std::move(f));
      Formula together = reading::make_formula(FormulaKind::list, formulas);
      if (formulas.size() > 1 && a.out.fits_on_a_line(together))
        shown.push_back(std::move(together));
      else
        shown.insert(shown.end(), formulas.begin(), formulas.end());
    };
    std::vector<Formula> momentum{reading::relation({partial(letters.T, 1), arrange(p.momentum)})};
    if (!p.rate.is_zero())
      momentum.push_back(reading::relation(
          {reading::make_formula(FormulaKind::rate, {partial(letters.T, 1)}), arrange(p.rate, Layout::terms)}));
    add(std::move(momentum));
    add({reading::relation({partial(letters.T, 0), arrange(p.kinetic)}),
         reading::relation({partial(letters.U, 0), arrange(with_brackets(p.potential, form.powers))}),
         reading::relation(
             {mark("Q", {coordinate(p.coordinate, 0)}), arrange(with_brackets(p.force, form.powers), Layout::terms)})});
    std::string why;
    for (const Formula& f : shown) why = why.empty() ? a.out.reason_too_long(f) : why;
    if (why.empty())
      a.out.display(shown);
    else
      a.left_out.push_back(
          {std::string("partial derivatives by ") + a.model.coordinates[p.coordinate].name, "one of them " + why});
  }
}

}  // namespace eomgen::print
