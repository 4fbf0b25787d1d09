// SPDX-License-Identifier: GPL-3.0-or-later
// In: one system of equations, derived by several formulations. Out: the cheapest Program.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/program.hpp"
#include "system/equation_system.hpp"
#include "system/frame.hpp"
#include "system/inertia.hpp"

namespace eomgen::program {

struct Request {
  std::vector<std::string> with;     // further functions: abi::optional_functions()
  std::vector<std::string> outputs;  // names of EquationSystem::outputs; if not empty, "outputs" is built
  std::map<std::uint32_t, symbolic::Rational> fix;  // values that replace parameters
  std::size_t parameters = 0, inputs = 0;           // count in the model, for jac_p, jac_u; 0: those in the equations
  /// Derives the residual of trees, for derivatives by it. Empty: derivatives from M and f only.
  std::function<std::optional<system::Residual>()> residual = {};
  /// Derives the forces between links that `articulated` solves for, for derivatives by them. Empty: the same.
  std::function<std::optional<system::InternalForces>()> forces = {};
  /// Derives the motions of bodies, particles and points, for the function `frames`. Empty: it has no frames.
  std::function<std::vector<system::Frame>()> frames = {};
  /// Derives the masses and inertias of bodies and particles. Empty: `regressor` and `momentum` have none.
  std::function<system::Inertias()> inertias = {};
  bool optimise = true;  // false: code as derived (for tests and comparisons)
};

/// Ranks the candidates by the unoptimised cost of their right-hand sides. Optimises those within 1.5 times of the
/// cheapest and keeps the cheapest result (ties: the first). Builds the other functions for that candidate: the
/// requested ones, and `prepare` and `rhs_prepared` if the split pays off. `Program::candidates` lists all candidates.
/// Throws Error for unknown or unsupported functions and outputs.
Program build_program(std::vector<system::EquationSystem>& candidates, const Request& request);

}  // namespace eomgen::program
