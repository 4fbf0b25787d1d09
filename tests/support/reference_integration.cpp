// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/reference_integration.hpp"

#include <eom/ode.hpp>
#include <stdexcept>

namespace eomgen::test {

std::vector<double> integrate_reference(const RightHandSide& f, double t0, const std::vector<double>& x0, double t1,
                                        double rtol, double atol) {
  eom::Options options;
  options.rtol = rtol;
  options.atol = atol;
  eom::Result end = eom::integrate("dop853", f, t0, x0, t1, options);
  if (end.outcome != eom::Outcome::done) throw std::runtime_error("equations written by hand: not integrated");
  return std::move(end.x);
}

}  // namespace eomgen::test
