// SPDX-License-Identifier: GPL-3.0-or-later
// Sensitivities of the scenes of the shipped models against central differences of runs. Left out are scenes that do
// not run to their end, large systems, and what `--sensitivity` refuses by name.
#include "analysis/sensitivities.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "error.hpp"
#include "pipeline/bound_run.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

constexpr double rtol = 1e-13, atol = 1e-14;
constexpr double agreement = 1e-5;          // relative; differences of two widths have to agree to a tenth of it
constexpr double decisive = 1e-3;           // a comparison with larger errors counts for nothing
constexpr std::size_t most_directions = 4;  // per scene: parameters together, then starts
constexpr std::size_t most_states = 20, most_states_of_starts = 8;
constexpr std::size_t most_refusals = 3;
constexpr std::size_t most_steps = 10000;  // each difference takes four runs

/// Changes of values by a common factor h.
struct Change {
  std::string name;
  double value, scale;
};
using Direction = std::vector<Change>;

std::vector<std::pair<std::string, std::string>> shipped_scenes() {
  std::set<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(model_path("P1")).parent_path())) {
    const std::string name = file.path().stem().string();
    const bool is_repeated = name.starts_with("R18_euler_") && name != "R18_euler_313";  // by other angles
    if (file.path().extension() == ".toml" && !is_repeated) names.insert(name);
  }
  std::vector<std::pair<std::string, std::string>> scenes;
  for (const std::string& name : names) {
    const auto model = model_at(model_path(name));
    for (const model::Scene& scene : model->scenes) scenes.emplace_back(name, scene.name);
  }
  return scenes;
}

/// Runs scenes. Those of one model that need the same functions share its derivation and its code.
class Simulator {
 public:
  pipeline::Simulation operator()(const std::string& model, const pipeline::SimulationRequest& request) {
    if (model != model_) {
      model_.clear(), compilation_.reset();
      derived_ = pipeline::derive_model(request.model, request.approach, request.form);
      model_ = model;
    }
    const pipeline::RunPlan plan = pipeline::plan_run(*derived_, request);
    if (!compilation_ || plan.functions.with != functions_.with || plan.functions.outputs != functions_.outputs ||
        plan.exchanges_charts != (compilation_->charts != nullptr)) {
      compilation_.reset();
      compilation_ = pipeline::compile_run(*derived_, plan, request);
      functions_ = plan.functions;
    }
    pipeline::Simulation simulation{*compilation_, derived_, plan.scene, {}};
    simulation.result = pipeline::BoundRun(*derived_, simulation, plan.scene, false).integrate(plan, request);
    return simulation;
  }

 private:
  std::string model_;
  std::shared_ptr<pipeline::DerivedModel> derived_;
  program::Request functions_;
  std::optional<pipeline::Compilation> compilation_;
};

class SceneTrial {
 public:
  SceneTrial(Simulator& simulate, const std::string& model, const std::string& scene)
      : name_(model),
        request_(request_of(model, scene)),
        simulation_(simulate(model, request_)),
        states_(pipeline::state_names(*simulation_.derived)) {}

  bool is_done() const { return simulation_.result.outcome == eom::Outcome::done; }
  bool is_small() const { return states_.size() <= most_states; }

  /// How many derivatives were compared. Derivatives that are refused by name, and differences that do not converge,
  /// are not.
  std::size_t compare() {
    const Direction all = independent_parameters();
    std::size_t compared = all.empty() ? 0 : compare(all);
    if (refusals_ > 0) {  // of some of them, or of the motion
      Direction parameters;
      for (const Change& change : all) {
        if (refusals_ > most_refusals) return 0;
        if (sensitivities({change.name})) parameters.push_back(change);
      }
      if (!parameters.empty()) compared += compare(parameters);
    }
    std::size_t directions = 1;
    for (const Change& change : starts()) {
      if (directions == most_directions || states_.size() > most_states_of_starts) break;
      const std::size_t before = refusals_;
      compared += compare(Direction{change});
      if (refusals_ == before) ++directions;
    }
    return compared;
  }

 private:
  static pipeline::SimulationRequest request_of(const std::string& model, const std::string& scene) {
    pipeline::SimulationRequest request;
    request.model = model_at(model_path(model));
    request.scene = scene;
    request.estimate = false;
    request.max_steps = most_steps;
    request.overrides.rtol = rtol;
    request.overrides.atol = atol;
    request.with = analysis::sensitivity_functions(*request.model);
    return request;
  }

  /// Reported by another outcome: four bars pass the configuration in which their constraints are dependent, and the
  /// steps of the stiff bristles are lost in rounding at this tolerance.
  bool has_no_slopes() const { return name_ == "n_four_bar_2" || name_ == "lugre_friction"; }

  std::vector<Change> independent_parameters() const {
    const model::Model& m = *request_.model;
    std::vector<Change> changes;
    for (std::size_t i = 0; i < m.parameters.size(); ++i) {
      if (m.parameters[i].initial_value_of || m.arena[m.parameters[i].value].op != model::Op::number) continue;
      const double value = simulation_.scene.parameters[i], sign = changes.size() % 2 == 0 ? 1 : -1;
      changes.push_back({m.parameters[i].name, value, sign * (value != 0 ? std::abs(value) : 1)});
    }
    return changes;
  }

  std::vector<Change> starts() const {
    const model::Model& m = *request_.model;
    std::vector<Change> changes;
    for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
      changes.push_back({m.coordinates[i].name, simulation_.scene.q[i], 1});
      changes.push_back({m.coordinates[i].name + "_dot", simulation_.scene.qdot[i], 1});
    }
    return changes;
  }

  std::optional<run::Sensitivities> sensitivities(const std::vector<std::string>& names) {
    try {
      return analysis::sensitivities(simulation_, request_, names);
    } catch (const Error&) {
      ++refusals_;
      return std::nullopt;
    }
  }

  std::optional<std::vector<double>> end(const Direction& direction, double h) {
    run::Overrides overrides = request_.overrides;
    for (const Change& change : direction)
      overrides.values[change.name] = cln::rational(cln::cl_float(change.value + h * change.scale));
    try {
      const run::RunResult result = pipeline::rerun(simulation_, overrides, false);
      if (result.outcome != eom::Outcome::done || result.events.size() != simulation_.result.events.size())
        return std::nullopt;
      return std::vector<double>(result.state.begin(),
                                 result.state.begin() + static_cast<std::ptrdiff_t>(states_.size()));
    } catch (const Error&) {
      return std::nullopt;
    }
  }

  std::optional<std::vector<double>> difference(const Direction& direction, double h) {
    const auto up = end(direction, h), down = end(direction, -h);
    if (!up || !down) return std::nullopt;
    std::vector<double> slopes;
    for (std::size_t i = 0; i < up->size(); ++i) slopes.push_back(((*up)[i] - (*down)[i]) / (2 * h));
    return slopes;
  }

  std::size_t compare(const Direction& direction) {
    std::vector<std::string> names;
    for (const Change& change : direction) names.push_back(change.name);
    request_.estimate = true;
    const std::optional<run::Sensitivities> found = sensitivities(names);
    request_.estimate = false;
    if (!found) return 0;
    CAPTURE(names.front());
    if (found->outcome == eom::Outcome::max_steps) return 0;
    CHECK((found->outcome == eom::Outcome::done || has_no_slopes()));
    if (found->outcome != eom::Outcome::done) return 0;
    std::vector<double> expected(states_.size()), error(states_.size());
    for (std::size_t k = 0; k < direction.size(); ++k) {
      for (std::size_t i = 0; i < states_.size(); ++i) {
        expected[i] += direction[k].scale * found->list[k].value[i];
        error[i] += std::abs(direction[k].scale * found->list[k].error[i]);
      }
    }
    std::size_t compared = 0;
    std::vector<bool> open(states_.size(), true);
    for (const double h : {1e-4, 1e-5, 1e-6}) {
      const auto wide = difference(direction, h), narrow = difference(direction, h / 3);
      if (!wide || !narrow) continue;
      double largest = 0, largest_state = 0;
      for (const double state : simulation_.result.state) largest_state = std::max(largest_state, std::abs(state));
      const double noise = 10 * rtol * largest_state / h;  // of runs
      for (const double slope : *narrow) largest = std::max(largest, std::abs(slope));
      for (std::size_t i = 0; i < states_.size(); ++i) {
        const double scale = std::max(std::abs((*narrow)[i]), 1e-3 * largest) + 1e-6;
        if (!open[i] || std::abs((*wide)[i] - (*narrow)[i]) > 0.1 * agreement * scale) continue;
        CAPTURE(states_[i]);
        CAPTURE(h);
        CAPTURE(expected[i]);
        CHECK(std::abs((*narrow)[i] - expected[i]) <= agreement * scale + error[i] + noise);
        open[i] = false;
        if (error[i] + noise <= decisive * std::max(1.0, std::abs((*narrow)[i]))) ++compared;
      }
      if (std::none_of(open.begin(), open.end(), [](bool b) { return b; })) break;
    }
    return compared;
  }

  std::string name_;
  pipeline::SimulationRequest request_;
  pipeline::Simulation simulation_;
  std::vector<std::string> states_;
  std::size_t refusals_ = 0;
};

}  // namespace

TEST_CASE("sensitivities: those of the shipped scenes agree with central differences of runs") {
  Simulator simulate;
  std::size_t scenes = 0, without_end = 0, large = 0, without_slopes = 0, compared = 0;
  for (const auto& [model, scene] : shipped_scenes()) {
    CAPTURE(model);
    CAPTURE(scene);
    ++scenes;
    std::optional<SceneTrial> trial;
    try {
      trial.emplace(simulate, model, scene);
    } catch (const Error&) {  // nothing is left to integrate, or the start is singular: shipped for other commands
      ++without_end;
      continue;
    }
    if (!trial->is_done()) {
      ++without_end;
    } else if (!trial->is_small()) {
      ++large;
    } else if (const std::size_t n = trial->compare(); n > 0) {
      compared += n;
    } else {
      ++without_slopes;
    }
  }
  // Those that end by another outcome, or take too many steps; those that slide in two directions, or whose contacts
  // change in an order that depends on the values.
  CHECK(without_end <= scenes / 10);
  CHECK(large <= scenes / 20);
  CHECK(without_slopes <= scenes / 6);
  CHECK(compared >= 11 * scenes);
}
