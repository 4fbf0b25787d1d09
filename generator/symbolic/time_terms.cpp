// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/time_terms.hpp"

#include <algorithm>

#include "symbolic/polynomial.hpp"

namespace eomgen::symbolic {
namespace {

constexpr std::size_t most_terms = 100;
constexpr long highest_power = 12;  // of a sum that is multiplied out

}  // namespace

bool TimeTerms::is_time_independent(Ref expression) const {
  const std::vector<Symbol> symbols = dag_.symbols({expression});
  return std::find(symbols.begin(), symbols.end(), time_) == symbols.end();
}

// It also detects 2 w - (w + w): a frequency in a denominator must not be such a zero.
bool TimeTerms::vanishes(Ref constant) { return dag_.is_zero(expand_or_keep(dag_, constant)); }

TimeTerm TimeTerms::constant(Ref factor) const {
  TimeTerm term;
  term.factor = factor;
  return term;
}

std::optional<std::vector<TimeTerm>> TimeTerms::operator()(Ref r) {
  if (is_time_independent(r)) return std::vector<TimeTerm>{constant(r)};
  Terms terms = of_node(r);
  if (terms && terms->size() > most_terms) return std::nullopt;
  return terms;
}

TimeTerms::Terms TimeTerms::of_node(Ref r) {
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

TimeTerms::Terms TimeTerms::sum(Ref a, Ref b, bool subtract) {
  Terms left = (*this)(a), right = (*this)(b);
  if (!left || !right) return std::nullopt;
  for (TimeTerm& term : *right) {
    if (subtract) term.factor = dag_.neg(term.factor);
    left->push_back(term);
  }
  std::erase_if(*left, [&](const TimeTerm& term) { return dag_.is_zero(term.factor); });
  return left;
}

TimeTerms::Terms TimeTerms::product(const Terms& a, const Terms& b) {
  if (!a || !b || a->size() * b->size() > most_terms) return std::nullopt;
  std::vector<TimeTerm> result;
  for (const TimeTerm& left : *a) {
    for (const TimeTerm& right : *b) {
      if (!multiply(left, right, result)) return std::nullopt;
    }
  }
  return result;
}

bool TimeTerms::multiply(const TimeTerm& a, const TimeTerm& b, std::vector<TimeTerm>& result) {
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

bool TimeTerms::multiply_bases(const TimeTerm& a, const TimeTerm& b, TimeTerm& result) const {
  if (a.base && b.base && *a.base != *b.base) return false;
  result.base = a.base ? a.base : b.base;
  result.exponent = a.exponent + b.exponent;
  if (cln::zerop(result.exponent)) result.base.reset();
  return true;
}

// sin x sin y = (cos(x - y) - cos(x + y))/2, and so on.
void TimeTerms::multiply_waves(const TimeTerm& a, const TimeTerm& b, const TimeTerm& rest,
                               std::vector<TimeTerm>& result) {
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

void TimeTerms::add_wave(TimeTerm term, TimeTerm::Wave wave, const Linear& phase, std::vector<TimeTerm>& result) {
  if (vanishes(phase.a)) {
    const Ref value = dag_.call(wave == TimeTerm::Wave::sin ? Op::sin : Op::cos, phase.b);
    term.factor = dag_.mul(term.factor, value);
  } else {
    term.wave = wave;
    term.phase = phase;
  }
  if (!dag_.is_zero(term.factor)) result.push_back(term);
}

std::optional<Linear> TimeTerms::linear(Ref r) {
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

TimeTerms::Terms TimeTerms::root(Ref base, const Rational& exponent) {
  const std::optional<Linear> x = linear(base);
  if (!x || vanishes(x->a)) return std::nullopt;
  TimeTerm term = constant(dag_.one());
  term.base = x;
  term.exponent = exponent;
  return std::vector<TimeTerm>{term};
}

// 1/x of a constant, of (a t + b)^k, or of an exponential.
TimeTerms::Terms TimeTerms::reciprocal(Ref r) {
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

TimeTerms::Terms TimeTerms::exponential(Ref argument, Ref scale) {
  const std::optional<Linear> x = linear(argument);
  if (!x || vanishes(x->a)) return std::nullopt;
  TimeTerm term = constant(scale);
  term.growth = x;
  return std::vector<TimeTerm>{term};
}

TimeTerms::Terms TimeTerms::wave(Ref argument, TimeTerm::Wave kind) {
  const std::optional<Linear> x = linear(argument);
  if (!x || vanishes(x->a)) return std::nullopt;
  TimeTerm term = constant(dag_.one());
  term.wave = kind;
  term.phase = *x;
  return std::vector<TimeTerm>{term};
}

}  // namespace eomgen::symbolic
