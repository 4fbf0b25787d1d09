// SPDX-License-Identifier: GPL-3.0-or-later
// What rounding alone does to a run with fixed steps. In: a run. Out: the same from a start whose last digit differs,
// which tells how far the end is from what binary64 can know: near places where coordinates fail, or where motions
// part, shorter steps do not show it.
#pragma once

#include <eom/ode.hpp>
#include <string>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

/// The end of a run from there, in the model's own charts. Every component of the start is moved by a unit in its last
/// place; for a variational solver the momenta are, which it integrates: the rates move by M^-1 of it.
eom::Result from_rounded_start(const RunRequest& request, const std::string& solver, const eom::Options& options);

/// Of a variational solver, whose rates follow from positions and momenta: by how much those of a state move with the
/// last digits of these, and of the forces on the way.
std::vector<double> rounding_of_rates(const RunRequest& request, double t, std::vector<double> x);

}  // namespace eomgen::run
