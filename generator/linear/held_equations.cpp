// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/held_equations.hpp"

#include <algorithm>
#include <map>

#include "symbolic/calculus.hpp"

namespace eomgen::linear {
namespace {

using symbolic::Dag;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

class Builder {
 public:
  Builder(mechanics::Mechanics& m, const system::EquationSystem& s, const std::vector<HeldMode>& modes)
      : m_(m), s_(s), dag_(*s.dag), modes_(modes) {
    for (const std::uint32_t i : s.free) unknowns_.push_back({SymbolKind::coordinate, i, 2});
    for (const std::uint32_t k : s.active) add_force({SymbolKind::multiplier, k, 0});
    for (std::size_t j = 0; j < m.contacts.size(); ++j) {
      const mechanics::Contact& contact = m.contacts[j];
      if (!s.contacts_with_inputs.empty() && !contact.constraints.empty())
        add_force({SymbolKind::multiplier, contact.constraints[0], 0});
      for (std::uint32_t a = 0; a < contact.dimensions(); ++a) add_force({SymbolKind::friction, contact.first + a, 0});
    }
  }

  HeldEquations build() {
    add_motion();
    for (std::size_t j = 0; j < s_.contacts.size(); ++j) add(j, s_.contacts[j]);
    for (std::size_t j = 0; j < s_.contacts_with_inputs.size(); ++j) add(j, s_.contacts_with_inputs[j]);
    return std::move(result_);
  }

 private:
  void add_force(const Symbol& symbol) {
    unknowns_.push_back(symbol);
    result_.forces.push_back(symbol);
  }

  Ref acceleration(std::size_t i) { return dag_.symbol({SymbolKind::coordinate, s_.free[i], 2}); }
  Ref times(const std::vector<Ref>& row, std::size_t from) {
    Ref sum = dag_.zero();
    for (std::size_t i = 0; i < s_.free.size(); ++i) sum = dag_.add(sum, dag_.mul(row[from + i], acceleration(i)));
    return sum;
  }

  void add_motion() {
    const std::size_t n = s_.free.size();
    for (std::size_t i = 0; i < n; ++i) {
      Ref balance = dag_.sub(times(s_.M, i * n), s_.f[i]);
      for (std::size_t k = 0; k < s_.active.size(); ++k)
        balance = dag_.sub(balance, dag_.mul(s_.A[k * n + i], dag_.symbol({SymbolKind::multiplier, s_.active[k], 0})));
      add_row(balance);
    }
    for (std::size_t k = 0; k < s_.active.size(); ++k) add_row(dag_.add(times(s_.A, k * n), s_.gamma[k]));
  }

  /// A row that vanishes, linear in the unknowns.
  void add_row(Ref row) { result_.constant.push_back(split(row, result_.matrix)); }
  /// Appends the slopes by the unknowns to `slopes`. Returns the value where the unknowns are 0.
  Ref split(Ref row, std::vector<Ref>& slopes) {
    std::map<Symbol, Ref> none;
    for (const Symbol& y : unknowns_) {
      slopes.push_back(symbolic::partial_derivative(dag_, y)(row));
      none[y] = dag_.zero();
    }
    return symbolic::Substitution(dag_, none)(row);
  }

  HeldContact begin(std::size_t j, bool unilateral) {
    const mechanics::Contact& contact = m_.contacts[j];
    HeldContact held;
    held.name = contact.name;
    held.held = modes_.at(j);
    held.unilateral = unilateral;
    held.rolls = contact.rolls;
    held.smooth = contact.width.has_value();
    held.normal = dag_.zero();
    for (std::uint32_t a = 0; a < contact.dimensions(); ++a)
      held.friction.push_back(dag_.symbol({SymbolKind::friction, contact.first + a, 0}));
    return held;
  }

  void add(std::size_t j, const system::Contact& c) {
    HeldContact held = begin(j, c.unilateral.has_value());
    held.slip = c.slip;
    if (c.can_stick()) held.static_coefficient = c.static_coefficient;
    if (c.reactions.size() == 1) {
      const Ref scale = c.gram.empty() ? dag_.one() : dag_.call(symbolic::Op::sqrt, c.gram[0]);
      held.normal = signed_by(held.held.normal_sign, dag_.mul(scale, s_.reactions[c.reactions[0]].value));
    } else if (c.reactions.empty()) {
      held.normal = dag_.call(symbolic::Op::abs, c.normal);
    } else {
      held.normal = length(c);
      if (!held.sticks()) return add_friction(held, c.slip_rate, c.dynamic_coefficient, c.width, tangent_of_length(c));
    }
    const Ref normal = held.normal;
    add_friction(held, c.slip_rate, c.dynamic_coefficient, c.width, normal);
  }

  void add(std::size_t j, const system::ContactWithInputs& c) {
    HeldContact held = begin(j, c.unilateral);
    for (const system::ContactRow& row : c.slip) held.slip.push_back(row.rate);
    if (!c.slip.empty() && !c.width) held.static_coefficient = c.static_coefficient;
    if (c.normal) {
      const Ref lambda = dag_.symbol({SymbolKind::multiplier, m_.contacts[j].constraints[0], 0});
      held.normal = signed_by(held.held.normal_sign, dag_.mul(c.normal_scale, lambda));
      add_row(dag_.add(times(c.normal->slopes, 0), c.normal->bias));
      result_.gaps.push_back(c.gap);
      result_.gap_rates.push_back(c.normal->rate);
    } else {
      held.normal = dag_.call(symbolic::Op::abs, c.given_normal);
    }
    std::vector<Ref> rates;
    for (const system::ContactRow& row : c.slip) rates.push_back(dag_.add(times(row.slopes, 0), row.bias));
    const Ref normal = held.normal;
    add_friction(held, rates, c.dynamic_coefficient, c.width, normal);
  }

  /// `normal`: the normal force, linear in the unknowns.
  void add_friction(HeldContact& held, const std::vector<Ref>& slip_rates, Ref coefficient,
                    const std::optional<Ref>& width, Ref normal) {
    for (std::size_t a = 0; a < held.slip.size(); ++a) {
      if (held.sticks()) {
        add_row(slip_rates[a]);
        result_.slips.push_back(held.slip[a]);
      } else {
        const Ref drag = dag_.mul(coefficient, direction(held, a, width));
        add_row(dag_.add(held.friction[a], dag_.mul(drag, normal)));
      }
    }
    result_.contacts.push_back(std::move(held));
  }

  /// Component a of the direction of slip, times the share of the Coulomb force that the law gives.
  Ref direction(const HeldContact& held, std::size_t a, const std::optional<Ref>& width) {
    if (!width && held.slip.size() == 1) return dag_.integer(held.held.mode);
    Ref squares = width ? dag_.mul(*width, *width) : dag_.zero();
    for (const Ref w : held.slip) squares = dag_.add(squares, dag_.mul(w, w));
    return dag_.div(held.slip[a], dag_.call(symbolic::Op::sqrt, squares));
  }

  /// (lambda^T gram lambda)^(1/2) of a curve.
  Ref length(const system::Contact& c) {
    Ref square = dag_.zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const Ref product = dag_.mul(s_.reactions[c.reactions[k / 2]].value, s_.reactions[c.reactions[k % 2]].value);
      square = dag_.add(square, dag_.mul(c.gram[k], product));
    }
    return dag_.call(symbolic::Op::sqrt, square);
  }

  /// As in HeldCurve.
  Ref tangent_of_length(const system::Contact& c) {
    HeldCurve curve{c.name, {}, {}, {}, {}};
    const auto first = static_cast<std::uint32_t>(3 * result_.curves.size());
    for (std::uint32_t k = 0; k < 3; ++k) curve.tangent[k] = {SymbolKind::auxiliary, first + k, 0};
    std::copy_n(c.gram.begin(), 4, curve.gram.begin());
    Ref linear = dag_.zero(), square = dag_.integer(-1);
    for (std::size_t k = 0; k < 2; ++k) {
      const Ref reaction = s_.reactions[c.reactions[k]].value, u = dag_.symbol(curve.tangent[k]);
      curve.constant[k] = split(reaction, curve.slopes[k]);
      for (std::size_t l = 0; l < 2; ++l) {
        const Ref other = dag_.mul(c.gram[2 * l + k], dag_.symbol(curve.tangent[l]));
        linear = dag_.add(linear, dag_.mul(other, reaction));
        square = dag_.add(square, dag_.mul(other, u));
      }
    }
    const Ref half = dag_.div(dag_.symbol(curve.tangent[2]), dag_.integer(2));
    result_.curves.push_back(std::move(curve));
    return dag_.sub(linear, dag_.mul(half, square));
  }

  Ref signed_by(int sign, Ref value) { return sign < 0 ? dag_.neg(value) : value; }

  mechanics::Mechanics& m_;
  const system::EquationSystem& s_;
  Dag& dag_;
  const std::vector<HeldMode>& modes_;
  std::vector<Symbol> unknowns_;
  HeldEquations result_;
};

}  // namespace

HeldEquations held_equations(mechanics::Mechanics& m, const system::EquationSystem& s,
                             const std::vector<HeldMode>& modes) {
  return Builder(m, s, modes).build();
}

}  // namespace eomgen::linear
