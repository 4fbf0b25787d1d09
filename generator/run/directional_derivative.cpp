// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/directional_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "run/central_differences.hpp"
#include "run/variational_equations.hpp"

namespace eomgen::run {
namespace {

constexpr int smaller_differences = -4, most_differences = 8;  // powers of 2; number of the differences tried

/// Whether slopes by narrower differences are those by wider ones, but for their rounding. Far from the point a
/// function may be as smooth, with another slope.
bool agree(const Slopes& wider, const Slopes& narrower, const std::vector<double>& middle, double step) {
  constexpr double tolerance = 1e-6, rounding = 1e-13;
  const double error = rounding * largest_magnitude(middle) / step;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    const double allowed = tolerance * std::abs(narrower.value[i]) + error;
    if (!(std::abs(wider.value[i] - narrower.value[i]) <= allowed)) return false;
  }
  return true;
}

/// The components that move, and the time, by as much as they are.
double widest_step(const Scene& scene, const std::vector<double>& x, double dt, const std::vector<double>& dx) {
  constexpr double moves = 1e-8;  // of the largest change: less is rounding
  const double size = largest_magnitude(dx), by_time = (scene.t1 - scene.t0) / std::abs(dt);
  if (size == 0) return by_time;
  double widest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::abs(dx[i]) > moves * size) widest = std::max(widest, std::abs(x[i] / dx[i]));
  }
  if (widest * size <= scene.atol) widest = std::max(largest_magnitude(x), scene.atol) / size;
  return dt == 0 ? widest : std::min(widest, by_time);
}

}  // namespace

double largest_magnitude(const std::vector<double>& values) {
  double size = 0;
  for (const double v : values) size = std::max(size, std::abs(v));
  return size;
}

std::vector<double> derivative_along(const Scene& scene, double t, const std::vector<double>& x, double dt,
                                     const std::vector<double>& dx, const Described& what,
                                     const FunctionOfState& values) {
  const std::vector<double> middle = values(t, x);
  if (largest_magnitude(dx) == 0 && dt == 0) return std::vector<double>(middle.size(), 0.0);
  double step = std::ldexp(1.0, std::ilogb(widest_step(scene, x, dt, dx)));
  std::optional<Slopes> wider;
  for (int attempt = 0; attempt < most_differences; ++attempt) {
    step = std::ldexp(step, smaller_differences);
    std::vector<std::vector<double>> beside;
    for (const double offset : difference_offsets(step)) {
      std::vector<double> at = x;
      for (std::size_t i = 0; i < x.size(); ++i) at[i] += offset * dx[i];
      beside.push_back(values(t + offset * dt, std::move(at)));
    }
    Slopes found = slopes(middle, beside, step);
    if (wider && found.smooth && agree(*wider, found, middle, step)) return wider->value;
    wider.reset();
    if (found.smooth) wider = std::move(found);
  }
  refuse_derivative(what());
}

}  // namespace eomgen::run
