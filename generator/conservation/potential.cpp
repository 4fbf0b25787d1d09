// SPDX-License-Identifier: GPL-3.0-or-later
#include "conservation/potential.hpp"

#include <algorithm>
#include <cmath>

#include "conservation/conserved.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/antiderivative.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/polynomial.hpp"
#include "symbolic/sample.hpp"
#include "symbolic/zero_proof.hpp"

namespace eomgen::conservation {
namespace {

using symbolic::Op;

Symbol coordinate_symbol(std::size_t i) { return {SymbolKind::coordinate, static_cast<std::uint32_t>(i), 0}; }

class PotentialSearch {
 public:
  PotentialSearch(mechanics::Mechanics& m, const std::vector<Ref>& Q) : m_(m), dag_(*m.dag), Q_(Q) {
    for (std::size_t i = 0; i < Q.size(); ++i) {
      if (std::any_of(Q.begin(), Q.end(), [&](Ref q) { return symbolic::depends_on(dag_, q, coordinate_symbol(i)); }) ||
          !dag_.is_zero(Q[i])) {
        active_.push_back(i);
      }
    }
  }

  std::optional<Ref> run() {
    if (active_.size() > most_coordinates) return std::nullopt;
    std::vector<std::size_t> order = active_;
    for (std::size_t turn = 0; turn < active_.size(); ++turn) {
      for (int direction = 0; direction < 2; ++direction) {
        if (const std::optional<Ref> U = along_coordinates(order)) return U;
        std::reverse(order.begin(), order.end());
      }
      std::rotate(order.begin(), order.begin() + 1, order.end());
    }
    return homogeneous();
  }

 private:
  static constexpr std::size_t most_coordinates = 6;  // more coordinates have too many orders and expressions

  Ref slope(Ref f, std::size_t i) { return symbolic::partial_derivative(dag_, coordinate_symbol(i))(f); }

  bool is_potential(Ref U) {
    for (const std::size_t i : active_) {
      if (!symbolic::is_proven_zero(dag_, dag_.add(slope(U, i), Q_[i]))) return false;
    }
    return true;
  }

  std::optional<Ref> along_coordinates(const std::vector<std::size_t>& order) {
    Ref U = dag_.zero();
    for (std::size_t step = 0; step < order.size(); ++step) {
      std::optional<Ref> rest =
          symbolic::expand_or_keep(dag_, dag_.neg(dag_.add(Q_[order[step]], slope(U, order[step]))));
      if (mechanics::vanishes(dag_, {*rest})) continue;
      for (std::size_t before = 0; before < step && rest; ++before)
        rest = symbolic::eliminate_symbol(dag_, *rest, coordinate_symbol(order[before]));
      if (rest) rest = symbolic::antiderivative(dag_, *rest, coordinate_symbol(order[step]));
      if (!rest) return std::nullopt;
      U = dag_.add(U, *rest);
    }
    if (!is_potential(U)) return std::nullopt;
    return U;
  }

  // Q(s q) = s^k Q(q) with k != -1: U = -q . Q/(k + 1).
  std::optional<Ref> homogeneous() {
    Ref scaled = dag_.zero(), sum = dag_.zero(), moment = dag_.zero();  // of all Q_i, so that one number gives k
    for (const std::size_t i : active_) {
      sum = dag_.add(sum, Q_[i]);
      moment = dag_.add(moment, dag_.mul(m_.q[i], Q_[i]));
    }
    for (const std::size_t j : active_) scaled = dag_.add(scaled, dag_.mul(m_.q[j], slope(sum, j)));
    const std::vector<double> value =
        symbolic::evaluate(dag_, {scaled, sum}, [](const Symbol& s) { return symbolic::sample_double(s, 1); });
    const double doubled = std::round(2 * value[0] / value[1]);
    if (!std::isfinite(doubled) || std::abs(doubled) > 40 || doubled == -2) return std::nullopt;
    const Ref k_plus_1 = dag_.constant(symbolic::Rational(static_cast<long>(doubled) + 2) / 2);
    const Ref U = dag_.neg(dag_.div(moment, k_plus_1));
    if (!is_potential(U)) return std::nullopt;
    return symbolic::expand_or_keep(dag_, U);
  }

  mechanics::Mechanics& m_;
  Dag& dag_;
  const std::vector<Ref>& Q_;
  std::vector<std::size_t> active_;  // coordinates that Q works on or depends on
};

bool depends_on_place(const Dag& dag, Ref r) {
  const std::vector<Symbol> symbols = dag.symbols({r});
  return std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind == SymbolKind::coordinate; });
}

// sqrt(x^2 + y^2) is 0 where x^2 + y^2 is; the simpler one is reported.
Ref zero_set(const Dag& dag, Ref r) {
  while (dag[r].op == Op::sqrt || dag[r].op == Op::power || dag[r].op == Op::neg) r = dag[r].args[0];
  return r;
}

}  // namespace

std::vector<DomainCondition> domain_of(mechanics::Mechanics& m, const std::vector<Ref>& expressions) {
  Dag& dag = *m.dag;
  std::vector<DomainCondition> result;
  const auto add = [&](Ref r, const char* relation) {
    if (!depends_on_place(dag, r) || dag.is_positive(r)) return;
    const auto same = [&](const DomainCondition& c) { return c.expression == r; };
    if (std::none_of(result.begin(), result.end(), same)) result.push_back({r, relation});
  };
  const auto factors = [&](Ref r) {
    for (const auto& [base, exponent] : symbolic::factors_of(dag, r)) add(zero_set(dag, base), "!= 0");
  };
  for (const Ref r : dag.reachable(expressions)) {
    const symbolic::Node node = dag[r];
    if (node.op == Op::div) factors(node.args[1]);
    if (node.op == Op::tan) add(dag.call(Op::cos, node.args[0]), "!= 0");
    if (node.op == Op::log || node.op == Op::pow) add(node.args[0], "> 0");
  }
  return result;
}

std::optional<Potential> find_potential(mechanics::Mechanics& m, const std::vector<Ref>& Q) {
  const std::optional<Ref> U = PotentialSearch(m, Q).run();
  if (!U) return std::nullopt;
  return Potential{*U, domain_of(m, {*U})};
}

}  // namespace eomgen::conservation
