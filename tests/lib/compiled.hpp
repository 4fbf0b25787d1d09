// SPDX-License-Identifier: GPL-3.0-or-later
// integrate() of a System, as the library contains it, instead of compiled in each file.
#pragma once

#include "eom/ode.hpp"

namespace compiled {

/// eom::integrate() of rhs as a System: otherwise every explicit method is compiled for each right-hand side.
/// integrate_test.cpp, order_test.cpp and allocation_test.cpp test those methods.
template <class F, class Observer = eom::NoObserver, class AfterStep = eom::NoProjection>
eom::Result integrate(std::string_view method, F&& rhs, double t0, std::span<const double> x0, double t1,
                      const eom::Options& options = {}, Observer&& observer = {}, AfterStep&& after_step = {}) {
  return eom::integrate(method, eom::system_of(rhs), t0, x0, t1, options, observer, after_step);
}

}  // namespace compiled
