// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/interval.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eomgen::run {
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

Interval square(Interval a) { return whole_power(a, 2); }

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

Sloped power(const Sloped& a, int n) {
  const double factor = n;
  return {whole_power(a.value, n), Interval{factor, factor} * whole_power(a.value, n - 1) * a.slope};
}

Sloped pow(const Sloped& a, const Sloped& b) {
  if (!(a.value.low > 0)) return {Interval::all(), Interval::all()};
  return exp(product(b, log(a)));
}

Sloped sqrt(const Sloped& a) {
  if (a.value.high < 0) return {Interval::all(), Interval::all()};
  const Interval value{std::sqrt(std::max(0.0, a.value.low)), std::sqrt(a.value.high)};
  return {value, a.slope / (Interval{2, 2} * value)};
}

Sloped sin(const Sloped& a) {
  constexpr double quarter = std::numbers::pi / 2;
  return {sine(a.value), sine(a.value + Interval{quarter, quarter}) * a.slope};
}

Sloped cos(const Sloped& a) {
  constexpr double quarter = std::numbers::pi / 2;
  return {sine(a.value + Interval{quarter, quarter}), -(sine(a.value) * a.slope)};
}

Sloped tan(const Sloped& a) {
  constexpr double pi = std::numbers::pi;
  const bool pole =
      !(a.value.width() < pi) || std::ceil((a.value.low - pi / 2) / pi) <= std::floor((a.value.high - pi / 2) / pi);
  if (pole) return {Interval::all(), Interval::all()};
  const Interval value = rising([](double x) { return std::tan(x); }, a.value);
  return {value, (Interval{1, 1} + square(value)) * a.slope};
}

namespace {

Interval slope_of_arcs(const Sloped& a) {
  const Interval rest = Interval{1, 1} - square(a.value);
  if (rest.low <= 0) return Interval::all();
  return a.slope / Interval{std::sqrt(rest.low), std::sqrt(rest.high)};
}

Interval within_one(Interval a) { return {std::clamp(a.low, -1.0, 1.0), std::clamp(a.high, -1.0, 1.0)}; }

}  // namespace

Sloped asin(const Sloped& a) {
  return {rising([](double x) { return std::asin(x); }, within_one(a.value)), slope_of_arcs(a)};
}
Sloped acos(const Sloped& a) {
  const Interval value = within_one(a.value);
  return {{std::acos(value.high), std::acos(value.low)}, -slope_of_arcs(a)};
}
Sloped atan(const Sloped& a) {
  return {rising([](double x) { return std::atan(x); }, a.value), a.slope / (Interval{1, 1} + square(a.value))};
}
Sloped exp(const Sloped& a) {
  const Interval value = rising([](double x) { return std::exp(x); }, a.value);
  return {value, value * a.slope};
}
Sloped log(const Sloped& a) {
  if (!(a.value.high > 0)) return {Interval::all(), Interval::all()};
  const double low = a.value.low > 0 ? std::log(a.value.low) : -infinity;
  return {{low, std::log(a.value.high)}, a.slope / a.value};
}
Sloped sinh(const Sloped& a) {
  const Interval value = rising([](double x) { return std::sinh(x); }, a.value);
  const Interval even = square(value) + Interval{1, 1};
  return {value, Interval{std::sqrt(even.low), std::sqrt(even.high)} * a.slope};
}
Sloped cosh(const Sloped& a) {
  const double low = std::cosh(a.value.low), high = std::cosh(a.value.high);
  return {{a.value.has(0) ? 1 : std::min(low, high), std::max(low, high)},
          rising([](double x) { return std::sinh(x); }, a.value) * a.slope};
}
Sloped tanh(const Sloped& a) {
  const Interval value = rising([](double x) { return std::tanh(x); }, a.value);
  return {value, (Interval{1, 1} - square(value)) * a.slope};
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
