// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/definite_integral.hpp"

#include <algorithm>
#include <vector>

#include "symbolic/antiderivative.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::symbolic {
namespace {

// Functions of time as sums of terms with known antiderivatives:
//   factor t^n (a t + b)^p exp(a t + b) {1, sin(a t + b), cos(a t + b)}.
// Sums, products and integer powers of such sums are again such sums (products of sines become sines of sums).

/// a t + b with a, b free of t; a is not 0.
struct Linear {
  Ref a, b;
  friend bool operator==(const Linear&, const Linear&) = default;
};

struct TimeTerm {
  enum class Wave { none, sin, cos };
  Ref factor;                  // free of t
  long n = 0;                  // t^n, n >= 0
  std::optional<Linear> base;  // (a t + b)^exponent
  Rational exponent = 0;
  std::optional<Linear> growth;  // exp(a t + b)
  Wave wave = Wave::none;
  Linear phase;  // of the wave
};

constexpr std::size_t most_terms = 100;
constexpr long highest_power = 12;  // of a sum that is multiplied out

class TimeTerms {
 public:
  /// `time` is the variable; everything else is constant.
  TimeTerms(Dag& dag, Symbol time) : dag_(dag), time_(time) {}

  /// The terms of an expression; nothing if it is not such a sum or has too many terms.
  std::optional<std::vector<TimeTerm>> operator()(Ref r) {
    if (is_time_independent(r)) return std::vector<TimeTerm>{constant(r)};
    Terms terms = of_node(r);
    if (terms && terms->size() > most_terms) return std::nullopt;
    return terms;
  }

  bool is_time_independent(Ref expression) const {  // of time
    const std::vector<Symbol> symbols = dag_.symbols({expression});
    return std::find(symbols.begin(), symbols.end(), time_) == symbols.end();
  }

 private:
  using Terms = std::optional<std::vector<TimeTerm>>;
  Terms of_node(Ref r) {
    const Node node = dag_[r];
    const Ref x = node.args[0], y = node.args[1];
    switch (node.op) {
      case Op::symbol: {
        TimeTerm term = constant(dag_.one());
        term.n = 1;
        return std::vector<TimeTerm>{term};
      }
      case Op::add: return sum(x, y, false);
      case Op::sub: return sum(x, y, true);
      case Op::neg: return sum(dag_.zero(), x, true);
      case Op::mul: return product((*this)(x), (*this)(y));
      case Op::div: return product((*this)(x), reciprocal(y));
      case Op::power: {
        if (node.payload > highest_power) return root(x, Rational(node.payload));
        Terms result = (*this)(x);
        const Terms base = result;
        for (long k = 1; k < node.payload && result; ++k) result = product(result, base);
        return result;
      }
      case Op::sqrt: return root(x, Rational(1) / 2);
      case Op::pow:
        if (dag_.is_constant(y)) return root(x, dag_.value(y));
        if (is_time_independent(x)) return exponential(dag_.mul(y, dag_.call(Op::log, x)), dag_.one());
        return std::nullopt;
      case Op::exp: return exponential(x, dag_.one());
      case Op::sin: return wave(x, TimeTerm::Wave::sin);
      case Op::cos: return wave(x, TimeTerm::Wave::cos);
      case Op::sinh:
      case Op::cosh: {
        const Ref half = dag_.constant(Rational(1) / 2);
        Terms up = exponential(x, half), down = exponential(dag_.neg(x), node.op == Op::cosh ? half : dag_.neg(half));
        if (!up || !down) return std::nullopt;
        up->insert(up->end(), down->begin(), down->end());
        return up;
      }
      default: return std::nullopt;
    }
  }

  Terms sum(Ref a, Ref b, bool subtract) {
    Terms left = (*this)(a), right = (*this)(b);
    if (!left || !right) return std::nullopt;
    for (TimeTerm& term : *right) {
      if (subtract) term.factor = dag_.neg(term.factor);
      left->push_back(term);
    }
    std::erase_if(*left, [&](const TimeTerm& term) { return dag_.is_zero(term.factor); });
    return left;
  }

  Terms product(const Terms& a, const Terms& b) {
    if (!a || !b || a->size() * b->size() > most_terms) return std::nullopt;
    std::vector<TimeTerm> result;
    for (const TimeTerm& left : *a) {
      for (const TimeTerm& right : *b) {
        if (!multiply(left, right, result)) return std::nullopt;
      }
    }
    return result;
  }

  bool multiply(const TimeTerm& a, const TimeTerm& b, std::vector<TimeTerm>& result) {
    TimeTerm term = constant(dag_.mul(a.factor, b.factor));
    term.n = a.n + b.n;
    if (!multiply_bases(a, b, term)) return false;
    if (a.growth && b.growth) {
      const Linear both{dag_.add(a.growth->a, b.growth->a), dag_.add(a.growth->b, b.growth->b)};
      if (vanishes(both.a))
        term.factor = dag_.mul(term.factor, dag_.call(Op::exp, both.b));
      else
        term.growth = both;
    } else {
      term.growth = a.growth ? a.growth : b.growth;
    }
    multiply_waves(a, b, term, result);
    return true;
  }

  bool multiply_bases(const TimeTerm& a, const TimeTerm& b, TimeTerm& result) const {
    if (a.base && b.base && *a.base != *b.base) return false;
    result.base = a.base ? a.base : b.base;
    result.exponent = a.exponent + b.exponent;
    if (cln::zerop(result.exponent)) result.base.reset();
    return true;
  }

  // sin x sin y = (cos(x - y) - cos(x + y))/2, and so on.
  void multiply_waves(const TimeTerm& a, const TimeTerm& b, const TimeTerm& rest, std::vector<TimeTerm>& result) {
    using Wave = TimeTerm::Wave;
    if (a.wave == Wave::none || b.wave == Wave::none) {
      TimeTerm term = rest;
      term.wave = a.wave == Wave::none ? b.wave : a.wave;
      term.phase = a.wave == Wave::none ? b.phase : a.phase;
      result.push_back(term);
      return;
    }
    const Linear sum{dag_.add(a.phase.a, b.phase.a), dag_.add(a.phase.b, b.phase.b)};
    const Linear difference{dag_.sub(a.phase.a, b.phase.a), dag_.sub(a.phase.b, b.phase.b)};
    const bool same = a.wave == b.wave;
    TimeTerm of_sum = rest, of_difference = rest;
    of_sum.factor = of_difference.factor = dag_.div(rest.factor, dag_.integer(2));
    if (a.wave == Wave::sin && same) of_sum.factor = dag_.neg(of_sum.factor);
    if (a.wave == Wave::cos && !same) of_difference.factor = dag_.neg(of_difference.factor);
    add_wave(of_difference, same ? Wave::cos : Wave::sin, difference, result);
    add_wave(of_sum, same ? Wave::cos : Wave::sin, sum, result);
  }

  void add_wave(TimeTerm term, TimeTerm::Wave wave, const Linear& phase, std::vector<TimeTerm>& result) {
    if (vanishes(phase.a)) {
      const Ref value = dag_.call(wave == TimeTerm::Wave::sin ? Op::sin : Op::cos, phase.b);
      term.factor = dag_.mul(term.factor, value);
    } else {
      term.wave = wave;
      term.phase = phase;
    }
    if (!dag_.is_zero(term.factor)) result.push_back(term);
  }

  Terms root(Ref base, const Rational& exponent) {
    const std::optional<Linear> x = linear(base);
    if (!x || vanishes(x->a)) return std::nullopt;
    TimeTerm term = constant(dag_.one());
    term.base = x;
    term.exponent = exponent;
    return std::vector<TimeTerm>{term};
  }

  // 1/x of a constant, of (a t + b)^k, or of an exponential.
  Terms reciprocal(Ref r) {
    if (is_time_independent(r)) return std::vector<TimeTerm>{constant(dag_.div(dag_.one(), r))};
    const Node node = dag_[r];
    if (node.op == Op::power) return root(node.args[0], Rational(-node.payload));
    if (node.op == Op::mul) return product(reciprocal(node.args[0]), reciprocal(node.args[1]));
    if (const std::optional<Linear> x = linear(r)) return root(r, -1);
    const Terms terms = (*this)(r);
    if (!terms || terms->size() != 1) return std::nullopt;
    TimeTerm term = terms->front();
    if (term.n != 0 || term.wave != TimeTerm::Wave::none) return std::nullopt;
    term.factor = dag_.div(dag_.one(), term.factor);
    term.exponent = -term.exponent;
    if (term.growth) term.growth = Linear{dag_.neg(term.growth->a), dag_.neg(term.growth->b)};
    return std::vector<TimeTerm>{term};
  }

  Terms exponential(Ref argument, Ref scale) {
    const std::optional<Linear> x = linear(argument);
    if (!x || vanishes(x->a)) return std::nullopt;
    TimeTerm term = constant(scale);
    term.growth = x;
    return std::vector<TimeTerm>{term};
  }

  Terms wave(Ref argument, TimeTerm::Wave kind) {
    const std::optional<Linear> x = linear(argument);
    if (!x || vanishes(x->a)) return std::nullopt;
    TimeTerm term = constant(dag_.one());
    term.wave = kind;
    term.phase = *x;
    return std::vector<TimeTerm>{term};
  }

  std::optional<Linear> linear(Ref r) {  // a may be 0 here
    const Terms terms = (*this)(r);
    if (!terms) return std::nullopt;
    Linear result{dag_.zero(), dag_.zero()};
    for (const TimeTerm& term : *terms) {
      if (term.n > 1 || term.base || term.growth || term.wave != TimeTerm::Wave::none) return std::nullopt;
      Ref& part = term.n == 1 ? result.a : result.b;
      part = dag_.add(part, term.factor);
    }
    return result;
  }

  // It also detects 2 w - (w + w): a frequency in a denominator must not be such a zero.
  bool vanishes(Ref constant) { return dag_.is_zero(expand_or_keep(dag_, constant)); }

  TimeTerm constant(Ref factor) const {
    TimeTerm term;
    term.factor = factor;
    return term;
  }

  Dag& dag_;
  Symbol time_;
};

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
