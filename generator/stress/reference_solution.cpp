// SPDX-License-Identifier: GPL-3.0-or-later
#include "stress/reference_solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <eom/registry.hpp>
#include <limits>

namespace eomgen::stress {
namespace {

struct TightSolver {
  const char* name;
  double rtol;
};
constexpr std::array<TightSolver, 4> tight_solvers{{{eom::explicit_rk::Dop853::name, 1e-14},
                                                    {eom::taylor::Series::name, 1e-15},
                                                    {eom::implicit::Radau5::name, 1e-12},
                                                    {eom::implicit::Rodas::name, 1e-11}}};

constexpr double disturbance = 1e-7;   // of the start: large relative to rounding, small relative to nonlinearity
constexpr double bends_within = 1e-2;  // largest disturbance relative to the distance from a chart singularity
constexpr double disturbed_rtol = 1e-13;
constexpr std::size_t sample_count = 32, early_samples = 2;
constexpr double safety_factor = 3;  // the errors of two runs may be larger than their difference
constexpr double most_uncertain = 1e-6;
constexpr double shorter = 0.5;              // next span relative to the span that was reached
constexpr double smallest_component = 1e-9;  // of the largest component

constexpr const char* by_the_clock = "skipped: a tight run exceeds the time limit";

}  // namespace

double distance(const State& a, const State& b, const State& scale) {
  double largest = 0;
  for (std::size_t i = 0; i < scale.size(); ++i) {
    const double d = std::abs(a[i] - b[i]) / scale[i];
    largest = std::isnan(d) ? std::numeric_limits<double>::infinity() : std::max(largest, d);
  }
  return largest;
}

ReferenceSolver::ReferenceSolver(const run::Scene& scene, double whole, double nearness, const Request& request)
    : scene_(scene),
      whole_(whole),
      disturbance_(std::clamp(bends_within * nearness, 4 * unit_roundoff, disturbance)),
      request_(request),
      run_(request.run(scene)) {
  run_.estimate = false;
  run_.watch_power = false;
}

std::optional<ReferenceSolution> ReferenceSolver::solution(std::string& why, double& next_span) {
  const double span = scene_.t1 - scene_.t0;
  ReferenceSolution reference;
  State second;
  std::vector<double> reached;
  for (const TightSolver& solver : tight_solvers) {
    if (!run::check_eligibility(solver.name, scene_, run_.code) || !second.empty()) continue;
    State scale;
    TightRun run = run_tight(solver.name, solver.rtol, nullptr, &scale);
    if (run.late) {  // a faster machine might reach the end: no verdict
      why = by_the_clock;
      next_span = 0;
      return std::nullopt;
    }
    reached.push_back(run.reached);
    if (run.x.empty()) continue;
    if (!reference.x.empty()) {
      second = std::move(run.x);
      continue;
    }
    reference.x = std::move(run.x);
    reference.scale = std::move(scale);
    reference.samples = std::move(run.samples);
    solver_ = solver.name;
    rtol_ = solver.rtol;
  }
  if (second.empty()) {
    std::sort(reached.rbegin(), reached.rend());
    why = fmt::format("no two solvers reach the end with a tight tolerance in {} steps", request_.steps_limit);
    next_span = reached.size() > 1 ? shorter * std::min(1.0, reached[1]) * span : 0;
    return std::nullopt;
  }
  next_span = shorter * span;
  if (!condition(reference)) {
    why = late_ ? by_the_clock : "a slightly disturbed start does not reach the end";
    if (late_) next_span = 0;
    return std::nullopt;
  }
  // The start and every sum are rounded to binary64, even if two runs agree better.
  reference.uncertainty =
      safety_factor * distance(reference.x, second, reference.scale) + unit_roundoff * reference.condition;
  if (reference.growth <= max_condition && reference.uncertainty < most_uncertain) {
    const run::Integration start(run_, solver_);
    reference.samples.insert(reference.samples.begin(), {scene_.t0, start.initial_state(), start.contact_mode()});
    return reference;
  }
  why = fmt::format("disturbances of the start grow by a factor of {:.1e}, and the uncertainty of the end is {:.1e}",
                    reference.growth, reference.uncertainty);
  return std::nullopt;
}

ReferenceSolver::TightRun ReferenceSolver::run_tight(const std::string& solver, double rtol, const State* start,
                                                     State* scale) const {
  run::Scene scene = start != nullptr ? scene_from(*start) : scene_;
  run::RunRequest request = request_.run(scene);
  request.estimate = request.watch_power = false;
  run::Integration integration(request, solver);
  eom::Options options;
  options.rtol = rtol;
  options.atol = rtol * 1e-3;
  options.max_steps = request_.steps_limit;
  TimeLimit clock(request_.seconds_limit, request_.interrupt);
  const State x0 = integration.initial_state();
  if (scale != nullptr) scale->assign(x0.size(), 0);
  TightRun result;
  const eom::Result end = integration.run(options, [&](const eom::StepView& view) {
    sample(view, integration.contact_mode(), result.samples);
    for (std::size_t i = 0; scale != nullptr && i < view.x1.size(); ++i)
      (*scale)[i] = std::max((*scale)[i], std::abs(view.x1[i]));
    return !clock.is_exceeded();
  });
  result.late = clock.was_exceeded();
  result.reached = (end.t - scene.t0) / (scene.t1 - scene.t0);
  if (end.outcome != eom::Outcome::done || result.late) return result;
  if (scale != nullptr) set_scale_floor(*scale, x0);
  result.x.assign(end.x.begin(), end.x.begin() + static_cast<std::ptrdiff_t>(run_.state_names.size()));
  return result;
}

void ReferenceSolver::sample(const eom::StepView& view, const std::vector<int>& mode,
                             std::vector<Sample>& samples) const {
  while (samples.size() < sample_count) {
    const double part = static_cast<double>(samples.size() + 1) / static_cast<double>(sample_count);
    const double t = samples.size() + 1 == sample_count ? scene_.t1 : scene_.t0 + part * (scene_.t1 - scene_.t0);
    if (t > view.t1) return;
    Sample next{t, State(view.x1.begin(), view.x1.end()), mode};
    if (t < view.t1) view.interpolate(t, next.x);
    samples.push_back(std::move(next));
  }
}

// A component that stays 0 has the rounding errors of the others.
void ReferenceSolver::set_scale_floor(State& scale, const State& x0) const {
  scale.resize(run_.state_names.size());
  double largest = 0;
  for (std::size_t i = 0; i < scale.size(); ++i)
    largest = std::max(largest, scale[i] = std::max(scale[i], std::abs(x0[i])));
  for (double& s : scale) s = std::max({s, smallest_component * largest, std::numeric_limits<double>::min()});
  const std::size_t n = run_.code.free.size();
  for (std::size_t i = 0; i < n; ++i) scale[n + i] = std::max(scale[n + i], scale[i] / whole_);
}

run::Scene ReferenceSolver::scene_from(const State& x) const {
  run::Scene scene = scene_;
  const std::vector<std::uint32_t>& free = run_.code.free;
  for (std::size_t i = 0; i < free.size(); ++i) {
    scene.q[free[i]] = x[i];
    scene.qdot[free[i]] = x[free.size() + i];
  }
  std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(run_.code.layout().first_order_begin()), scene.z.size(),
              scene.z.begin());
  return scene;
}

/// The largest effect of several disturbances on the end state; false if one of them cannot be integrated to the end.
bool ReferenceSolver::condition(ReferenceSolution& reference) {
  const State x0 = run::Integration(run_, solver_).initial_state();
  for (const int pattern : {0, 1, 2}) {
    // If this disturbance leaves the chart, the opposite one is tried.
    if (!follow_disturbed(reference, x0, pattern, 1) && (late_ || !follow_disturbed(reference, x0, pattern, -1)))
      return false;
  }
  return true;
}

bool ReferenceSolver::follow_disturbed(ReferenceSolution& reference, const State& x0, int pattern, double sign) {
  State x = x0;
  for (std::size_t i = 0; i < run_.code.layout().size(); ++i) {
    const bool against = pattern > 0 && ((i >> (pattern - 1)) & 1) != 0;
    x[i] += (against ? -sign : sign) * disturbance_ * reference.scale[i];
  }
  const TightRun end = run_tight(solver_, std::max(rtol_, disturbed_rtol), &x, nullptr);
  late_ = late_ || end.late;
  if (end.x.empty() || end.samples.size() != reference.samples.size()) return false;
  double early = 1;
  for (std::size_t k = 0; k < early_samples; ++k)
    early = std::max(early, distance(end.samples[k].x, reference.samples[k].x, reference.scale) / disturbance_);
  const double late = distance(end.x, reference.x, reference.scale) / disturbance_;
  reference.condition = std::max(reference.condition, late);
  reference.growth = std::max(reference.growth, late / early);
  return true;
}

}  // namespace eomgen::stress
