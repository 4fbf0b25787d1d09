// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts as formulas: directions of sliding, slip, normal force, the law in every mode, eqs. (2.33), (2.40), (2.47).

#include "mechanics/imposition.hpp"
#include "print/formulas.hpp"
#include "print/letters.hpp"

namespace eomgen::print {
namespace {

using mechanics::Contact;

Formula call(symbolic::Op op, Formula of) {
  Formula result = reading::make_formula(FormulaKind::call, {std::move(of)});
  result.op = op;
  return result;
}
Formula square(Formula f) { return reading::make_formula(FormulaKind::power, {std::move(f), reading::number(2)}); }

class ContactFormulas {
 public:
  ContactFormulas(const Mechanics& m, const Contact& contact, std::size_t index, std::vector<Statement>& out)
      : m_(m),
        dag_(*m.dag),
        contact_(contact),
        index_(index),
        imposed_(mechanics::constraint_substitution(m)),
        out_(out) {
    slip_ = free_letter(*m_.model, "w", "varpi");
    normal_ = call(symbolic::Op::abs, mark(free_letter(*m_.model, "N", "cal N"), subscript({})));
  }

  void add() {
    if (contact_.dimensions() > 0) {
      directions();
      for (std::size_t a = 0; a < contact_.dimensions(); ++a) show("slip", {slip(a), read(contact_.slip[a])});
      show("normal force", {normal_, normal_force()});
      laws();
    }
    if (!contact_.unilateral) return;
    const std::uint32_t k = contact_.constraints[0];
    show("is closed while", {multiplier(k), reading::number(0)}, true);
    show("is open", {multiplier(k), reading::number(0)});
    show("is open while", {read(m_.constraints[k].psi), reading::number(0)}, true);
    const auto rate = [&](const char* when) {
      Formula result = reading::make_formula(FormulaKind::dot,
                                             {mark(free_letter(*m_.model, "psi", "Psi"), subscript({}), {mark(when)})});
      result.order = 1;
      return result;
    };
    const Formula e = read(contact_.restitution);
    show("impact", {rate("+"), reading::is_zero(e) ? e : reading::negative(reading::product({e, rate("-")}))});
  }

 private:
  /// Subscript: the number of the contact if there are several, then the given indices.
  std::vector<Formula> subscript(std::vector<Formula> more) const {
    if (m_.contacts.size() > 1) more.insert(more.begin(), reading::number(static_cast<long>(index_ + 1)));
    return more;
  }
  std::vector<Formula> number_of(std::size_t a) const {
    return subscript(contact_.dimensions() > 1 ? std::vector<Formula>{reading::number(static_cast<long>(a + 1))}
                                               : std::vector<Formula>{});
  }
  Formula slip(std::size_t a) const { return mark(slip_, number_of(a)); }
  Formula friction(std::size_t a) const {
    return reading::symbol({SymbolKind::friction, contact_.first + static_cast<std::uint32_t>(a), 0});
  }
  Formula multiplier(std::uint32_t k) const { return reading::symbol({SymbolKind::multiplier, k, 0}); }

  /// |f| of one component, or the root of the sum of squares of two; `more`: further terms under the root.
  template <class Component>
  Formula length(Component&& component, const std::optional<Formula>& more = {}) const {
    if (contact_.dimensions() == 1 && !more) return call(symbolic::Op::abs, component(0));
    std::vector<Formula> terms;
    for (std::size_t a = 0; a < contact_.dimensions(); ++a) terms.push_back(square(component(a)));
    if (more) terms.push_back(square(*more));
    return call(symbolic::Op::sqrt, reading::sum(std::move(terms)));
  }

  Formula read(Ref expression) {
    try {
      return reading::arrange(reading::display_sum(m_, imposed_(expression)));
    } catch (const work::BudgetExceeded&) {
      return mark("...");
    }
  }

  void show(const char* role, std::vector<Formula> sides, bool at_least = false) {
    Formula formula = reading::relation(std::move(sides));
    if (at_least) formula.word = reading::at_least;
    out_.push_back({"friction", contact_.name, "", role, std::move(formula)});
  }

  void directions() {
    std::vector<Formula> fixed;
    for (int k = 1; k <= 3; ++k) fixed.push_back(mark("E", {reading::number(k)}));
    for (std::size_t a = 0; a < contact_.directions.size(); ++a) {
      try {
        reading::Components t;
        for (std::size_t k = 0; k < 3; ++k) t[k] = reading::display_sum(m_, imposed_(contact_.directions[a][k]));
        std::vector<Formula> index = number_of(a);
        index.insert(index.begin(), mark("t"));
        show("direction", {mark("e", std::move(index)), combination(t, fixed)});
      } catch (const work::BudgetExceeded& over) {
        out_.push_back(left_out("friction", contact_.name, "direction", over.what()));
      }
    }
  }

  // |lambda grad psi|; for a curve |lambda_1 grad psi_1 + lambda_2 grad psi_2|.
  Formula normal_force() {
    if (contact_.constraints.empty()) return call(symbolic::Op::abs, read(contact_.normal));
    const std::size_t n = contact_.constraints.size();
    const auto lambda = [&](std::size_t k) {
      return dag_.symbol({SymbolKind::multiplier, contact_.constraints[k], 0});
    };
    Ref sum = dag_.zero();
    for (std::size_t k = 0; k < n * n; ++k) {
      sum = dag_.add(sum, dag_.mul(contact_.gram[k], dag_.mul(lambda(k / n), lambda(k % n))));
    }
    return read(dag_.call(symbolic::Op::sqrt, sum));
  }

  void laws() {
    const auto w = [&](std::size_t a) { return slip(a); };
    const auto F = [&](std::size_t a) { return friction(a); };
    const Formula mu = read(contact_.dynamic_coefficient);
    const bool is_smooth = contact_.width && !dag_.is_zero(*contact_.width);
    const std::optional<Formula> width = is_smooth ? std::optional(read(*contact_.width)) : std::nullopt;
    for (std::size_t a = 0; a < contact_.dimensions(); ++a) {
      const Formula drag = reading::fraction(reading::product({mu, normal_, slip(a)}), length(w, width));
      show(width ? "smooth law" : "slides", {friction(a), reading::negative(drag)});
    }
    if (contact_.width) return;
    for (std::size_t a = 0; a < contact_.dimensions(); ++a) show("sticks", {slip(a), reading::number(0)});
    show("sticks while", {reading::product({read(contact_.static_coefficient), normal_}), length(F)}, true);
  }

  const Mechanics& m_;
  symbolic::Dag& dag_;
  const Contact& contact_;
  std::size_t index_;
  symbolic::Substitution imposed_;
  std::vector<Statement>& out_;
  std::string slip_;
  Formula normal_;
};

}  // namespace

void add_contacts(const Mechanics& m, std::vector<Statement>& out) {
  for (std::size_t j = 0; j < m.contacts.size(); ++j) ContactFormulas(m, m.contacts[j], j, out).add();
}

}  // namespace eomgen::print
