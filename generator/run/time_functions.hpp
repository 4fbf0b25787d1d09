// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of time alone in a scene, also through inputs. In: a system, its inputs as expressions. Out: the functions
// that eom/hybrid/time_analysis.hpp examines before a run.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <optional>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::run {

/// inputs: the expression of each; none for a table.
eom::hybrid::TimeFunctions time_functions(const system::EquationSystem& system,
                                          const std::vector<std::optional<symbolic::Ref>>& inputs);

}  // namespace eomgen::run
