// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/sensitivities.hpp"

#include <cln/rational.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/names.hpp"
#include "numeric/numbers.hpp"

namespace eomgen::analysis {
namespace {

using pipeline::DerivedModel;
using pipeline::Simulation;
using pipeline::SimulationRequest;

constexpr int halvings = 4;      // of the step: extrapolation to central differences of order 2, 4, 6, 8
constexpr long first_part = 32;  // the first step is the parameter divided by this

/// Vector of the parameters, then the initial state.
std::vector<double> values_of(const run::Scene& scene, const run::Code& code, std::size_t states) {
  std::vector<double> values = scene.parameters;
  for (const std::uint32_t i : code.free) values.push_back(scene.q[i]);
  for (const std::uint32_t i : code.free) values.push_back(scene.qdot[i]);
  values.resize(scene.parameters.size() + states);  // integrals over time start at 0
  return values;
}

class Directions {
 public:
  Directions(const Simulation& simulation, const SimulationRequest& request, std::size_t states)
      : simulation_(simulation), request_(request), code_(simulation.code.code_for_run()), states_(states) {}

  run::Direction of(const std::string& name, const std::vector<std::string>& state_names) const {
    const model::Model& model = simulation_.derived->model;
    const auto is_named = [&](const model::Parameter& p) { return p.name == name; };
    const auto parameter = std::find_if(model.parameters.begin(), model.parameters.end(), is_named);
    if (parameter != model.parameters.end())
      return by_parameter(static_cast<std::size_t>(parameter - model.parameters.begin()));
    const auto state = std::find(state_names.begin(), state_names.end(), name);
    if (state != state_names.end()) return by_start(static_cast<std::size_t>(state - state_names.begin()), name);
    for (const model::Coordinate& c : model.coordinates) {
      if (name == c.name || name == c.name + "_dot")
        refuse("the start of " + name + " follows from other values", "ask for one of those that it follows from");
    }
    std::vector<std::string> known = state_names;
    for (const model::Parameter& p : model.parameters) known.push_back(p.name);
    refuse("there is no parameter or coordinate '" + name + "'", model::suggest_choice(name, known));
  }

 private:
  [[noreturn]] static void refuse(const std::string& what, const std::string& remedy) {
    throw Error("run", {}, "--sensitivity: " + what, remedy);
  }

  run::Direction by_start(std::size_t state, const std::string& name) const {
    if (code_.active_constraints > 0)
      refuse("constraints couple the initial values, so that one alone cannot change",
             "ask for parameters, and write the start by them");
    if (state >= 2 * code_.free.size())
      refuse(name + " is an integral over time, 0 at the start", "ask for a coordinate");
    const double value = values_of(simulation_.scene, code_, states_)[simulation_.scene.parameters.size() + state];
    run::Direction d{name, value != 0 ? std::abs(value) : 1.0, std::vector<double>(simulation_.scene.parameters.size()),
                     std::vector<double>(states_)};
    d.dx[state] = 1;
    return d;
  }

  /// Derivatives of dependent parameters and of the initial state, by differences of their smooth values in the scene.
  run::Direction by_parameter(std::size_t index) const {
    const model::Parameter& parameter = simulation_.derived->model.parameters[index];
    const run::Scene& scene = simulation_.scene;
    const double value = scene.parameters[index], scale = value != 0 ? std::abs(value) : 1.0;
    std::array<std::vector<double>, halvings> table;
    for (int k = 0; k < halvings; ++k) {
      const cln::cl_RA part = cln::cl_RA(1) / (first_part << k);
      const std::vector<double> above = changed(parameter.name, value, scale, part),
                                below = changed(parameter.name, value, scale, -part);
      const double distance = above[index] - below[index];
      for (std::size_t i = 0; i < above.size(); ++i)
        table[static_cast<std::size_t>(k)].push_back((above[i] - below[i]) / distance);
    }
    double factor = 1;
    for (std::size_t level = 1; level < halvings; ++level) {  // Richardson's extrapolation
      factor *= 4;
      for (std::size_t k = halvings - 1; k >= level; --k) {
        for (std::size_t i = 0; i < table[k].size(); ++i) table[k][i] += (table[k][i] - table[k - 1][i]) / (factor - 1);
      }
    }
    const std::vector<double>& slopes = table[halvings - 1];
    const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(scene.parameters.size());
    return {parameter.name, scale, {slopes.begin(), middle}, {middle, slopes.end()}};
  }

  std::vector<double> changed(const std::string& name, double value, double scale, const cln::cl_RA& part) const {
    DerivedModel& derived = *simulation_.derived;
    run::Overrides overrides = request_.overrides;
    overrides.values[name] = numeric::exact(value) + numeric::exact(scale) * part;
    try {
      return values_of(run::resolve_scene(derived.mechanics, derived.candidates.front(),
                                          derived.model.scene(request_.scene), overrides),
                       code_, states_);
    } catch (const Error& error) {
      refuse(fmt::format("the scene does not follow a change of {}: {}", name, error.message()),
             "write the start by " + name + ", or leave values to the constraints");
    }
  }

  const Simulation& simulation_;
  const SimulationRequest& request_;
  run::Code code_;
  std::size_t states_;
};

}  // namespace

run::Sensitivities sensitivities(const Simulation& simulation, const SimulationRequest& request,
                                 const std::vector<std::string>& names) {
  const run::Code code = simulation.code.code_for_run();
  const run::RunRequest run = [&] {
    run::RunRequest made = pipeline::make_run_request(*simulation.derived, simulation.scene, code, false);
    made.interrupt = request.interrupt;
    made.max_steps = request.max_steps;
    return made;
  }();
  for (const run::KinkCrossings& kink : simulation.result.kinks) {
    if (kink.count > 0)
      throw Error(
          "run", {},
          fmt::format("--sensitivity: the run crosses a kink ({}), where derivatives of the end may jump", kink.kink),
          "shorten the run (--t-end), or smooth the law");
  }
  const Directions directions(simulation, request, run.state_names.size());
  std::vector<run::Direction> wanted;
  for (const std::string& name : names) wanted.push_back(directions.of(name, run.state_names));
  return run::integrate_sensitivities(run, simulation.result.solver, simulation.result.t, wanted, request.estimate);
}

}  // namespace eomgen::analysis
