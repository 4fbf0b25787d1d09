// SPDX-License-Identifier: GPL-3.0-or-later
// In: one system of equations derived by several routes. Out: the cheapest Program.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "program/program.hpp"
#include "system/equation_system.hpp"

namespace eomgen::program {

struct Request {
  std::vector<std::string>
      with;  // further functions: "jac", "jac_p", "mass", "momenta", "constraints", "reactions", "events", "taylor"
  std::vector<std::string> outputs;  // names of EquationSystem::outputs; any name asks for the function "outputs"
  std::map<std::uint32_t, symbolic::Rational> fix;  // parameters that become numbers
  std::size_t parameters = 0;                       // of the model, for jac_p; 0: as many as the equations mention
  bool optimise = true;                             // false: as derived (for tests and comparisons)
};

/// Ranks the candidates by the raw cost of their right-hand sides, optimises those within 1.5 times of the cheapest,
/// keeps the cheapest (ties: the first), and makes the other functions for it: the right-hand side
/// split into `prepare` and `rhs_prepared` where that is worth it, and those asked for. `Program::tried` lists all
/// candidates. Throws Error for functions and outputs that do not exist or are not supported yet.
Program build_program(std::vector<system::EquationSystem>& candidates, const Request& request);

}  // namespace eomgen::program
