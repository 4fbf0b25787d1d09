// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse dynamics: forces that prescribed motions require, over time. If every coordinate is prescribed they are
// evaluated directly, otherwise along an integrated motion.
#pragma once

#include <functional>
#include <span>

#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

struct InverseRequest : pipeline::SceneRequest {
  std::vector<std::string> constraints;  // by name or label; empty: all of the form q = f(t)
  std::size_t max_steps = 0;
  /// Called before the first row with the names of its values: coordinates, rates, forces, outputs of the scene.
  std::function<void(const run::Scene& scene, const std::vector<std::string>& columns)> begin;
  std::function<void(double t, std::span<const double> values)> row;
  const std::atomic<bool>* interrupt = nullptr;
};

struct InverseDynamicsResult {
  std::vector<std::string> columns, forces;  // `forces`: the columns that are requested forces
  eom::Outcome outcome = eom::Outcome::done;
  std::string detail, certificate;
};

/// Throws Error{stage "inverse"} if no constraint prescribes a motion, or for an unknown name.
InverseDynamicsResult inverse_dynamics(const InverseRequest& request);

}  // namespace eomgen::analysis
