// SPDX-License-Identifier: GPL-3.0-or-later
// A direction of change for sensitivities: a parameter, or a value of the start. In: the model, the scene of a run, a
// name. Out: derivatives of everything in the scene that a run depends on, as differences of scenes in which the value
// is changed (`--set NAME=..`), so that whatever follows from it changes too.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "run/scene.hpp"

namespace eomgen::run {

struct Direction {
  std::string name;
  double scale = 1;           // the size of the changed value: the error control sees derivatives times this
  double step = 0;            // of the differences
  std::vector<Scene> beside;  // the scene with the value changed by difference_offsets(step)
  std::vector<double> dp;     // of the parameters of the model, dependent ones too
  std::vector<double> dx;     // of the start, per state
  double dt0 = 0, dt1 = 0;    // of the span
  std::vector<double> dt;     // of the times in kink_times()
  std::vector<Signal> du;     // of the inputs at fixed t; empty: none depends on the value
  std::function<Scene(double offset)> changed = {};  // the scene with the value changed by any other offset
};

/// The model and scene that a direction refers to.
struct ModelScene {
  mechanics::Mechanics& mechanics;
  const system::EquationSystem& system;
  const model::Scene& asked;
  const Overrides& overrides;
  const Scene& scene;                      // the resolved one
  const std::vector<std::uint32_t>& free;  // coordinates in the state
  std::size_t states;
};

/// What `of` refers to has to outlive the direction. The direction of a parameter or of a value of the start ("theta",
/// "theta_dot", a state of first order). Throws Error{stage "run"} if the scene does not follow a change of it, or not
/// smoothly.
Direction find_direction(const ModelScene& of, const std::string& name);

/// Times inside the span of a scene at which an input or a function of time jumps or bends, or a sample is taken:
/// before and after.
std::vector<eom::hybrid::Breakpoint> kink_times(const Scene& scene);

}  // namespace eomgen::run
