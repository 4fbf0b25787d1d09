// SPDX-License-Identifier: GPL-3.0-or-later
// Simplification rules applied at construction. Every rule is an identity wherever both sides are defined; none makes
// the expression larger.
#include <cln/integer.h>
#include <cln/integer_io.h>
#include <cln/rational.h>

#include "symbolic/dag.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::symbolic {
namespace {

bool is_negative_constant(const Dag& dag, Ref r) { return dag.is_constant(r) && cln::minusp(dag.value(r)); }

// Exact powers of numbers are folded only while they are small: untrusted input must not exhaust memory.
constexpr long fold_exponent_limit = 64;
constexpr std::uintptr_t fold_bits_limit = 4096;

std::uintptr_t bits(const Rational& value) {
  return cln::integer_length(cln::numerator(value)) + cln::integer_length(cln::denominator(value));
}

/// r of r pi; empty for other expressions.
std::optional<Rational> multiple_of_pi(const Dag& dag, Ref a) {
  const Node& node = dag[a];
  if (node.op == Op::pi) return Rational(1);
  if (node.op == Op::div && dag.is_constant(node.args[1])) {
    const std::optional<Rational> r = multiple_of_pi(dag, node.args[0]);
    if (r) return *r / dag.value(node.args[1]);
  }
  if (node.op != Op::mul) return std::nullopt;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (!dag.is_constant(node.args[k])) continue;
    const std::optional<Rational> r = multiple_of_pi(dag, node.args[1 - k]);
    if (r) return *r * dag.value(node.args[k]);
  }
  return std::nullopt;
}

/// sin(r pi) of r between 0 and 1/2, where it is a fraction.
std::optional<Rational> rational_sine(const Rational& r) {
  if (cln::zerop(r)) return Rational(0);
  if (r == Rational(1) / 6) return Rational(1) / 2;
  if (r == Rational(1) / 2) return Rational(1);
  return std::nullopt;
}

/// The sine or cosine of r pi: a number, or that of an angle between 0 and pi/2. Empty if it is already that.
std::optional<Ref> of_multiple_of_pi(Dag& dag, Op function, const Rational& r) {
  Rational turn = r - 2 * cln::floor1(r / 2);  // 0 to 2
  bool negative = false;
  if (turn > 1) {
    turn = function == Op::sin ? turn - 1 : 2 - turn;
    negative = function == Op::sin;
  }
  if (turn > Rational(1) / 2) {
    turn = 1 - turn;
    negative = negative != (function == Op::cos);
  }
  Ref value;
  if (const std::optional<Rational> exact = rational_sine(function == Op::sin ? turn : Rational(1) / 2 - turn))
    value = dag.constant(*exact);
  else if (turn == r)
    return std::nullopt;
  else
    value = dag.call(function, dag.mul(dag.constant(turn), dag.pi()));
  return negative ? dag.neg(value) : value;
}

}  // namespace

Ref Dag::make(Op op, Ref a, Ref b) {
  Node node;
  node.op = op;
  node.arity = 2;
  node.args[0] = a;
  node.args[1] = b;
  return intern(node);
}

Ref Dag::neg(Ref a) {
  if (is_constant(a)) return constant(-value(a));
  const Node& node = nodes_[a.id];
  if (node.op == Op::neg) return node.args[0];
  Node result;
  result.op = Op::neg;
  result.arity = 1;
  result.args[0] = a;
  return intern(result);
}

Ref Dag::add(Ref a, Ref b) {
  if (is_zero(a)) return b;
  if (is_zero(b)) return a;
  if (is_constant(a) && is_constant(b)) return constant(value(a) + value(b));
  const bool a_negative = nodes_[a.id].op == Op::neg;
  const bool b_negative = nodes_[b.id].op == Op::neg;
  if (a_negative && b_negative) return neg(add(nodes_[a.id].args[0], nodes_[b.id].args[0]));
  if (b_negative) return sub(a, nodes_[b.id].args[0]);
  if (a_negative) return sub(b, nodes_[a.id].args[0]);
  if (a == b) return mul(integer(2), a);
  if (b < a) std::swap(a, b);
  return make(Op::add, a, b);
}

Ref Dag::sub(Ref a, Ref b) {
  if (a == b) return zero_;
  if (is_zero(b)) return a;
  if (is_zero(a)) return neg(b);
  if (is_constant(a) && is_constant(b)) return constant(value(a) - value(b));
  if (is_negative_constant(*this, b)) return add(a, neg(b));
  const bool a_negative = nodes_[a.id].op == Op::neg;
  const bool b_negative = nodes_[b.id].op == Op::neg;
  if (a_negative && b_negative) return sub(nodes_[b.id].args[0], nodes_[a.id].args[0]);
  if (b_negative) return add(a, nodes_[b.id].args[0]);
  if (a_negative) return neg(add(nodes_[a.id].args[0], b));
  if (b < a) return neg(make(Op::sub, b, a));
  return make(Op::sub, a, b);
}

Ref Dag::mul(Ref a, Ref b) {
  if (is_zero(a) || is_zero(b)) return zero_;
  if (is_one(a)) return b;
  if (is_one(b)) return a;
  if (is_constant(a) && is_constant(b)) return constant(value(a) * value(b));
  if (is_negative_constant(*this, a)) return neg(mul(neg(a), b));
  if (is_negative_constant(*this, b)) return neg(mul(a, neg(b)));
  if (nodes_[a.id].op == Op::neg) return neg(mul(nodes_[a.id].args[0], b));
  if (nodes_[b.id].op == Op::neg) return neg(mul(a, nodes_[b.id].args[0]));
  if (is_constant(b)) std::swap(a, b);
  if (is_constant(a) && nodes_[b.id].op == Op::mul && is_constant(nodes_[b.id].args[0])) {
    // c1*(c2*x) -> (c1 c2)*x; a constant is always the first factor (see below)
    return mul(constant(value(a) * value(nodes_[b.id].args[0])), nodes_[b.id].args[1]);
  }
  if (nodes_[b.id].op == Op::mul && is_constant(nodes_[b.id].args[0])) {
    return mul(nodes_[b.id].args[0], mul(a, nodes_[b.id].args[1]));
  }
  if (!is_constant(a) && nodes_[a.id].op == Op::mul && is_constant(nodes_[a.id].args[0])) {
    return mul(nodes_[a.id].args[0], mul(nodes_[a.id].args[1], b));
  }
  const auto is_reciprocal = [this](Ref r) { return nodes_[r.id].op == Op::div && is_one(nodes_[r.id].args[0]); };
  if (is_reciprocal(a)) return div(b, nodes_[a.id].args[1]);
  if (is_reciprocal(b)) return div(a, nodes_[b.id].args[1]);
  if (a == b) return power(a, 2);
  // x^n * x -> x^(n+1), x^n * x^k -> x^(n+k)
  const auto base = [this](Ref r) { return nodes_[r.id].op == Op::power ? nodes_[r.id].args[0] : r; };
  const auto exponent = [this](Ref r) { return nodes_[r.id].op == Op::power ? long{nodes_[r.id].payload} : 1L; };
  if (!is_constant(a) && base(a) == base(b)) return power(base(a), exponent(a) + exponent(b));
  if (!is_constant(a) && b < a) std::swap(a, b);
  return make(Op::mul, a, b);
}

Ref Dag::div(Ref a, Ref b) {
  if (is_one(b)) return a;
  if (is_constant(b) && !is_zero(b)) return mul(constant(cln::recip(value(b))), a);
  if (is_zero(a) && !is_zero(b)) return zero_;
  if (a == b && !is_zero(a)) return one_;  // 0/0 has no value
  if (nodes_[a.id].op == Op::neg) return neg(div(nodes_[a.id].args[0], b));
  if (nodes_[b.id].op == Op::neg) return neg(div(a, nodes_[b.id].args[0]));
  if (is_negative_constant(*this, a)) return neg(div(neg(a), b));
  if (nodes_[b.id].op == Op::div) return mul(a, div(nodes_[b.id].args[1], nodes_[b.id].args[0]));
  // x^n / x -> x^(n-1)
  const Node& numerator = nodes_[a.id];
  if (numerator.op == Op::power && numerator.args[0] == b) return power(b, numerator.payload - 1);
  if (numerator.op == Op::mul && numerator.args[0] == b) return numerator.args[1];
  if (numerator.op == Op::mul && numerator.args[1] == b) return numerator.args[0];
  if (numerator.op == Op::div) return div(numerator.args[0], mul(numerator.args[1], b));
  return make(Op::div, a, b);
}

Ref Dag::power(Ref a, long exponent) {
  if (exponent == 0) return one_;
  if (exponent == 1) return a;
  if (exponent < 0) return div(one_, power(a, -exponent));
  if (is_constant(a) && exponent <= fold_exponent_limit &&
      bits(value(a)) * static_cast<std::uintptr_t>(exponent) <= fold_bits_limit) {
    return constant(cln::expt(value(a), static_cast<int>(exponent)));
  }
  const Node node = nodes_[a.id];
  if (node.op == Op::neg) return exponent % 2 == 0 ? power(node.args[0], exponent) : neg(power(node.args[0], exponent));
  if (node.op == Op::sqrt && exponent % 2 == 0) return power(node.args[0], exponent / 2);
  if (node.op == Op::power && node.payload * exponent <= 1'000'000) return power(node.args[0], node.payload * exponent);
  if (node.op == Op::mul && is_constant(node.args[0])) {
    return mul(power(node.args[0], exponent), power(node.args[1], exponent));
  }
  Node result;
  result.op = Op::power;
  result.arity = 1;
  result.payload = static_cast<std::int32_t>(exponent);
  result.args[0] = a;
  return intern(result);
}

Ref Dag::pow(Ref a, Ref b) {
  if (is_constant(b)) {
    const Rational exponent = value(b);
    const cln::cl_I doubled = cln::numerator(exponent * 2);
    const bool half = cln::denominator(exponent) == 2;
    if (cln::abs(doubled) <= 2000) {
      if (cln::denominator(exponent) == 1) return power(a, cln::cl_I_to_long(cln::numerator(exponent)));
      if (half) return power(call(Op::sqrt, a), cln::cl_I_to_long(doubled));
    }
  }
  if (is_one(a)) return one_;
  return make(Op::pow, a, b);
}

// sqrt(a) if it is exact: for squares of expressions known to be positive, and their products and quotients.
std::optional<Ref> Dag::exact_root(Ref a) {
  const Node node = nodes_[a.id];
  if (is_constant(a)) {
    Rational root;
    if (!cln::minusp(value(a)) && cln::sqrtp(value(a), &root)) return constant(root);
    return std::nullopt;
  }
  if (node.op == Op::power && node.payload % 2 == 0 && is_positive(node.args[0]))
    return power(node.args[0], node.payload / 2);
  if (node.op != Op::mul && node.op != Op::div) return std::nullopt;
  const std::optional<Ref> first = exact_root(node.args[0]);
  const std::optional<Ref> second = first ? exact_root(node.args[1]) : std::nullopt;
  if (!second) return std::nullopt;
  return node.op == Op::mul ? mul(*first, *second) : div(*first, *second);
}

Ref Dag::call(Op function, Ref a) {
  const Function& row = function_of(function);
  if (is_zero(a) && row.at_zero >= 0) return row.at_zero == 0 ? zero_ : one_;
  const Node node = nodes_[a.id];
  if (row.parity != Parity::none && (node.op == Op::neg || is_negative_constant(*this, a))) {
    const Ref positive = neg(a);
    return row.parity == Parity::odd ? neg(call(function, positive)) : call(function, positive);
  }
  if (is_one(a) && function == Op::log) return zero_;
  if (is_constant(a)) {
    if (function == Op::abs) return a;  // negative constants are handled above
    if (function == Op::sign) return one_;
  }
  if (function == Op::sqrt) {
    if (const std::optional<Ref> root = exact_root(a)) return *root;
  }
  if (function == Op::sin || function == Op::cos) {
    const std::optional<Rational> r = multiple_of_pi(*this, a);
    const std::optional<Ref> known = r ? of_multiple_of_pi(*this, function, *r) : std::nullopt;
    if (known) return *known;
  }
  Node result;
  result.op = function;
  result.arity = 1;
  result.args[0] = a;
  return intern(result);
}

Ref Dag::call(Op function, Ref a, Ref b) {
  if (function == Op::min || function == Op::max) {
    if (a == b) return a;
    if (is_constant(a) && is_constant(b)) {
      const bool a_smaller = value(a) < value(b);
      return a_smaller == (function == Op::min) ? a : b;
    }
    if (b < a) std::swap(a, b);
  }
  return make(function, a, b);
}

Ref Dag::select(Ref a, Ref b, Ref x, Ref y) {
  if (x == y) return x;
  if (is_constant(a) && is_constant(b)) return value(a) < value(b) ? x : y;
  Node node;
  node.op = Op::select;
  node.arity = 4;
  node.args = {a, b, x, y};
  return intern(node);
}

}  // namespace eomgen::symbolic
