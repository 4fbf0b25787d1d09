// SPDX-License-Identifier: GPL-3.0-or-later
// Integration of equations written by hand, as a reference for a run. Compiled only once, because every right-hand side
// type would compile every method.
#pragma once

#include <functional>
#include <vector>

namespace eomgen::test {

using RightHandSide = std::function<int(double t, const double* x, double* dx)>;

/// The state at t1 by dop853 from x0 at t0. Throws std::runtime_error if it does not reach t1.
std::vector<double> integrate_reference(const RightHandSide& f, double t0, const std::vector<double>& x0, double t1,
                                        double rtol, double atol);

}  // namespace eomgen::test
