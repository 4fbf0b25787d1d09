// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse dynamics: the forces that prescribed motions need, over time. Evaluated where every coordinate is prescribed,
// along a run where some are free.
#pragma once

#include <functional>
#include <span>

#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

struct InverseRequest {
  std::shared_ptr<const model::Model> model;
  std::string scene = "default";
  run::Overrides overrides;
  std::vector<std::string> constraints;  // by name or label; empty: those that read q = f(t)
  std::size_t max_steps = 0;
  std::uint64_t seed = 1;
  /// Before the first row, with the names of its values: coordinates, rates, the forces, what the scene asks for.
  std::function<void(const run::Scene& scene, const std::vector<std::string>& columns)> begin;
  std::function<void(double t, std::span<const double> values)> row;
  const std::atomic<bool>* interrupt = nullptr;
};

struct InverseAnswer {
  std::vector<std::string> columns, forces;  // those of `columns` that were asked for
  eom::Outcome outcome = eom::Outcome::done;
  std::string detail, certificate;
};

/// Throws Error{stage "inverse"}: no constraint prescribes a motion, an unknown name.
InverseAnswer inverse_dynamics(const InverseRequest& request);

}  // namespace eomgen::analysis
