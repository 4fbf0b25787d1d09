// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/partials.hpp"

#include <stdexcept>

#include "reading/lagrangian.hpp"
#include "reading/no_value.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {

std::vector<PartialDerivatives> partial_derivatives(const mechanics::Mechanics& m, const DisplayForm& form) try {
  std::vector<PartialDerivatives> result;
  if (form.is_unexpanded) return result;
  GinacBridge bridge(m);
  for (const Equation& equation : form.equations) {
    PartialDerivatives p;
    p.coordinate = equation.coordinate;
    try {
      const work::Budget budget(item_budget);
      const Symbol q = coordinate_symbol(equation.coordinate, 0);
      p.momentum = bridge.derivative(form.kinetic, coordinate_symbol(equation.coordinate, 1));
      p.rate = simplify(bridge.total_derivative(p.momentum));
      p.kinetic = bridge.derivative(form.kinetic, q);
      p.potential = bridge.derivative(form.potential, q);
      p.force =
          form.approach == system::Approach::one ? generalized_force(m, bridge, equation.coordinate) : equation.force;
    } catch (const work::BudgetExceeded& over) {
      p = {};
      p.coordinate = equation.coordinate;
      p.left_out = over.what();
    }
    result.push_back(std::move(p));
  }
  return result;
} catch (const std::domain_error&) {
  throw no_value_error(m);
}

}  // namespace eomgen::reading
