// Problems with closed forms, for the tests of the integrators. In: a start. Out: right-hand sides and exact states.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "eom/ode.hpp"

namespace problems {

/// The methods for any right-hand side. Those that need its series, momenta or constraints have their own tests
/// (taylor_test.cpp, variational_test.cpp, ggl_test.cpp).
inline std::vector<eom::MethodInfo> methods() {
  std::vector<eom::MethodInfo> result;
  for (const eom::MethodInfo& method : eom::methods())
    if (method.needs.required.none()) result.push_back(method);
  return result;
}

/// The names of the methods with step size control.
inline std::vector<const char*> adaptive_methods() {
  std::vector<const char*> names;
  for (const eom::MethodInfo& method : methods())
    if (method.adaptive) names.push_back(method.name);
  return names;
}

/// Ratio of the error of a method of order 2 with the fixed steps of the tests to the others (not needed for rk4).
inline double coarser(const eom::MethodInfo& method) { return method.order < 4 ? 2e5 : 1; }

using State = std::vector<double>;

/// x'' = -x.
struct Oscillator {
  State start{1, 0.5};
  int operator()(double, const double* x, double* dx) const {
    dx[0] = x[1];
    dx[1] = -x[0];
    return 0;
  }
  State exact(double t) const {
    return {start[0] * std::cos(t) + start[1] * std::sin(t), start[1] * std::cos(t) - start[0] * std::sin(t)};
  }
};

/// The planar two-body problem, semi-major axis 1, from the pericentre.
struct Kepler {
  explicit Kepler(double eccentricity = 0.5) : e(eccentricity), start{1 - e, 0, 0, std::sqrt((1 + e) / (1 - e))} {}
  double e;
  State start;
  int operator()(double, const double* x, double* dx) const {
    const double r2 = x[0] * x[0] + x[1] * x[1];
    const double r3 = r2 * std::sqrt(r2);
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = -x[0] / r3;
    dx[3] = -x[1] / r3;
    return 0;
  }
  State exact(double t) const {
    const long double el = e;
    const long double mean = t;
    long double E = mean;
    for (int k = 0; k < 100; ++k) E -= (E - el * std::sin(E) - mean) / (1 - el * std::cos(E));  // Kepler's equation
    const long double b = std::sqrt(1 - el * el);
    const long double rate = 1 / (1 - el * std::cos(E));
    return {static_cast<double>(std::cos(E) - el), static_cast<double>(b * std::sin(E)),
            static_cast<double>(-std::sin(E) * rate), static_cast<double>(b * std::cos(E) * rate)};
  }
};

/// theta'' = -sin theta, released at rest from theta_max.
struct Pendulum {
  explicit Pendulum(double amplitude = 2) : theta_max(amplitude), start{theta_max, 0} {}
  double theta_max;
  State start;
  int operator()(double, const double* x, double* dx) const {
    dx[0] = x[1];
    dx[1] = -std::sin(x[0]);
    return 0;
  }
  /// 2 pi / agm(1, cos(theta_max / 2)).
  double period() const {
    long double a = 1;
    long double b = std::cos(static_cast<long double>(theta_max) / 2);
    for (int k = 0; k < 8; ++k) {
      const long double mean = (a + b) / 2;
      b = std::sqrt(a * b);
      a = mean;
    }
    return static_cast<double>(2 * std::numbers::pi_v<long double> / a);
  }
  /// sin(theta/2) = k cd(t, k) with k = sin(theta_max / 2): Jacobi's functions by descending arithmetic-geometric
  /// means.
  State exact(double t) const {
    constexpr int levels = 8;
    const long double k = std::sin(static_cast<long double>(theta_max) / 2);
    std::array<long double, levels + 1> a{1};
    std::array<long double, levels + 1> c{k};
    long double b = std::sqrt(1 - k * k);
    for (std::size_t i = 0; i < levels; ++i) {
      a[i + 1] = (a[i] + b) / 2;
      c[i + 1] = (a[i] - b) / 2;
      b = std::sqrt(a[i] * b);
    }
    long double phi = a[levels] * static_cast<long double>(t) * (1 << levels);
    for (std::size_t i = levels; i > 0; --i) phi = (phi + std::asin(c[i] / a[i] * std::sin(phi))) / 2;
    const long double sn = std::sin(phi);
    const long double cn = std::cos(phi);
    const long double dn = std::sqrt(1 - k * k * sn * sn);
    // cd' = -(1 - k^2) sn / dn^2 and theta = 2 asin(k cd)
    const long double cd = cn / dn;
    const long double rate = -(1 - k * k) * sn / (dn * dn);
    return {static_cast<double>(2 * std::asin(k * cd)),
            static_cast<double>(2 * k * rate / std::sqrt(1 - k * k * cd * cd))};
  }
};

inline double largest_difference(const State& a, const State& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace problems
