// SPDX-License-Identifier: MIT
// Roots of a function of one variable between two points with different signs, and negative values between points with
// equal signs. In: the function, a bracket, a tolerance. Out: the argument. No allocation; a value that is not finite
// ends the search.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace eom::events {

/// The root of f between a and b (f(a) f(b) < 0) to within `tolerance`: Chandrupatla's method (Advances in Engineering
/// Software 28, 1997) with inverse quadratic interpolation if it is safe, else bisection.
template <class F>
double find_root(F&& f, double a, double fa, double b, double fb, double tolerance) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  double c = a, fc = fa, t = 0.5;
  while (true) {
    const double x = a + t * (b - a);
    const double fx = f(x);
    if (!std::isfinite(fx)) return x;
    if ((fx > 0) == (fa > 0)) {
      c = a, fc = fa;
    } else {
      c = b, fc = fb, b = a, fb = fa;
    }
    a = x, fa = fx;
    const double best = std::abs(fa) < std::abs(fb) ? a : b;
    const double limit = (2 * epsilon * std::abs(best) + 0.5 * tolerance) / std::abs(b - a);
    if (limit > 0.5 || fa == 0) return fa == 0 ? a : best;
    const double xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb);
    const bool safe = phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi;
    t = safe ? fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb) : 0.5;
    t = std::clamp(t, limit, 1 - limit);
  }
}

/// A point between a and c at which f is negative; f is positive at both and smaller at b in between. NaN if the
/// minimum is not negative. Golden section, ended at the first negative value.
template <class F>
double find_negative(F&& f, double a, double b, double fb, double c, double tolerance) {
  constexpr double golden = 0.38196601125010515;
  while (c - a > tolerance) {
    const double x = b - a > c - b ? b - golden * (b - a) : b + golden * (c - b);
    const double fx = f(x);
    if (!std::isfinite(fx)) break;
    if (fx < 0) return x;
    if (fx < fb) {
      (x < b ? c : a) = b;
      b = x, fb = fx;
    } else {
      (x < b ? a : c) = x;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// A point at which f is negative between three samples that are not, the middle one the lowest; else NaN. fa may be
/// unknown, NaN.
template <class F>
double find_dip(F& f, double a, double fa, double b, double fb, double c, double fc) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  constexpr double threshold = 0.5;  // of the smallest sample: a parabola with a lower vertex is examined
  if (!std::isfinite(fa)) fa = f(a);
  if (!(fb > 0 && fb <= fa && fb < fc)) return none;
  const double left = (fb - fa) / (b - a), right = (fc - fb) / (c - b);
  const double bend = (right - left) / (c - a);  // second divided difference, positive at a dip
  const double slope = left + bend * (b - a);    // of the parabola at b
  const double vertex = fb - slope * slope / (4 * bend);
  if (!(vertex < threshold * fb)) return none;
  return find_negative(f, a, b, fb, c, 1e-9);
}

/// A value of a function at a point.
struct Point {
  double s, value;
};

/// A point between b and c at which the function is negative although the four samples are not; NaN if the lines
/// through the outer samples meet above zero, or if there is no such point.
template <class F>
double find_dip_of_lines(Point a, Point b, Point c, Point d, F& inward) {
  if (!(a.value > 0 && b.value > 0 && c.value > 0 && d.value > 0)) return std::numeric_limits<double>::quiet_NaN();
  const double falls = (b.value - a.value) / (b.s - a.s), rises = (d.value - c.value) / (d.s - c.s);
  if (!(falls < 0 && rises > 0)) return std::numeric_limits<double>::quiet_NaN();
  const double s = (c.value - b.value + falls * b.s - rises * c.s) / (falls - rises);
  if (!(s > b.s && s < c.s && b.value + falls * (s - b.s) < 0)) return std::numeric_limits<double>::quiet_NaN();
  const Point m{s, inward(s)};
  if (m.value < 0) return s;
  if (m.value < b.value && m.value < c.value) return find_negative(inward, b.s, s, m.value, c.s, 1e-9);
  if (b.value < c.value) return find_negative(inward, a.s, b.s, b.value, s, 1e-9);
  return find_negative(inward, s, c.s, c.value, d.s, 1e-9);
}

}  // namespace eom::events
