// SPDX-License-Identifier: GPL-3.0-or-later
// In: a scene of the model and the overrides of the command line. Out: numbers: parameters, time span, a start that
// satisfies the constraints, tolerances, inputs, the requested columns.
#pragma once

#include <cln/real.h>

#include <eom/hybrid/time_analysis.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "run/scene_tables.hpp"
#include "run/signal.hpp"
#include "system/equation_system.hpp"

namespace eomgen::run {

/// Values from the command line that replace those of the scene.
struct Overrides {
  std::map<std::string, symbolic::Rational> values;  // of parameters; initial values of coordinates, rates and states
  std::optional<double> t_end, rtol, atol, step, max_step, every;
  std::optional<std::string> solver;
  std::vector<std::string> outputs;  // replace those of the scene, unless empty
  bool allow_empty_span = false;     // t_end may be the start: nothing moves then
  bool can_exchange_charts = false;  // a start at a chart singularity is no error: the run uses other charts
};

struct Scene {
  // Defined in the .cpp file, so that they are compiled only once.
  Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  std::string name;
  std::vector<double> parameters;  // all of the model, in order; dependent ones computed
  double t0 = 0, t1 = 0;
  std::vector<double> q, qdot;       // all coordinates of the model
  std::vector<double> z;             // states of first order, per EquationSystem::states
  std::vector<double> lower, upper;  // open range of each coordinate; infinite if there is none
  std::string solver;                // as requested; may be "auto"
  double rtol = 1e-9, atol = 1e-12;
  double step = 0, every = 0;                      // 0: not given
  double max_step = 0;                             // of adaptive steps; 0: not bounded
  std::vector<Signal> inputs;                      // one per input of the model
  eom::hybrid::TimeFunctions time;                 // functions of time alone
  eom::hybrid::TimeAnalysis clock;                 // their properties in the span of the run
  eom::hybrid::JumpFunctions jumps;                // functions that may jump; empty: none
  std::vector<std::string> outputs;                // expanded, without the coordinates, each once
  std::vector<bool> ends_run;                      // per event of the model: whether it ends the run
  std::vector<std::pair<double, double>> samples;  // per sample of the model: its period and offset, s
  std::vector<bool> open;                          // per contact: whether it is open at the start
  std::vector<std::string> solved_notes;           // sentences about values that follow from the constraints
};

/// The coordinate (order 0) or rate (order 1) with this name, "theta" or "theta_dot".
std::optional<std::pair<std::uint32_t, std::uint8_t>> find_start(const model::Model& model, const std::string& name);

/// The declared state of first order with this name, in Model::states.
std::optional<std::uint32_t> find_state(const model::Model& model, const std::string& name);
/// Whether a value of this name sets the start: of a coordinate, a rate or a state.
bool is_start_value(const model::Model& model, const std::string& name);

/// Names of all coordinates, each followed by its rate, then of the declared states of first order.
std::vector<std::string> state_columns(const model::Model& model);

inline constexpr double start_tolerance = 1e-8;  // relative; the contract's

/// Resolves a scene. Throws Error{stage "scene"} for an unknown name, an undefined value, or a start that violates a
/// constraint.
Scene resolve_scene(mechanics::Mechanics& mechanics, const system::EquationSystem& system, const model::Scene& scene,
                    const Overrides& overrides);
/// The same with the tables of earlier runs.
Scene resolve_scene(mechanics::Mechanics& mechanics, const system::EquationSystem& system, const model::Scene& scene,
                    const Overrides& overrides, SceneTables& tables);

/// Parameters of a scene in many digits. With a seed `moved` each independent parameter is multiplied by a random
/// number near 1 (0 stays 0), and dependent parameters are computed from them.
std::vector<cln::cl_R> exact_parameters(mechanics::Mechanics& mechanics, const model::Scene& scene,
                                        const Overrides& overrides, int digits,
                                        std::optional<std::uint64_t> moved = {});

/// Names of the requested outputs, with vectors and reactions expanded into components.
std::vector<std::string> expand_outputs(const mechanics::Mechanics& mechanics, const system::EquationSystem& system,
                                        const std::vector<model::OutputReference>& wanted);

}  // namespace eomgen::run
