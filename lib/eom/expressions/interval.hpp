// SPDX-License-Identifier: MIT
// Intervals of values with intervals of slopes, which bound a function of one variable between two points. In:
// operands. Out: bounds of the result and of its derivative, up to rounding. They guide a search; they are not a proof.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "eom/expressions/operations.hpp"

namespace eom::expressions {

/// The values from low to high, both included.
struct Interval {
  double low = 0, high = 0;

  /// All numbers.
  static constexpr Interval all() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  /// Whether the value is in the interval.
  bool has(double value) const { return low <= value && value <= high; }
  /// Whether the interval is this value only.
  bool is(double value) const { return low == value && high == value; }
  /// high - low.
  double width() const { return high - low; }
};

namespace detail {

// 0 times an unbounded value is 0: the slope of a constant factor.
inline double product_of_bounds(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

inline Interval without_nan(Interval a) { return std::isnan(a.low) || std::isnan(a.high) ? Interval::all() : a; }

}  // namespace detail

inline Interval operator+(Interval a, Interval b) { return detail::without_nan({a.low + b.low, a.high + b.high}); }
inline Interval operator-(Interval a, Interval b) { return detail::without_nan({a.low - b.high, a.high - b.low}); }
inline Interval operator-(Interval a) { return {-a.high, -a.low}; }
inline Interval operator*(Interval a, Interval b) {
  const double p = detail::product_of_bounds(a.low, b.low), q = detail::product_of_bounds(a.low, b.high),
               r = detail::product_of_bounds(a.high, b.low), s = detail::product_of_bounds(a.high, b.high);
  return detail::without_nan({std::min({p, q, r, s}), std::max({p, q, r, s})});
}
inline Interval operator/(Interval a, Interval b) {
  if (b.has(0)) return Interval::all();
  return a * Interval{1 / b.high, 1 / b.low};
}
inline Interval hull(Interval a, Interval b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }
/// The intersection; a if it is empty, which is due to rounding.
inline Interval intersection(Interval a, Interval b) {
  const Interval both{std::max(a.low, b.low), std::min(a.high, b.high)};
  return both.low <= both.high ? both : a;
}

namespace detail {

template <class F>
Interval map_monotonic(F f, Interval a) {
  return without_nan({f(a.low), f(a.high)});
}

inline Interval integer_power(Interval a, int n) {
  if (n == 1) return a;
  const auto power = [n](double x) { return n == 2 ? x * x : std::pow(x, n); };
  const double low = power(a.low), high = power(a.high);
  if (n % 2 == 1 || a.low >= 0) return without_nan({low, high});
  if (a.high <= 0) return without_nan({high, low});
  return without_nan({0, std::max(low, high)});
}

inline Interval sine(Interval a) {
  constexpr double pi = std::numbers::pi;
  if (!(a.width() < 2 * pi)) return {-1, 1};
  // A maximum at pi/2 + 2 pi k, a minimum half a turn later.
  const auto contains = [&](double place) {
    return std::ceil((a.low - place) / (2 * pi)) <= std::floor((a.high - place) / (2 * pi));
  };
  const double at_low = std::sin(a.low), at_high = std::sin(a.high);
  return {contains(-pi / 2) ? -1 : std::min(at_low, at_high), contains(pi / 2) ? 1 : std::max(at_low, at_high)};
}

inline Interval cosine(Interval a) {
  constexpr double quarter = std::numbers::pi / 2;
  return sine(a + Interval{quarter, quarter});
}

inline Interval square(Interval a) { return integer_power(a, 2); }

inline bool has_pole_of_tan(Interval a) {
  constexpr double pi = std::numbers::pi;
  return !(a.width() < pi) || std::ceil((a.low - pi / 2) / pi) <= std::floor((a.high - pi / 2) / pi);
}

inline Interval clamp_to_unit(Interval a) { return {std::clamp(a.low, -1.0, 1.0), std::clamp(a.high, -1.0, 1.0)}; }

/// The values of a function of one argument; none if it has a pole or is undefined.
inline std::optional<Interval> values(Op function, Interval a) {
  const auto at = [function](double x) { return call(function, x); };
  switch (function) {
    case Op::sin: return sine(a);
    case Op::cos: return cosine(a);
    case Op::cosh: {
      const double low = at(a.low), high = at(a.high);
      return Interval{a.has(0) ? 1 : std::min(low, high), std::max(low, high)};
    }
    case Op::acos: return Interval{at(clamp_to_unit(a).high), at(clamp_to_unit(a).low)};
    case Op::asin: return map_monotonic(at, clamp_to_unit(a));
    case Op::sqrt:
      if (a.high < 0) return std::nullopt;
      return Interval{at(std::max(0.0, a.low)), at(a.high)};
    case Op::log:
      if (!(a.high > 0)) return std::nullopt;
      return Interval{a.low > 0 ? at(a.low) : -std::numeric_limits<double>::infinity(), at(a.high)};
    case Op::tan:
      if (has_pole_of_tan(a)) return std::nullopt;
      return map_monotonic(at, a);
    default: return map_monotonic(at, a);
  }
}

/// `numbers` of slope_of.
struct IntervalNumbers {
  static Interval one() { return {1, 1}; }
  static Interval two() { return {2, 2}; }
  static Interval square(Interval a) { return detail::square(a); }
};

}  // namespace detail

/// A value and its slope along the one variable. Slopes of jumping functions are unbounded.
struct SlopedInterval {
  Interval value, slope;
};

namespace sloped {

inline SlopedInterval product(const SlopedInterval& a, const SlopedInterval& b) {
  return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}

inline SlopedInterval quotient(const SlopedInterval& a, const SlopedInterval& b) {
  const Interval value = a.value / b.value;
  return {value, (a.slope - value * b.slope) / b.value};
}

/// A function of one argument, except abs and sign, whose branches may be known.
inline SlopedInterval call(Op function, const SlopedInterval& a) {
  const std::optional<Interval> value = detail::values(function, a.value);
  if (!value) return {Interval::all(), Interval::all()};
  const auto [size, divides, falls] =
      slope_of(derivative_of(function), a.value, *value, detail::IntervalNumbers{},
               [](Op op, Interval x) { return detail::values(op, x).value_or(Interval::all()); });
  const Interval slope = divides ? a.slope / size : size * a.slope;
  return {*value, falls ? -slope : slope};
}

/// exponent: 2 or more.
inline SlopedInterval power(const SlopedInterval& a, int exponent) {
  const double factor = exponent;
  return {detail::integer_power(a.value, exponent),
          Interval{factor, factor} * detail::integer_power(a.value, exponent - 1) * a.slope};
}

inline SlopedInterval pow(const SlopedInterval& a, const SlopedInterval& b) {
  if (!(a.value.low > 0)) return {Interval::all(), Interval::all()};
  return call(Op::exp, product(b, call(Op::log, a)));
}

inline SlopedInterval atan2(const SlopedInterval& y, const SlopedInterval& x) {
  const bool jumps = y.value.has(0) && x.value.low <= 0;
  if (jumps) return {{-std::numbers::pi, std::numbers::pi}, Interval::all()};
  const double a = std::atan2(y.value.low, x.value.low), b = std::atan2(y.value.low, x.value.high);
  const double c = std::atan2(y.value.high, x.value.low), d = std::atan2(y.value.high, x.value.high);
  const Interval size = detail::square(x.value) + detail::square(y.value);
  return {{std::min({a, b, c, d}), std::max({a, b, c, d})}, (x.value * y.slope - y.value * x.slope) / size};
}

}  // namespace sloped
}  // namespace eom::expressions
