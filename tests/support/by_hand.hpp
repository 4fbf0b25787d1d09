// SPDX-License-Identifier: GPL-3.0-or-later
// Equations written by hand, integrated beside a run. Compiled once: each right-hand side would compile every method.
#pragma once

#include <functional>
#include <vector>

namespace eomgen::test {

using Rates = std::function<int(double t, const double* x, double* dx)>;

/// The state at t1 by dop853 from x0 at t0. Throws std::runtime_error where it does not get there.
std::vector<double> integrate_by_hand(const Rates& f, double t0, const std::vector<double>& x0, double t1, double rtol,
                                      double atol);

}  // namespace eomgen::test
