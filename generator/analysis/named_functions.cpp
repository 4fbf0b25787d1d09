// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/named_functions.hpp"

#include "mechanics/dependent.hpp"

namespace eomgen::analysis {

std::optional<reading::Sum> in_named_functions(const mechanics::Mechanics& m, const reading::ReadingForm& form,
                                               const conservation::Conserved& conserved) {
  if (form.by_parts) return std::nullopt;
  if (conserved.name == "energy" && mechanics::impose_dependent(m).fixed.empty()) return form.kinetic + form.potential;
  for (const reading::Equation& equation : form.equations) {
    if (conserved.name == "momentum." + m.model->coordinates[equation.coordinate].name) return equation.momentum;
  }
  if (conserved.name == "jacobi" && form.by_degree) return (*form.by_degree)[0] - (*form.by_degree)[2] + form.potential;
  return std::nullopt;
}

}  // namespace eomgen::analysis
