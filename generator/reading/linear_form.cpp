// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/linear_form.hpp"

#include <stdexcept>

#include "error.hpp"
#include "reading/approaches.hpp"
#include "reading/forms.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"
#include "reading/zero_test.hpp"

namespace eomgen::reading {
namespace {

std::string obstacle(const Mechanics& m, const DisplayForm& form) {
  if (form.is_unexpanded) return form.unexpanded_reason;
  if (!m.model->states.empty())
    return "there are states of first order beside the coordinates: eomgen linearize gives A and B at a state";
  if (!m.contacts.empty())
    return "contacts have modes, each with slopes of its own: eomgen linearize gives A and B at a state";
  for (const Equation& equation : form.equations) {
    if (!equation.multipliers.empty()) return "constraints keep multipliers: eomgen linearize gives A and B at a state";
  }
  return "";
}

class Linearisation {
 public:
  Linearisation(GinacBridge& bridge, LinearForm& form, const std::vector<Sum>& residuals)
      : bridge_(bridge), form_(form), r_(residuals) {
    for (const std::uint32_t q : form.coordinates) {
      for (const std::uint8_t order : {std::uint8_t{1}, std::uint8_t{2}}) rest_[coordinate_symbol(q, order)] = Sum();
    }
  }

  void run() {
    for (const Sum& r : r_) {
      const Sum rest = at_rest(r);
      form_.rest_residuals.push_back(rest);
      for (const std::uint32_t q : form_.coordinates) {
        add(slope(r, coordinate_symbol(q, 2)), form_.along_motion.mass, form_.at_rest.mass);
        add(slope(r, coordinate_symbol(q, 1)), form_.along_motion.damping, form_.at_rest.damping);
        add(slope(r, coordinate_symbol(q, 0)), form_.along_motion.stiffness, form_.at_rest.stiffness);
      }
      for (const std::uint32_t u : form_.inputs)
        add(-slope(r, {SymbolKind::input, u, 0}), form_.along_motion.input, form_.at_rest.input);
    }
  }

 private:
  Sum slope(const Sum& r, const Symbol& by) { return simplify(cancel(bridge_.derivative(r, by))); }
  Sum at_rest(const Sum& sum) { return simplify(cancel(bridge_.substitute(sum, rest_))); }
  void add(const Sum& slope, std::vector<Sum>& along, std::vector<Sum>& rest) {
    along.push_back(slope);
    rest.push_back(at_rest(slope));
  }

  GinacBridge& bridge_;
  LinearForm& form_;
  const std::vector<Sum>& r_;
  std::map<Symbol, Sum> rest_;
};

}  // namespace

namespace {

/// Entries that are equal get one form, so that symmetric matrices look symmetric.
void share_symmetric_entries(std::vector<Sum>& matrix, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i + 1; k < n; ++k) {
      Sum &a = matrix[i * n + k], &b = matrix[k * n + i];
      if (!(a == b) && is_zero(a - b)) (a.size() <= b.size() ? b : a) = a.size() <= b.size() ? a : b;
    }
  }
}

}  // namespace

LinearEquations linear_equations(const Mechanics& m, const LinearForm& form, const std::map<Symbol, Sum>& at) try {
  LinearEquations result;
  result.skip_reason = form.skip_reason;
  if (!form.skip_reason.empty()) return result;
  result.coordinates = form.coordinates;
  std::map<Symbol, Sum> values = at;
  for (const std::uint32_t q : form.coordinates) {
    const auto [value, added] = values.try_emplace(coordinate_symbol(q, 0), Sum());
    if (!added && !value->second.is_zero()) result.equilibrium.emplace_back(q, value->second);
  }
  try {
    const work::Budget budget(form_budget);
    GinacBridge bridge(m);
    const auto there = [&](const Sum& sum) { return simplify(cancel(bridge.substitute(sum, values))); };
    const std::size_t n = form.coordinates.size(), inputs = form.inputs.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_zero(there(form.rest_residuals[i]))) {
        throw Error("derive", {},
                    "the start is no equilibrium of these formulas: the equation of '" +
                        m.model->coordinates[form.coordinates[i]].name + "' does not hold there at rest",
                    "write the equilibrium by parameters, such as x = \"m*g/k\", in place of numbers");
      }
      Sum left, right;
      for (std::size_t k = 0; k < n; ++k) {
        const std::vector<Sum>* const entries[] = {&form.at_rest.stiffness, &form.at_rest.damping, &form.at_rest.mass};
        for (std::uint8_t order = 0; order < 3; ++order)
          left +=
              there((*entries[order])[i * n + k]) * bridge.atom_table()(coordinate_symbol(form.coordinates[k], order));
      }
      for (std::size_t j = 0; j < inputs; ++j)
        right +=
            there(form.at_rest.input[i * inputs + j]) * bridge.atom_table()({SymbolKind::input, form.inputs[j], 0});
      result.left.push_back(std::move(left));
      result.right.push_back(std::move(right));
    }
  } catch (const work::BudgetExceeded& over) {
    result = {};
    result.skip_reason = over.what();
  }
  return result;
} catch (const std::domain_error&) {
  LinearEquations result;
  result.skip_reason = "the equations have no slope at rest there";
  return result;
}

LinearForm linear_form(const Mechanics& mechanics, const DisplayForm& read) {
  LinearForm form;
  form.skip_reason = obstacle(mechanics, read);
  if (!form.skip_reason.empty()) return form;
  std::vector<Sum> residuals;
  for (const Equation& equation : read.equations) {
    if (!equation.of_motion) continue;
    form.coordinates.push_back(equation.coordinate);
    residuals.push_back(equation.expanded - equation.force);
  }
  for (std::uint32_t u = 0; u < mechanics.model->inputs.size(); ++u) form.inputs.push_back(u);
  try {
    const work::Budget budget(form_budget);
    GinacBridge bridge(mechanics);
    Linearisation(bridge, form, residuals).run();
    const std::size_t n = form.coordinates.size();
    for (LinearCoefficients* coefficients : {&form.along_motion, &form.at_rest}) {
      share_symmetric_entries(coefficients->mass, n);
      share_symmetric_entries(coefficients->damping, n);
      share_symmetric_entries(coefficients->stiffness, n);
    }
  } catch (const std::domain_error&) {
    form = {};
    form.skip_reason = "the equations have no slope at rest";
  } catch (const work::BudgetExceeded& over) {
    form = {};
    form.skip_reason = over.what();
  }
  return form;
}

}  // namespace eomgen::reading
