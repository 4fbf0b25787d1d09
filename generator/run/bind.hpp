// SPDX-License-Identifier: GPL-3.0-or-later
// A scene bound to the runtime. In: the request of a run, with names and expressions. Out: the same as numbers and
// indices for eom::hybrid.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <string>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

/// The inputs of a scene.
std::vector<eom::hybrid::Signal> input_signals(const Scene& scene);

/// The problem of a run. `request` has to outlive it. `solver`: an eligible one.
eom::hybrid::Problem make_problem(const RunRequest& request, const std::string& solver);

}  // namespace eomgen::run
