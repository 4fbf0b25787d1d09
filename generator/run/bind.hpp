// SPDX-License-Identifier: GPL-3.0-or-later
// A scene bound to the runtime. In: what a run is asked for, by names and expressions. Out: the same in numbers and
// places, as eom::hybrid takes it.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <string>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

/// The inputs of a scene.
std::vector<eom::hybrid::Signal> signals_of(const Scene& scene);

/// The request has to stay. `solver`: one that can integrate it.
eom::hybrid::Problem problem_of(const RunRequest& request, const std::string& solver);

}  // namespace eomgen::run
