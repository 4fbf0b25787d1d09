// SPDX-License-Identifier: GPL-3.0-or-later
// In: a scene of the model and what the command line overrides. Out: numbers: parameters, time span, a start that
// satisfies the constraints, tolerances, inputs, the columns that are wanted.
#pragma once

#include <cln/real.h>

#include <eom/hybrid/clock.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "run/signal.hpp"
#include "system/equation_system.hpp"

namespace eomgen::run {

/// What `run` takes from the command line in place of the scene's values.
struct Overrides {
  std::map<std::string, symbolic::Rational> values;  // of parameters; of coordinates and rates at the start
  std::optional<double> t_end, rtol, atol, step, max_step, every;
  std::optional<std::string> solver;
  std::vector<std::string> outputs;  // in place of the scene's, unless empty
  bool at_start = false;             // t_end may be the start: nothing moves then
  bool exchanges_charts = false;     // a start where coordinates fail is no error: the run goes on in other ones
};

struct Scene {
  // Defined once: every file that holds one would compile them anew.
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
  std::vector<double> lower, upper;  // open range of each coordinate; infinite where there is none
  std::string solver;                // as asked for; may be "auto"
  double rtol = 1e-9, atol = 1e-12;
  double step = 0, every = 0;        // 0: not given
  double max_step = 0;               // of chosen steps; 0: not bounded
  std::vector<Signal> inputs;        // one per input of the model
  eom::hybrid::TimeFunctions time;   // functions of time alone
  eom::hybrid::Clock clock;          // what they do in the span of the run
  eom::hybrid::JumpFunctions jumps;  // where something may jump; empty: nowhere
  std::vector<std::string> outputs;  // expanded, without the coordinates, each once
  std::vector<bool> stops;           // per event of the model: whether it ends the run
  std::vector<bool> apart;           // per contact: whether it does not touch at the start
  std::vector<std::string> solved;   // sentences: what followed from the constraints
};

/// The coordinate (order 0) or its rate (1) whose start has this name, "theta" or "theta_dot".
std::optional<std::pair<std::uint32_t, std::uint8_t>> start_named(const model::Model& model, const std::string& name);

inline constexpr double start_tolerance = 1e-8;  // relative; the contract's

/// Throws Error{stage "scene"}: an unknown name, a value that does not exist, a start that breaks a constraint.
Scene resolve_scene(mechanics::Mechanics& mechanics, const system::EquationSystem& system, const model::Scene& scene,
                    const Overrides& overrides);

/// Parameters of a scene in many digits. `moved`: those that are plain numbers are each multiplied by a number near 1
/// that it chooses (what is 0 stays 0), and those that are computed from them follow.
std::vector<cln::cl_R> exact_parameters(mechanics::Mechanics& mechanics, const model::Scene& scene,
                                        const Overrides& overrides, int digits,
                                        std::optional<std::uint64_t> moved = {});

/// Names of all outputs that can be asked for: those of the system, vectors and reactions by their parts.
std::vector<std::string> expand_outputs(const mechanics::Mechanics& mechanics, const system::EquationSystem& system,
                                        const std::vector<model::Named>& wanted);

}  // namespace eomgen::run
