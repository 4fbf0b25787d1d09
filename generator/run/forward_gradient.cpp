// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/forward_gradient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "run/central_differences.hpp"
#include "run/derivative_run.hpp"
#include "run/directional_derivative.hpp"
#include "run/variational_jumps.hpp"

namespace eomgen::run {

ForwardGradientRun::ForwardGradientRun(const RunRequest& request, const RunResult& motion, const std::string& solver,
                                       const std::vector<Direction>& directions,
                                       const std::vector<std::string>& outputs)
    : state_names_(request.state_names),
      directions_(directions),
      outputs_(outputs),
      n_(request.state_names.size()),
      variational_(request, motion, solver, directions),
      y_(request.code.output_names.size()) {}

eom::Result ForwardGradientRun::operator()(const eom::Options& options) {
  const eom::Result end = variational_(options);
  eom::Result result = end;
  result.x.resize(n_);
  if (end.outcome != eom::Outcome::done) return result;
  const std::vector<double> own = result.x;
  for (const std::string& output : outputs_) {
    result.x.push_back(value_of(output, variational_.jumps().equations(), end.t, own));
    for (std::size_t d = 0; d < directions_.size(); ++d) result.x.push_back(slope(output, d, end));
  }
  return result;
}

/// The derivative along the state at the moving end, and that by the scene at fixed t and x.
double ForwardGradientRun::slope(const std::string& output, std::size_t d, const eom::Result& end) {
  const Direction& direction = directions_[d];
  const auto first = end.x.begin() + static_cast<std::ptrdiff_t>(n_ * (d + 1));
  std::vector<double> s(first, first + static_cast<std::ptrdiff_t>(n_));
  for (double& value : s) value /= direction.scale;
  const auto state = std::find(state_names_.begin(), state_names_.end(), output);
  if (state != state_names_.end()) return s[static_cast<std::size_t>(state - state_names_.begin())];
  VariationalJumps& jumps = variational_.jumps();
  const double dt = end.x[n_ * (directions_.size() + 1) + d] / direction.scale;
  const std::vector<double> own(end.x.begin(), end.x.begin() + static_cast<std::ptrdiff_t>(n_));
  const auto what = [&] {
    return fmt::format("the output '{}' at the end does not change smoothly with {}", output, direction.name);
  };
  const double along =
      derivative_along(jumps.scales(), end.t, own, dt, s, what, [&](double t, const std::vector<double>& x) {
        return std::vector<double>{value_of(output, jumps.equations(), t, x)};
      })[0];
  std::vector<std::vector<double>> beside;
  for (const auto& neighbour : jumps.neighbours(d, NeighbourInputs::of_same_times))
    beside.push_back({value_of(output, jumps.in_segment(*neighbour), end.t, own)});
  const Slopes by_scene = slopes({value_of(output, jumps.equations(), end.t, own)}, beside, direction.step);
  if (!by_scene.smooth) refuse_derivative(what());
  return along + by_scene.value[0];
}

/// NaN: it has no value.
double ForwardGradientRun::value_of(const std::string& output, VariationalEquations& in, double t,
                                    const std::vector<double>& x) {
  const auto state = std::find(state_names_.begin(), state_names_.end(), output);
  if (state != state_names_.end()) return x[static_cast<std::size_t>(state - state_names_.begin())];
  if (in.context.outputs(t, x.data(), y_) != 0) return std::nan("");
  const std::vector<std::string>& names = in.problem.code->output_names;
  return y_[static_cast<std::size_t>(std::find(names.begin(), names.end(), output) - names.begin())];
}

}  // namespace eomgen::run
