// SPDX-License-Identifier: GPL-3.0-or-later
// A start that satisfies the constraints. Values that are not given follow from the constraints, if these determine
// them, and are 0 otherwise.
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::run {

struct StartProblem {
  using Key = std::pair<std::uint32_t, std::uint8_t>;  // coordinate, order 0 or 1
  struct Given {
    double value;
    model::Span span;
  };

  mechanics::Mechanics& mechanics;
  const system::EquationSystem& system;
  const model::Scene& scene;
  double t0;
  const std::vector<double>& parameters;
  std::map<Key, Given> given;
  std::map<Key, double> guess;
  struct AngularVelocity {  // the angular velocity of a frame along its own axes, given instead of rates
    std::uint32_t frame;
    std::array<double, 3> value;
    model::Span span;
  };
  std::vector<AngularVelocity> angular_velocities;

  std::vector<double> q, qdot;                 // out: all coordinates
  std::vector<std::string> solved_notes = {};  // out: a sentence for each value that follows from the constraints
  std::vector<bool> open = {};                 // out: per contact, whether it is open
};

/// Computes q and qdot: positions by Newton's method on psi = 0, then rates by A qdot + b = 0. Throws
/// Error{stage "scene"} with the position of the offending value and the violation of the constraint.
void solve_start(StartProblem& problem);

}  // namespace eomgen::run
