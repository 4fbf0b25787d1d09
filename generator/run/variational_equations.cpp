// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/variational_equations.hpp"

#include <fmt/format.h>

#include <tuple>

#include "error.hpp"
#include "run/bind.hpp"
#include "run/derivative_run.hpp"

namespace eomgen::run {

using eom::hybrid::Problem;

Problem problem_in(const Scene& scene, Problem problem) {
  problem.parameters = scene.parameters;
  problem.inputs = input_signals(scene);
  problem.breakpoints = scene.clock.breakpoints;
  problem.bounds = scene.clock.bounds;
  for (std::size_t i = 0; i < problem.samples.size(); ++i)
    std::tie(problem.samples[i].every, problem.samples[i].offset) = scene.samples[i];
  problem.t0 = scene.t0;
  problem.t1 = scene.t1;
  return problem;
}

Problem problem_of(const RunRequest& request, const std::string& solver) {
  Problem problem = make_problem(request, solver);
  problem.power.reset();  // the work is not part of the state here
  return problem;
}

std::vector<DueSample> due_samples(const Problem& problem, double from, double until) {
  std::vector<DueSample> due;
  for (std::size_t i = 0; i < problem.samples.size(); ++i) {
    if (const auto k = eom::hybrid::sample_between(problem.samples[i], from, until)) due.push_back({i, *k});
  }
  return due;
}

void take_samples(VariationalEquations& in, const std::vector<DueSample>& due, double t, std::vector<double>& x) {
  const eom::ModeArray mode = in.context.model.mode();
  std::vector<int> sides(in.problem.events.size(), 0);
  in.resets.crossed(sides, in.resets.event_values(t, x.data()));
  for (const DueSample& sample : due) {
    if (in.resets.take_sample(sample.kind, sample.k, t, x, {}))
      refuse_derivative(
          fmt::format("the sample '{}' at t = {} is undetermined", in.problem.samples[sample.kind].name, t));
  }
  const std::vector<std::size_t> caused = in.resets.crossed(sides, in.resets.event_values(t, x.data()));
  const eom::hybrid::Resets::Changes made = in.resets.occur(caused, sides, t, x, {});
  in.context.model.set_mode(mode);
  if (made.failed || made.stopped)
    refuse_derivative(fmt::format("the sample at t = {} causes an event that {}", t,
                                  made.failed ? "is undetermined" : "ends the run"));
}

void apply_reset(VariationalEquations& in, std::size_t i, double t, std::vector<double>& x) {
  const eom::ModeArray mode = in.context.model.mode();
  std::vector<int> sides(in.problem.events.size(), 0);
  in.resets.crossed(sides, in.resets.event_values(t, x.data()));
  sides[i] = 0;
  const eom::hybrid::Resets::Changes made = in.resets.occur({i}, sides, t, x, {});
  in.context.model.set_mode(mode);
  if (made.failed)
    refuse_derivative(fmt::format("the event '{}' at t = {} is undetermined", in.problem.events[i].name, t));
}

}  // namespace eomgen::run
