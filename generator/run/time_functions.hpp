// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of time alone in a scene, also through inputs. In: a system, its inputs as expressions. Out: what
// eom/hybrid/clock.hpp looks at before a run.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <optional>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::run {

/// inputs: what each is as an expression; none: a table.
eom::hybrid::TimeFunctions time_functions(const system::EquationSystem& system,
                                          const std::vector<std::optional<symbolic::Ref>>& inputs);

}  // namespace eomgen::run
