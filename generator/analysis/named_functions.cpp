// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/named_functions.hpp"

#include "mechanics/dependent_coordinates.hpp"

namespace eomgen::analysis {

using system::OutputKind;

std::optional<reading::Sum> express_in_named_functions(const mechanics::Mechanics& m, const reading::DisplayForm& form,
                                                       const conservation::ConservedQuantity& conserved) {
  if (form.is_unexpanded) return std::nullopt;
  if (conserved.kind == OutputKind::energy && mechanics::eliminate_dependent_coordinates(m).fixed.empty())
    return form.kinetic + form.potential;
  for (const reading::Equation& equation : form.equations) {
    if (conserved.kind == OutputKind::momentum && conserved.index == equation.coordinate) return equation.momentum;
  }
  if (conserved.kind == OutputKind::jacobi && form.by_degree)
    return (*form.by_degree)[0] - (*form.by_degree)[2] + form.potential;
  return std::nullopt;
}

}  // namespace eomgen::analysis
