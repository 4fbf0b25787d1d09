// SPDX-License-Identifier: GPL-3.0-or-later
// Routh's reduction as formulas.
#include "print/formulas.hpp"
#include "print/named_lengths.hpp"
#include "print/render.hpp"
#include "reading/routh.hpp"

namespace eomgen::print {

using reading::RouthForm;

std::vector<PrintedFormula> render_routh(const mechanics::Mechanics& m, const RouthForm& form, LengthLetters* letters) {
  std::vector<Statement> out;
  const auto add = [&](std::string name, std::string coordinate, std::string role, Formula formula) {
    out.push_back({"routh", std::move(name), std::move(coordinate), std::move(role), std::move(formula)});
  };
  if (!form.is_unexpanded && !form.cyclic.empty()) {
    for (std::size_t i = 0; i < form.cyclic.size(); ++i) {
      const std::uint32_t c = form.cyclic[i];
      const std::string& name = m.model->coordinates[c].name;
      const Formula p = reading::symbol(reading::momentum_symbol(c));
      add("momentum." + name, name, "constant momentum", reading::relation({p, arrange(form.momenta[i])}));
      add(name + "_dot", name, "rate that it gives",
          reading::relation(
              {reading::symbol({symbolic::SymbolKind::coordinate, c, 1}), reading::arrange_fractions(form.rates[i])}));
    }
    add("Routhian", "", "Routhian",
        reading::relation(
            {reading::mark("cal R"), reading::arrange_fractions(-with_powers(-form.routhian, form.powers))}));
    for (const reading::Equation& equation : form.equations) {
      const std::string& name = m.model->coordinates[equation.coordinate].name;
      add("", name, "reduced motion", momentum_form(equation, form.powers, true));
      add("", name, "reduced motion", explicit_form(equation, form.powers, true));
    }
    if (form.energy)
      add("energy", "", "energy of the reduced motion",
          reading::arrange_fractions(with_powers(*form.energy, form.powers)));
  }
  name_lengths(m, out, letters);
  return render(m, out);
}

}  // namespace eomgen::print
