// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/bind.hpp"

#include <algorithm>
#include <stdexcept>

#include "run/jumps.hpp"

namespace eomgen::run {
namespace {

using eom::hybrid::Place;
using eom::hybrid::Problem;
using eom::hybrid::Sampling;

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::logic_error("the compiled code has no output '" + name + "'");
  return static_cast<std::size_t>(found - names.begin());
}

/// Places of outputs by their names.
class PlaceOf {
 public:
  explicit PlaceOf(const std::vector<std::string>& names) : names_(names) {}
  std::size_t operator()(const std::string& name) const { return index_of(names_, name); }
  std::vector<std::size_t> operator()(const std::vector<std::string>& names) const {
    std::vector<std::size_t> places;
    for (const std::string& name : names) places.push_back((*this)(name));
    return places;
  }
  std::vector<std::vector<std::size_t>> operator()(const std::vector<std::vector<std::string>>& lists) const {
    std::vector<std::vector<std::size_t>> places;
    for (const std::vector<std::string>& names : lists) places.push_back((*this)(names));
    return places;
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
        {place(outputs.slip), place(outputs.slopes), place(outputs.phi), outputs.constraint, {}});
    if (!outputs.restitution.empty()) problem.contacts.back().restitution = place(outputs.restitution);
  }
}

void bind_start(const RunRequest& request, Problem& problem) {
  const Scene& scene = request.scene;
  for (const std::uint32_t i : request.code.free) problem.start.push_back(scene.q[i]);
  for (const std::uint32_t i : request.code.free) problem.start.push_back(scene.qdot[i]);
  for (std::size_t i = 0; i < scene.lower.size(); ++i) problem.ranges.push_back({scene.lower[i], scene.upper[i]});
  problem.apart = scene.apart;
}

void bind_time(const Scene& scene, Problem& problem) {
  for (const Signal& signal : scene.inputs) {
    if (signal.jumps().empty())
      problem.inputs.push_back({[signal](double t) { return signal(t, t); }, {}, {}});
    else
      problem.inputs.push_back({{}, signal.jumps(), signal.values()});
  }
  problem.breaks = scene.clock.breaks;
  problem.bounds = scene.clock.bounds;
}

void bind_jumps(const std::shared_ptr<Jumps>& jumps, Problem& problem) {
  if (!jumps) return;
  if (jumps->by_time())
    problem.jumps.at_time = [jumps](const Place& before, double after, const double* u_after, std::span<double> x) {
      return jumps->cross(before, after, u_after, x);
    };
  problem.jumps.surfaces = jumps->surfaces();
  problem.jumps.values = [jumps](const Place& at, double* g) { jumps->values(at, g); };
  problem.jumps.across = [jumps](const Place& at, std::size_t surface) { return jumps->cross(at, surface); };
}

/// By reference: expressions as code are large, and what they find out is asked of the request.
void bind_bounds(const RunRequest& request, Problem& problem) {
  if (request.ranges.any())
    problem.bounded.hidden = [&ranges = request.ranges](const eom::StepView& step, std::size_t i, int side, double from,
                                                        double to, const Sampling& sampling) {
      return ranges.first(step, i, side, from, to, sampling.inputs);
    };
  if (!request.narrow.any()) return;
  problem.bounded.longest = [&narrow = request.narrow](const eom::StepView& step, const Sampling& sampling) {
    return narrow.longest(step, sampling);
  };
  problem.bounded.unsure = [&narrow = request.narrow] { return narrow.unsure(); };
}

}  // namespace

Problem problem_of(const RunRequest& request, const std::string& solver) {
  const Scene& scene = request.scene;
  Problem problem;
  problem.code = &request.code;
  problem.parameters = scene.parameters;
  problem.t0 = scene.t0;
  problem.t1 = scene.t1;
  problem.solver = solver;
  problem.rtol = scene.rtol;
  problem.atol = scene.atol;
  problem.step = scene.step;
  problem.max_step = scene.max_step;
  problem.max_steps = request.steps_allowed(scene.step > 0);
  problem.events = request.events;
  problem.charts = request.charts;
  problem.in_charts = request.in_charts;
  problem.beyond_range = request.beyond_range;
  problem.state_names = request.state_names;
  problem.constraint_names = request.constraint_names;
  problem.estimate = request.estimate;
  problem.every = request.every;
  problem.row = request.row;
  problem.progress = request.progress;
  problem.interrupt = request.interrupt;
  bind_outputs(request, problem);
  bind_start(request, problem);
  bind_time(scene, problem);
  bind_jumps(scene.jumps, problem);
  bind_bounds(request, problem);
  return problem;
}

}  // namespace eomgen::run
