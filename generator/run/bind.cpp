// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/bind.hpp"

#include <algorithm>
#include <stdexcept>

#include "lists.hpp"

namespace eomgen::run {
namespace {

using eom::hybrid::Problem;

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::logic_error("the compiled code has no output '" + name + "'");
  return static_cast<std::size_t>(found - names.begin());
}

/// Indices of outputs by name.
class PlaceOf {
 public:
  explicit PlaceOf(const std::vector<std::string>& names) : names_(names) {}
  std::size_t operator()(const std::string& name) const { return index_of(names_, name); }
  std::vector<std::size_t> operator()(const std::vector<std::string>& names) const {
    return mapped(names, [&](const std::string& name) { return (*this)(name); });
  }
  std::vector<std::vector<std::size_t>> operator()(const std::vector<std::vector<std::string>>& lists) const {
    return mapped(lists, [&](const std::vector<std::string>& names) { return (*this)(names); });
  }

 private:
  const std::vector<std::string>& names_;
};

void bind_outputs(const RunRequest& request, Problem& problem) {
  const PlaceOf place(request.code.output_names);
  problem.kinetic = place("kinetic");
  problem.potential = place("potential");
  problem.energy = place("energy");
  if (request.watch_power) problem.power = place("power");
  problem.redundant = place(request.redundant);
  for (const ConservedOutput& conserved : request.conserved) {
    problem.invariants.push_back({conserved.name, place(conserved.name), {}, conserved.energy});
    if (!conserved.magnitude.empty()) problem.invariants.back().magnitude = place(conserved.magnitude);
  }
  for (const IntegralOutputs& outputs : request.integrals)
    problem.integrals.push_back({place(outputs.psi), place(outputs.slopes)});
  for (const ContactOutputs& outputs : request.contacts) {
    problem.contacts.push_back(
        {place(outputs.slip), place(outputs.slopes), place(outputs.phi), outputs.constraint, {}, {}});
    if (!outputs.restitution.empty()) problem.contacts.back().restitution = place(outputs.restitution);
    if (!outputs.normal_scale.empty()) problem.contacts.back().normal_scale = place(outputs.normal_scale);
  }
}

void bind_start(const RunRequest& request, Problem& problem) {
  const Scene& scene = request.scene;
  for (const std::uint32_t i : request.code.free) problem.start.push_back(scene.q[i]);
  for (const std::uint32_t i : request.code.free) problem.start.push_back(scene.qdot[i]);
  problem.start.insert(problem.start.end(), scene.z.begin(), scene.z.end());
  for (std::size_t i = 0; i < scene.lower.size(); ++i) problem.ranges.push_back({scene.lower[i], scene.upper[i]});
  problem.starts_open = scene.open;
}

void bind_time(const Scene& scene, Problem& problem) {
  problem.inputs = input_signals(scene);
  problem.breakpoints = scene.clock.breakpoints;
  problem.bounds = scene.clock.bounds;
}

}  // namespace

std::vector<eom::hybrid::Signal> input_signals(const Scene& scene) {
  return mapped(scene.inputs, &Signal::runtime_signal);
}

Problem make_problem(const RunRequest& request, const std::string& solver) {
  const Scene& scene = request.scene;
  Problem problem;
  problem.code = &request.code;
  problem.parameters = scene.parameters;
  problem.t0 = scene.t0;
  problem.t1 = scene.t1;
  problem.solver = solver;
  problem.rtol = scene.rtol;
  problem.atol = scene.atol;
  problem.fixed_step = scene.step;
  problem.max_step = scene.max_step;
  problem.max_steps = request.steps_allowed(scene.step > 0);
  problem.events = request.events;
  problem.samples = request.samples;
  problem.charts = request.charts;
  problem.in_charts = request.code_for_charts;
  problem.beyond_range = request.holds_beyond_range;
  problem.state_names = request.state_names;
  problem.constraint_names = request.constraint_names;
  problem.estimate = request.estimate;
  problem.estimate_cost = request.estimate_cost;
  problem.output_interval = request.every;
  problem.row_subdivisions = request.row_subdivisions;
  problem.row = request.row;
  problem.progress = request.progress;
  problem.interrupt = request.interrupt;
  bind_outputs(request, problem);
  bind_start(request, problem);
  bind_time(scene, problem);
  problem.jumps = scene.jumps;
  problem.bounded = request.bounded_functions;
  return problem;
}

}  // namespace eomgen::run
