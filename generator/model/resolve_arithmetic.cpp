// SPDX-License-Identifier: GPL-3.0-or-later
// Sums, products, powers and units: exact constants of limited size, dimensions, scalars and vectors.
#include <cln/integer.h>
#include <cln/rational.h>
#include <fmt/format.h>

#include <algorithm>

#include "model/lone_parameter.hpp"
#include "model/resolver.hpp"

namespace eomgen::model {
namespace {

constexpr long largest_exponent = 64;       // of a constant power
constexpr double largest_nested = 4096;     // product of nested exponents
constexpr std::size_t largest_bits = 4096;  // of a constant

std::size_t bits(const Rational& value) {
  return cln::integer_length(cln::numerator(value)) + cln::integer_length(cln::denominator(value));
}

// Whether a number is certainly not a quantity with a unit: in 2*x, x/2 and x/12 it is a pure number; in 0.3*x it may
// be a stiffness.
bool pure_factor(const Rational& factor) {
  const Rational size = cln::abs(factor);
  if (size == 0 || size == 1 || size == 2) return true;
  return cln::numerator(size) == 1 && cln::denominator(size) <= 12;
}

std::string side(const std::optional<Dimension>& dimension) { return dimension ? text_of(*dimension) : "unknown"; }

}  // namespace

void Resolver::check_size(TypedNode& typed, Span span) {
  if (typed.constant && bits(*typed.constant) > largest_bits) {
    source_.fail(span, fmt::format("this number has more than {} bits", largest_bits),
                 "use a number that fits a double");
  }
}

void Resolver::require_same_dimension(TypedNode& result, const TypedNode& a, const TypedNode& b, Span span,
                                      std::string_view relation) {
  const bool known_a = a.dimension.has_value(), known_b = b.dimension.has_value();
  const bool loose = (known_a && a.has_uncertain_dimension) || (known_b && b.has_uncertain_dimension);
  if (known_a && known_b && !same(*a.dimension, *b.dimension)) {
    report_mismatch(
        span,
        fmt::format("{} on one side and {} on the other side of {}", side(a.dimension), side(b.dimension), relation),
        loose);
    result.dimension = a.has_uncertain_dimension ? b.dimension : a.dimension;
    result.has_uncertain_dimension = a.has_uncertain_dimension && b.has_uncertain_dimension;
    return;
  }
  if (known_a && known_b) {
    for (const TypedNode* side : {&a, &b}) {
      if (const auto parameter = lone_parameter(model_, side->node)) parameters_that_fit_.insert(*parameter);
    }
  }
  const bool literal = a.literal && b.literal;
  if (known_a || known_b) {
    // An unknown dimension is assumed to match the other side.
    result.dimension = known_a ? a.dimension : b.dimension;
    result.has_uncertain_dimension = (!known_a || a.has_uncertain_dimension) && (!known_b || b.has_uncertain_dimension);
  }
  result.literal = literal;
  result.is_pure_number = literal && a.is_pure_number && b.is_pure_number;
  result.is_bare_time = (a.is_bare_time || a.literal) && (b.is_bare_time || b.literal) && !literal;
}

// The dimension of a*b or a/b, for scalars and for dot and cross products.
void Resolver::combine(TypedNode& result, const TypedNode& a, const TypedNode& b, bool quotient_of) {
  const bool bare_a = a.is_bare_time || a.literal, bare_b = b.is_bare_time || b.literal;
  if (a.literal && b.literal) {
    result.literal = true;
    result.is_pure_number = a.is_pure_number && b.is_pure_number;
    return;
  }
  result.is_bare_time = bare_a && bare_b;
  const auto vanishes = [&](const TypedNode& typed) {
    return model_.arena[typed.node].op == Op::zero_vector ||
           (typed.literal && !typed.vector && typed.constant && cln::zerop(*typed.constant));
  };
  if (vanishes(a) || (!quotient_of && vanishes(b))) return;  // 0 fits every dimension
  if ((a.literal || a.dimension) && (b.literal || b.dimension)) {
    const Dimension left = a.literal ? Dimension{} : *a.dimension;
    const Dimension right = b.literal ? Dimension{} : *b.dimension;
    result.dimension = quotient_of ? quotient(left, right) : product(left, right);
  }
  result.has_uncertain_dimension =
      result.has_uncertain_dimension || (a.literal && !a.is_pure_number) || (b.literal && !b.is_pure_number);
}

TypedNode Resolver::apply_unit(TypedNode typed, const MeasuredUnit& unit, Span span) {
  if (typed.vector) {
    if (typed.dimension && !is_one(*typed.dimension)) {
      source_.fail(span, fmt::format("the units clash: this has the dimension {} already", text_of(*typed.dimension)),
                   "leave the unit out");
    }
  } else if (typed.dimension && !is_one(*typed.dimension)) {
    report_mismatch(span,
                    fmt::format("the value already has the dimension {}, and the unit {} is added",
                                text_of(*typed.dimension), unit.text),
                    typed.has_uncertain_dimension);
  }
  TypedNode result = typed;
  if (typed.literal && typed.constant && !typed.vector) {
    result = number(*typed.constant * unit.scale, model_.arena[typed.node].span);
  } else if (unit.scale != 1) {
    result = multiply(typed, number(unit.scale, span), span);
  }
  if (unit.pi_power != 0) {
    TypedNode pi = make(Op::pi, false, {}, span);
    const TypedNode factor = std::abs(unit.pi_power) == 1 ? pi : power(pi, number(std::abs(unit.pi_power), span), span);
    result = unit.pi_power > 0 ? multiply(result, factor, span) : divide(result, factor, span);
  }
  result.dimension = unit.dimension;
  result.literal = false;
  result.has_uncertain_dimension = false;
  result.is_bare_time = false;
  return result;
}

TypedNode Resolver::with_unit(const TypedNode& typed, const MeasuredUnit& unit, Span span) {
  const bool has_it = typed.dimension && !is_one(unit.dimension) && same(*typed.dimension, unit.dimension);
  if (has_it && unit.scale == 1 && unit.pi_power == 0) return typed;
  return apply_unit(typed, unit, span);
}

TypedNode Resolver::number_node(const SyntaxNode& node) {
  TypedNode result = number(node.value, node.span);
  return node.unit ? apply_unit(result, *node.unit, node.span) : result;
}

TypedNode Resolver::number(const Rational& value, Span span) {
  TypedNode result = make(Op::number, false, {}, span);
  model_.arena.nodes[result.node].value = value;
  result.literal = true;
  result.is_pure_number = pure_factor(value);
  result.constant = value;
  return result;
}

TypedNode Resolver::negate(const TypedNode& a, Span span) {
  if (a.literal && a.constant && !a.vector) return number(-*a.constant, span);  // keeps -1 one number
  TypedNode result = make(Op::negate, a.vector, {a}, span);
  result.dimension = a.dimension;
  result.literal = a.literal;
  result.is_pure_number = a.is_pure_number;
  result.is_bare_time = a.is_bare_time;
  if (a.constant) result.constant = -*a.constant;
  return result;
}

TypedNode Resolver::add(SyntaxKind kind, TypedNode a, TypedNode b, Span span) {
  const auto zero = [](const TypedNode& typed) {
    return typed.literal && !typed.vector && typed.constant && cln::zerop(*typed.constant);
  };
  for (TypedNode* side : {&a, &b}) {
    const TypedNode& other = side == &a ? b : a;
    if (side->vector || !other.vector) continue;
    if (!zero(*side)) {
      source_.fail(span, "a vector and a scalar cannot be added",
                   "multiply the scalar by a direction such as E1, or take a component dot(a, E1)");
    }
    *side = make(Op::zero_vector, true, {}, span);
    side->literal = side->is_pure_number = true;
  }
  TypedNode result = make(kind == SyntaxKind::add ? Op::add : Op::subtract, a.vector, {a, b}, span);
  require_same_dimension(result, a, b, span, kind == SyntaxKind::add ? "'+'" : "'-'");
  if (a.constant && b.constant) {
    result.constant = kind == SyntaxKind::add ? *a.constant + *b.constant : *a.constant - *b.constant;
    result.is_pure_number = result.literal && pure_factor(*result.constant);
    check_size(result, span);
  }
  return result;
}

TypedNode Resolver::multiply(const TypedNode& a, const TypedNode& b, Span span) {
  if (a.vector && b.vector) {
    source_.fail(span, "two vectors are multiplied with '*'", "write dot(a, b) or cross(a, b)");
  }
  TypedNode result = make(Op::multiply, a.vector || b.vector, {a, b}, span);
  combine(result, a, b, false);
  if (a.constant && b.constant) {
    result.constant = *a.constant * *b.constant;
    result.is_pure_number = result.literal && pure_factor(*result.constant);
    check_size(result, span);
  }
  return result;
}

TypedNode Resolver::divide(const TypedNode& a, const TypedNode& b, Span span) {
  if (b.vector) source_.fail(span, "something is divided by a vector", "divide by norm(a) or by a component");
  if (b.constant && cln::zerop(*b.constant) && b.literal) {
    source_.fail(span, "this is a division by zero", "check the denominator");
  }
  TypedNode result = make(Op::divide, a.vector, {a, b}, span);
  TypedNode divisor = b;
  if (b.literal && b.constant) divisor.is_pure_number = pure_factor(1 / *b.constant);  // as in x/12 and x/2
  combine(result, a, divisor, true);
  if (a.constant && b.constant && !cln::zerop(*b.constant)) {
    result.constant = *a.constant / *b.constant;
    result.is_pure_number = result.literal && pure_factor(*result.constant);
    check_size(result, span);
  }
  return result;
}

TypedNode Resolver::power(const TypedNode& a, const TypedNode& b, Span span) {
  if (a.vector || b.vector) source_.fail(span, "a vector stands in a power", "write dot(a, a) or norm(a)^2");
  if (b.dimension && !is_one(*b.dimension)) {
    report_wrong_dimension(b, span, "an exponent is a pure number", b.has_uncertain_dimension);
  }
  TypedNode result = make(Op::power, false, {a, b}, span);
  result.literal = a.literal && b.literal;
  result.is_bare_time = a.is_bare_time && b.literal;
  if (!b.constant) {
    if (a.dimension && is_one(*a.dimension)) result.dimension = a.dimension;
    return result;
  }
  const Rational exponent = *b.constant;
  if (cln::abs(exponent) > largest_exponent || cln::denominator(exponent) > largest_exponent) {
    source_.fail(span, fmt::format("this exponent has a numerator or denominator above {}", largest_exponent),
                 fmt::format("constant exponents have numerators and denominators up to {}", largest_exponent));
  }
  result.exponents = std::max(1.0, cln::double_approx(cln::abs(exponent))) * a.exponents;
  if (result.exponents > largest_nested) {
    source_.fail(span, fmt::format("nested powers have a total exponent above {}", largest_nested),
                 "write a smaller power");
  }
  if (b.literal && a.dimension) result.dimension = raised(*a.dimension, exponent);
  if (!a.constant || cln::denominator(exponent) != 1) return result;
  const cln::cl_I whole = cln::numerator(exponent);
  if (cln::zerop(*a.constant) && cln::minusp(whole)) {
    if (a.literal) source_.fail(span, "this is a division by zero", "check the base of the power");
    return result;
  }
  if (static_cast<std::size_t>(cln::cl_I_to_int(cln::abs(whole))) * bits(*a.constant) > largest_bits) {
    source_.fail(span, fmt::format("this number has more than {} bits", largest_bits),
                 "use a number that fits a double");
  }
  result.constant = cln::expt(*a.constant, whole);
  result.is_pure_number = result.literal && pure_factor(*result.constant);
  return result;
}

}  // namespace eomgen::model
