// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/directional_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "run/central_differences.hpp"
#include "run/derivative_run.hpp"

namespace eomgen::run {
namespace {

constexpr int smaller_differences = -4, most_differences = 8;  // powers of 2; number of the differences tried

constexpr double tolerance = 1e-6;  // of a slope

/// Steps that change the state as a whole, and its component that changes the most.
struct StepScales {
  double widest, narrowest;
};

/// Whether slopes by narrower differences are those by wider ones, but for their rounding. Far from the point a
/// function may be as smooth, with another slope. scales: they tell which slopes are small.
bool agree(const Slopes& wider, const Slopes& narrower, const std::vector<double>& middle, double step,
           const StepScales& scales) {
  constexpr double rounding = 1e-13, of_fastest = 1e-2;
  const double largest = largest_magnitude(middle), error = rounding * largest / step;
  const double small = std::max(largest / scales.widest, of_fastest * largest / scales.narrowest);
  if (error > tolerance * std::max(largest_magnitude(narrower.value), small)) return false;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    const double allowed = tolerance * std::abs(narrower.value[i]) + error;
    if (!(std::abs(wider.value[i] - narrower.value[i]) <= allowed)) return false;
  }
  return true;
}

/// The components that move, and the time, by as much as they are.
StepScales step_scales(const DifferenceScales& scales, const std::vector<double>& x, double dt,
                       const std::vector<double>& dx) {
  constexpr double moves = 1e-8;  // of the largest change: less is rounding
  constexpr double part = 1e-2;   // of the states of the run, where the state itself has no scale
  const double size = largest_magnitude(dx), by_time = scales.span / std::abs(dt);
  if (size == 0) return {by_time, by_time};
  double widest = 0, typical = 0, narrowest = by_time;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::abs(dx[i]) <= moves * size) continue;
    widest = std::max(widest, std::abs(x[i] / dx[i]));
    const double own = std::max(std::abs(x[i]), scales.states[i]) / std::abs(dx[i]);
    typical = std::max(typical, own);
    if (own > 0) narrowest = std::min(narrowest, own);
  }
  if (typical == 0) typical = std::max(1.0, largest_magnitude(scales.states)) / size;
  if (widest <= DifferenceScales::near_zero * typical) widest = part * typical;
  if (dt != 0) widest = std::min(widest, by_time);
  return {widest, std::min(narrowest, widest)};
}

}  // namespace

double largest_magnitude(const std::vector<double>& values) {
  double size = 0;
  for (const double v : values) size = std::max(size, std::abs(v));
  return size;
}

DifferenceScales::DifferenceScales(const RunRequest& request, const RunResult& motion)
    : span(request.scene.t1 - request.scene.t0), states(motion.state) {
  const Scene& scene = request.scene;
  const std::vector<std::uint32_t>& free = request.code.free;
  const std::size_t n = free.size(), first_order = request.code.layout().first_order_begin();
  for (double& state : states) state = std::abs(state);
  const auto starts_at = [this](std::size_t i, double value) { states[i] = std::max(states[i], std::abs(value)); };
  for (std::size_t i = 0; i < n; ++i) {
    starts_at(i, scene.q[free[i]]);
    starts_at(n + i, scene.qdot[free[i]]);
    if (span > 0) starts_at(n + i, states[i] / span);  // of a motion from rest to rest
  }
  for (std::size_t i = 0; i < scene.z.size() && first_order + i < states.size(); ++i)
    starts_at(first_order + i, scene.z[i]);
}

double DifferenceScales::magnitude(const std::vector<double>& x) const {
  const double typical = largest_magnitude(states), here = largest_magnitude(x);
  if (here > near_zero * typical) return here;
  return typical > 0 ? typical : 1;
}

std::vector<double> derivative_along(const DifferenceScales& scales, double t, const std::vector<double>& x, double dt,
                                     const std::vector<double>& dx, const Described& what,
                                     const FunctionOfState& values) {
  const std::vector<double> middle = values(t, x);
  if (largest_magnitude(dx) == 0 && dt == 0) return std::vector<double>(middle.size(), 0.0);
  const StepScales steps = step_scales(scales, x, dt, dx);
  double step = std::ldexp(1.0, std::ilogb(steps.widest));
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
    if (wider && found.smooth && agree(*wider, found, middle, step, steps)) return wider->value;
    wider.reset();
    if (found.smooth) wider = std::move(found);
  }
  refuse_derivative(what());
}

}  // namespace eomgen::run
