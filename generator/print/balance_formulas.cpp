// SPDX-License-Identifier: GPL-3.0-or-later
// The balance laws of a body in components of its angular velocity, as formulas.
#include "print/formulas.hpp"
#include "print/render.hpp"
#include "reading/balance_form.hpp"

namespace eomgen::print {
namespace {

using reading::BalanceForm;

/// Longer solutions are left to the equations above, which determine them.
constexpr std::size_t most_solved_terms = 6;

class BalanceStatements {
 public:
  BalanceStatements(const Mechanics& m, const BalanceForm& form, std::vector<Statement>& out)
      : m_(m), form_(form), out_(out) {}

  void add() {
    for (const Sum& c : form_.constraints) show("constraints on v and omega", equals_zero(c));
    if (form_.constraint_force) {
      std::vector<Formula> fixed;
      for (std::uint32_t k = 0; k < 3; ++k) fixed.push_back(mark("E", {index(k + 1)}));
      show("constraint force, from F = m dv/dt",
           reading::relation({mark("bold F"), combination(*form_.constraint_force, fixed)}));
    }
    for (const Sum& left : form_.moments) show("M = dH/dt without constraint forces", equals_zero(left));
    for (std::uint32_t k = 0; k < form_.rates.size(); ++k) {
      if (form_.rates[k] && form_.rates[k]->size() <= most_solved_terms)
        show("solved",
             reading::relation({reading::symbol(reading::omega_symbol(k, 1)), reading::arrange(*form_.rates[k])}));
    }
    for (std::size_t j = 0; j < form_.accelerations.size(); ++j) {
      if (form_.accelerations[j] && form_.accelerations[j]->size() <= most_solved_terms)
        show("solved",
             reading::relation({coordinate(form_.position[j], 2), reading::arrange(*form_.accelerations[j])}));
    }
    if (form_.has_cosines) cosines();
  }

 private:
  /// Terms with rates of omega on the left, the others on the right.
  Formula equals_zero(const Sum& sum) const {
    Sum left, right;
    for (const auto& [monomial, coefficient] : sum.terms()) {
      bool rate = false;
      for (const reading::Factor& factor : monomial) {
        for (std::uint32_t k = 0; k < 3; ++k) {
          const bool is_rate =
              factor.atom->op == reading::Op::symbol &&
              (factor.atom->symbol == reading::omega_symbol(k, 1) ||
               factor.atom->symbol == reading::Symbol{reading::SymbolKind::coordinate, form_.position[k], 1});
          rate = rate || is_rate;
        }
      }
      if (rate)
        left.add(monomial, coefficient);
      else
        right.add(monomial, -coefficient);
    }
    if (left.is_zero()) return reading::relation({reading::arrange(sum, Layout::terms), reading::number(0)});
    if (reading::has_negative_leading_term(left)) {
      left = -left;
      right = -right;
    }
    return reading::relation({reading::arrange(left, Layout::terms), reading::arrange(right, Layout::terms)});
  }

  void cosines() {
    for (std::uint32_t i = 0; i < 3; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Formula symbol = reading::symbol(reading::cosine_symbol(i, k));
        if (!uses(reading::cosine_symbol(i, k))) continue;
        show("where", reading::relation({symbol, dot_product(mark("E", {index(i + 1)}), mark("e", {index(k + 1)}))}));
      }
    }
  }
  bool uses(const reading::Symbol& symbol) const {
    const auto has = [&](const Sum& sum) { return reading::contains(sum, symbol); };
    for (const Sum& sum : form_.constraints)
      if (has(sum)) return true;
    for (const Sum& sum : form_.moments)
      if (has(sum)) return true;
    return false;
  }

  void show(const char* role, Formula formula) {
    out_.push_back({"balance", m_.body_rotations[0].name, "", role, std::move(formula)});
  }

  const Mechanics& m_;
  const BalanceForm& form_;
  std::vector<Statement>& out_;
};

}  // namespace

void add_balance(const Mechanics& m, std::vector<Statement>& out) {
  const BalanceForm form = reading::balance_form(m);
  if (!form.skip_reason.empty()) return out.push_back(left_out("balance", "", "", form.skip_reason));
  BalanceStatements(m, form, out).add();
}

}  // namespace eomgen::print
