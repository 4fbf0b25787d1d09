// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/definite_integral.hpp"

#include <algorithm>

#include "symbolic/antiderivative.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/time_terms.hpp"

namespace eomgen::symbolic {
namespace {

using Wave = TimeTerm::Wave;

// Each rule returns the integral of one term from `from` to t, without its factor.
class Rules {
 public:
  Rules(Dag& dag, Symbol time, Ref from) : dag_(dag), time_(time), t_(dag.symbol(time)), from_(from) {}

  std::optional<Ref> operator()(const TimeTerm& term) {
    if (term.base && (term.growth || term.wave != Wave::none)) return std::nullopt;  // not an elementary function
    if (term.base) return of_power(term);
    if (term.growth && term.wave != Wave::none) return between(of_both(term, term.n, term.wave));
    if (term.growth) return between(of_growth(term));
    if (term.wave != Wave::none) return between(of_wave(term));
    return between(dag_.div(dag_.power(t_, term.n + 1), dag_.integer(term.n + 1)));
  }

 private:
  Ref between(Ref antiderivative) {
    Substitution at_start(dag_, {{time_, from_}});
    return dag_.sub(antiderivative, at_start(antiderivative));
  }
  Ref at(const Linear& x, Ref t) { return dag_.add(dag_.mul(x.a, t), x.b); }

  // With u = a t + b: t^n u^p dt = (u - b)^n u^p du / a^(n+1), term by term.
  std::optional<Ref> of_power(const TimeTerm& term) {
    const Linear& x = *term.base;
    const Ref u = at(x, t_), u0 = at(x, from_);
    Ref sum = dag_.zero();
    Rational binomial = 1;
    for (long k = 0; k <= term.n; ++k) {  // (n over k) u^(n-k) (-b)^k
      const Rational exponent = term.exponent + Rational(term.n - k) + 1;
      Ref part;
      if (cln::zerop(exponent)) {
        part = dag_.call(Op::log, dag_.div(u, u0));
      } else {
        const Ref e = dag_.constant(exponent);
        part = dag_.div(dag_.sub(dag_.pow(u, e), dag_.pow(u0, e)), e);
      }
      const Ref scale = dag_.mul(dag_.constant(binomial), dag_.power(dag_.neg(x.b), k));
      sum = dag_.add(sum, dag_.mul(scale, part));
      binomial = binomial * Rational(term.n - k) / Rational(k + 1);
    }
    return dag_.div(sum, dag_.power(x.a, term.n + 1));
  }

  // exp(a t + b) sum_k (-1)^k n!/(n-k)! t^(n-k) / a^(k+1)
  Ref of_growth(const TimeTerm& term) {
    Ref sum = dag_.zero();
    Rational falling = 1;
    for (long k = 0; k <= term.n; ++k) {
      const Ref part =
          dag_.div(dag_.mul(dag_.constant(falling), dag_.power(t_, term.n - k)), dag_.power(term.growth->a, k + 1));
      sum = dag_.add(sum, part);
      falling = -falling * Rational(term.n - k);
    }
    return dag_.mul(dag_.call(Op::exp, at(*term.growth, t_)), sum);
  }

  // Repeated integration by parts: cos -> sin + cos - sin - cos ..., sin -> -cos + sin + cos - sin ...
  Ref of_wave(const TimeTerm& term) {
    const Ref x = at(term.phase, t_), s = dag_.call(Op::sin, x), c = dag_.call(Op::cos, x);
    Ref sum = dag_.zero();
    Rational falling = 1;
    for (long k = 0; k <= term.n; ++k) {
      const bool even = k % 2 == 0, is_cos = term.wave == Wave::cos;
      const long turn = k % 4;
      const bool minus = is_cos ? turn >= 2 : turn == 0 || turn == 3;
      const Ref value = even == is_cos ? s : c;
      const Ref scale = dag_.mul(dag_.constant(falling), dag_.power(t_, term.n - k));
      const Ref part = dag_.div(dag_.mul(scale, value), dag_.power(term.phase.a, k + 1));
      sum = minus ? dag_.sub(sum, part) : dag_.add(sum, part);
      falling = falling * Rational(term.n - k);
    }
    return sum;
  }

  // With C = e^x cos y, S = e^x sin y: the integral of C is (a C + w S)/(a^2 + w^2), that of S (a S - w C)/(a^2 + w^2).
  // Factors t^n are integrated by parts.
  Ref of_both(const TimeTerm& term, long n, Wave wave) {
    const Ref a = term.growth->a, w = term.phase.a;
    const Ref below = dag_.add(dag_.mul(a, a), dag_.mul(w, w));
    const auto combine = [&](Ref C, Ref S) {
      const Ref above =
          wave == Wave::cos ? dag_.add(dag_.mul(a, C), dag_.mul(w, S)) : dag_.sub(dag_.mul(a, S), dag_.mul(w, C));
      return dag_.div(above, below);
    };
    const Ref size = dag_.call(Op::exp, at(*term.growth, t_)), y = at(term.phase, t_);
    const Ref whole = combine(dag_.mul(size, dag_.call(Op::cos, y)), dag_.mul(size, dag_.call(Op::sin, y)));
    if (n == 0) return whole;
    const Ref rest = combine(of_both(term, n - 1, Wave::cos), of_both(term, n - 1, Wave::sin));
    return dag_.sub(dag_.mul(dag_.power(t_, n), whole), dag_.mul(dag_.integer(n), rest));
  }

  Dag& dag_;
  Symbol time_;
  Ref t_, from_;
};

/// F(t) - F(from) of a proven antiderivative, if F is continuous and defined wherever the integrand is.
std::optional<Ref> by_antiderivative(Dag& dag, Ref integrand, Symbol time, Ref from) {
  const std::vector<Ref> given = dag.reachable({integrand});
  const auto may_jump = [&](Ref r) { return is_kink(dag[r].op) || dag[r].op == Op::atan2; };
  if (std::any_of(given.begin(), given.end(), may_jump)) return std::nullopt;
  const std::optional<Ref> F = antiderivative(dag, integrand, time, LogarithmDomain::any_sign);
  if (!F) return std::nullopt;
  for (const Ref r : dag.reachable({*F})) {
    if (std::binary_search(given.begin(), given.end(), r)) continue;
    const Node node = dag[r];
    const bool square = dag[node.args[0]].op == Op::power && dag[node.args[0]].payload % 2 == 0;
    const bool is_defined =
        dag.is_positive(node.args[0]) || (square && node.op == Op::log);  // u^2 of a u below the line
    if ((node.op == Op::sqrt || node.op == Op::log || node.op == Op::pow) && !is_defined) return std::nullopt;
    if (node.op == Op::asin || node.op == Op::acos) return std::nullopt;
  }
  return dag.sub(*F, Substitution(dag, {{time, from}})(*F));
}

std::optional<Ref> by_rules(Dag& dag, Ref integrand, Symbol time, Ref from) {
  const auto terms = TimeTerms(dag, time)(integrand);
  if (!terms) return std::nullopt;
  Rules rules(dag, time, from);
  Ref sum = dag.zero();
  for (const TimeTerm& term : *terms) {
    const std::optional<Ref> part = rules(term);
    if (!part) return std::nullopt;
    sum = dag.add(sum, dag.mul(term.factor, *part));
  }
  return sum;
}

}  // namespace

std::optional<Ref> definite_integral(Dag& dag, Ref integrand, Symbol time, Ref from) {
  const std::optional<Ref> found = by_rules(dag, integrand, time, from);
  return found ? found : by_antiderivative(dag, integrand, time, from);
}

}  // namespace eomgen::symbolic
