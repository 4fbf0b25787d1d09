// SPDX-License-Identifier: GPL-3.0-or-later
// Definite integrals by Gauss-Legendre quadrature in any precision: the oracle's evaluation of integral(e), independent
// of the closed forms that it is compared with.
#pragma once

#include <functional>
#include <vector>

#include "oracle/jet.hpp"

namespace eomgen::verify {

class GaussLegendre {
 public:
  GaussLegendre(int digits, const Precision& precision);

  /// The integral of `f` from a to b (b may be before a), to the given digits relative to the size of the integrand.
  /// Panels are halved until the halves agree with the whole. Throws Singular if they never do.
  Real operator()(const std::function<Real(const Real&)>& f, const Real& a, const Real& b) const;

 private:
  Precision precision_;
  Real small_;
  std::vector<Real> node_, weight_;  // on [-1, 1]
};

}  // namespace eomgen::verify
