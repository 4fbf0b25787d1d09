// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/stress_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "error.hpp"
#include "numeric/numbers.hpp"
#include "pipeline/bound_run.hpp"
#include "run/integration.hpp"
#include "run/project_start.hpp"

namespace eomgen::analysis {
namespace {

using pipeline::DerivedModel;
using stress::Row;
using stress::Verdict;
using LeftOut = std::vector<std::pair<std::string, std::string>>;

constexpr const char* again = "_again";  // ends the name of a repeated constraint

/// The scene of one case, made anew from the model where constants change.
class Variation {
 public:
  Variation(const pipeline::Simulation& simulation, const run::Overrides& overrides)
      : simulation_(simulation), overrides_(overrides) {}

  std::optional<run::Scene> scene(const stress::Case& test, std::string& why) const {
    pipeline::DerivedModel& derived = *simulation_.derived;
    run::Overrides overrides = overrides_;
    for (const auto& [p, factor] : test.factor) {
      overrides.values[derived.model.parameters[p].name] = numeric::exact(simulation_.scene.parameters[p] * factor);
    }
    for (const auto& [p, value] :
         test.value) {  // recomputes dependent values and refuses an inconsistent initial state
      if (std::isfinite(value)) overrides.values[derived.model.parameters[p].name] = numeric::exact(value);
    }
    if (test.rtol) {
      overrides.rtol = *test.rtol;
      overrides.atol = *test.rtol * (simulation_.scene.rtol > 0 ? simulation_.scene.atol / simulation_.scene.rtol : 1);
    }
    run::Scene scene = run::resolve_scene(derived.mechanics, derived.candidates.front(),
                                          derived.model.scene(simulation_.scene.name), overrides);
    for (const auto& [p, value] : test.value) {
      if (!std::isfinite(value)) scene.parameters[p] = value;
    }
    const bool constrained = !derived.mechanics.active.empty();
    std::vector<std::uint32_t> kept;
    for (const auto& [i, value] : test.start) {
      scene.q[i] = value;
      kept.push_back(i);
    }
    for (const std::uint32_t i : derived.mechanics.free) {
      if (test.zero_replacement && scene.q[i] == 0) scene.q[i] = *test.zero_replacement;
      if (test.zero_replacement && scene.qdot[i] == 0) scene.qdot[i] = *test.zero_replacement;
    }
    if (constrained && !kept.empty() &&
        !run::project_start(scene, pipeline::make_run_request(derived, simulation_, scene, false), kept)) {
      why = "the constraints allow no start there";
      return std::nullopt;
    }
    for (double& rate : scene.qdot) rate *= test.speed_factor;
    scene.t1 = scene.t0 + (scene.t1 - scene.t0) * test.span_factor / (test.speed_factor > 1 ? test.speed_factor : 1);
    if (constrained && test.speed_factor != 1 && broken(scene, test.speed_factor)) {
      why = "the constraints move, so that their velocities cannot be multiplied";
      return std::nullopt;
    }
    return scene;
  }

 private:
  bool broken(const run::Scene& scene, double speed) const {
    const run::RunRequest request = pipeline::make_run_request(*simulation_.derived, simulation_, scene, false);
    run::Integration integration(request, run::default_solvers.adaptive);
    const std::vector<double> x = integration.initial_state();
    double largest = 0;
    for (const double v : x) largest = std::max(largest, std::abs(v));
    return integration.constraint_defect(scene.t0, x.data()) >
           run::start_tolerance * std::max(1.0, largest) * std::max(1.0, speed);
  }

  const pipeline::Simulation& simulation_;
  const run::Overrides& overrides_;
};

/// Defect of `repeated`, a model that states constraint `name` of `given` a second time; empty if there is none.
std::string fault_of_repetition(const mechanics::Mechanics& given, const mechanics::Mechanics& repeated,
                                const std::string& name) {
  const auto independent = [](const mechanics::Mechanics& m) { return m.active.size() + m.fixed.size(); };
  if (independent(repeated) != independent(given))
    return fmt::format("a constraint that repeats another counts as a further one: {} independent equations, not {}",
                       independent(repeated), independent(given));
  for (const mechanics::Constraint& constraint : repeated.constraints) {
    // Runs find out whether the motion determines a force that is an input.
    if (constraint.determined && !constraint.force_input &&
        (constraint.name == name || constraint.name == name + again))
      return fmt::format("the force of '{}' counts as determined, though another constraint repeats it",
                         constraint.label);
  }
  return "";
}

/// Each constraint once more under another name. Either the model is refused, or the repeated equations are recognised
/// as redundant.
void repeat_constraints(const model::Model& original, std::vector<Row>& rows, LeftOut& left_out) {
  if (original.constraints.empty()) return;
  const mechanics::Mechanics given = mechanics::build_mechanics(original);
  for (std::size_t c = 0; c < original.constraints.size(); ++c) {
    const std::string& name = original.constraints[c].name;
    if (original.constraints[c].joint) continue;  // its equations may repeat others, and are left out where they do
    model::Model model = original;
    model.constraints.push_back(original.constraints[c]);
    model.constraints.back().name += again;
    model.constraints.back().unit = false;  // the second one is no part of a rotation
    const std::string test = fmt::format("constraint {} twice", name);
    try {
      const std::string fault = fault_of_repetition(given, mechanics::build_mechanics(model), name);
      if (fault.empty())
        left_out.emplace_back(test, "accepted: the repeated equations follow from the others and have no multiplier");
      else
        rows.push_back(
            {.test = test, .solver = "none", .verdict = Verdict::undetected, .outcome = "accepted", .note = fault});
    } catch (const Error& error) {
      left_out.emplace_back(test, "refused: " + error.message());
    }
  }
}

pipeline::SimulationRequest simulation_request(const StressRequest& asked) {
  pipeline::SimulationRequest request;
  request.take(asked);
  request.overrides.solver = run::default_solvers.adaptive;
  request.overrides.step = 0;
  request.with = {"mass"};
  request.every_solver = true;
  request.integrate = false;
  return request;
}

}  // namespace

std::size_t StressFindings::count(Verdict verdict) const {
  return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [verdict](const Row& row) { return row.verdict == verdict; }));
}

StressFindings stress_test(const StressRequest& asked) {
  StressFindings found;
  found.solvers = run::select_solvers("stress", asked.solvers);
  const pipeline::SimulationRequest wanted = simulation_request(asked);
  pipeline::Simulation simulation = pipeline::simulate(wanted);
  simulation.charts.reset();  // all solvers stay in the model's own coordinates
  const work::DeferInterrupt kept;
  found.scene = simulation.scene.name;
  const Variation variation(simulation, wanted.overrides);
  stress::Request request;
  request.run = [&](const run::Scene& scene) {
    return pipeline::make_run_request(*simulation.derived, simulation, scene, true);
  };
  request.solvers = found.solvers;
  request.seconds_limit = asked.max_seconds;
  request.steps_limit = asked.max_steps;
  request.interrupt = asked.interrupt;
  request.progress = asked.progress;
  stress::Auditor auditor(simulation.derived->mechanics, simulation.program);
  request.on_motion = [&](const stress::Case& test, const run::Scene& scene,
                          const std::vector<stress::Sample>& samples) {
    auditor.add_motion(test.name, scene, simulation.code.code_for_run(), samples);
  };
  for (const stress::Case& test : stress::make_cases(simulation.derived->mechanics, simulation.scene, asked.quick)) {
    if (asked.interrupt != nullptr && *asked.interrupt) break;
    std::string why;
    try {
      if (const std::optional<run::Scene> scene = variation.scene(test, why)) {
        for (Row& row : stress::assess(test, *scene, request, why)) found.rows.push_back(std::move(row));
      }
    } catch (const Error& error) {  // a refused value or initial state counts as reported
      if (error.stage() != "scene") throw;
      why = "refused: " + error.message();
    }
    if (!why.empty()) found.left_out.emplace_back(test.name, why);
  }
  repeat_constraints(simulation.derived->model, found.rows, found.left_out);
  found.audit = auditor.audit();
  return found;
}

}  // namespace eomgen::analysis
