// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/interval.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "symbolic/arithmetic.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::run {

using symbolic::Op;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// 0 times what is unbounded is 0: the slope of a constant factor.
double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

Interval valid(Interval a) { return std::isnan(a.low) || std::isnan(a.high) ? Interval::all() : a; }

template <class F>
Interval rising(F f, Interval a) {
  return valid({f(a.low), f(a.high)});
}

Interval whole_power(Interval a, int n) {
  const double low = std::pow(a.low, n), high = std::pow(a.high, n);
  if (n % 2 == 1 || a.low >= 0) return valid({low, high});
  if (a.high <= 0) return valid({high, low});
  return valid({0, std::max(low, high)});
}

Interval sine(Interval a) {
  constexpr double pi = std::numbers::pi;
  if (!(a.width() < 2 * pi)) return {-1, 1};
  // A maximum at pi/2 + 2 pi k, a minimum half a turn later.
  const auto contains = [&](double place) {
    return std::ceil((a.low - place) / (2 * pi)) <= std::floor((a.high - place) / (2 * pi));
  };
  const double at_low = std::sin(a.low), at_high = std::sin(a.high);
  return {contains(-pi / 2) ? -1 : std::min(at_low, at_high), contains(pi / 2) ? 1 : std::max(at_low, at_high)};
}

Interval cosine(Interval a) {
  constexpr double quarter = std::numbers::pi / 2;
  return sine(a + Interval{quarter, quarter});
}

Interval square(Interval a) { return whole_power(a, 2); }

bool has_pole_of_tan(Interval a) {
  constexpr double pi = std::numbers::pi;
  return !(a.width() < pi) || std::ceil((a.low - pi / 2) / pi) <= std::floor((a.high - pi / 2) / pi);
}

Interval within_one(Interval a) { return {std::clamp(a.low, -1.0, 1.0), std::clamp(a.high, -1.0, 1.0)}; }

/// The values of a function of one argument; none where it has a pole or is not defined.
std::optional<Interval> values(Op function, Interval a) {
  const auto at = [function](double x) { return symbolic::Binary64::call(function, x); };
  switch (function) {
    case Op::sin: return sine(a);
    case Op::cos: return cosine(a);
    case Op::cosh: {
      const double low = at(a.low), high = at(a.high);
      return Interval{a.has(0) ? 1 : std::min(low, high), std::max(low, high)};
    }
    case Op::acos: return Interval{at(within_one(a).high), at(within_one(a).low)};
    case Op::asin: return rising(at, within_one(a));
    case Op::sqrt:
      if (a.high < 0) return std::nullopt;
      return Interval{at(std::max(0.0, a.low)), at(a.high)};
    case Op::log:
      if (!(a.high > 0)) return std::nullopt;
      return Interval{a.low > 0 ? at(a.low) : -infinity, at(a.high)};
    case Op::tan:
      if (has_pole_of_tan(a)) return std::nullopt;
      return rising(at, a);
    default: return rising(at, a);
  }
}

/// `numbers` of symbolic::slope_of.
struct Numbers {
  static Interval one() { return {1, 1}; }
  static Interval two() { return {2, 2}; }
  static Interval square(Interval a) { return run::square(a); }
  static Interval call(Op function, Interval a) { return values(function, a).value_or(Interval::all()); }
};

}  // namespace

Interval operator+(Interval a, Interval b) { return valid({a.low + b.low, a.high + b.high}); }
Interval operator-(Interval a, Interval b) { return valid({a.low - b.high, a.high - b.low}); }
Interval operator-(Interval a) { return {-a.high, -a.low}; }
Interval operator*(Interval a, Interval b) {
  const double p = times(a.low, b.low), q = times(a.low, b.high), r = times(a.high, b.low), s = times(a.high, b.high);
  return valid({std::min({p, q, r, s}), std::max({p, q, r, s})});
}
Interval operator/(Interval a, Interval b) {
  if (b.has(0)) return Interval::all();
  return a * Interval{1 / b.high, 1 / b.low};
}
Interval hull(Interval a, Interval b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }
Interval common(Interval a, Interval b) {
  const Interval both{std::max(a.low, b.low), std::min(a.high, b.high)};
  return both.low <= both.high ? both : a;
}

namespace sloped {

Sloped product(const Sloped& a, const Sloped& b) { return {a.value * b.value, a.slope * b.value + a.value * b.slope}; }

Sloped quotient(const Sloped& a, const Sloped& b) {
  const Interval value = a.value / b.value;
  return {value, (a.slope - value * b.slope) / b.value};
}

Sloped call(Op function, const Sloped& a) {
  const std::optional<Interval> value = values(function, a.value);
  if (!value) return {Interval::all(), Interval::all()};
  const auto [size, divides, falls] = symbolic::slope_of(symbolic::function_of(function), a.value, *value, Numbers{});
  const Interval slope = divides ? a.slope / size : size * a.slope;
  return {*value, falls ? -slope : slope};
}

Sloped power(const Sloped& a, int n) {
  const double factor = n;
  return {whole_power(a.value, n), Interval{factor, factor} * whole_power(a.value, n - 1) * a.slope};
}

Sloped pow(const Sloped& a, const Sloped& b) {
  if (!(a.value.low > 0)) return {Interval::all(), Interval::all()};
  return call(Op::exp, product(b, call(Op::log, a)));
}

Sloped atan2(const Sloped& y, const Sloped& x) {
  const bool jumps = y.value.has(0) && x.value.low <= 0;
  if (jumps) return {{-std::numbers::pi, std::numbers::pi}, Interval::all()};
  const double a = std::atan2(y.value.low, x.value.low), b = std::atan2(y.value.low, x.value.high);
  const double c = std::atan2(y.value.high, x.value.low), d = std::atan2(y.value.high, x.value.high);
  const Interval size = square(x.value) + square(y.value);
  return {{std::min({a, b, c, d}), std::max({a, b, c, d})}, (x.value * y.slope - y.value * x.slope) / size};
}

}  // namespace sloped
}  // namespace eomgen::run
