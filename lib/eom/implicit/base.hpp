// SPDX-License-Identifier: MIT
// Common parts of the implicit methods: df/dx, and norms in units of the tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "eom/implicit/jacobian.hpp"
#include "eom/linalg/lu.hpp"
#include "eom/step_ends.hpp"

namespace eom::implicit {

class Base : public StepEnds {
 public:
  Base(System& system, std::span<const double> x, const Options& options, Jacobian::Differences differences)
      : StepEnds(system, x, options),
        m_(x.size() - options.quadratures),
        jacobian_(system, n_, m_, options.rtol > 0 ? options.atol / options.rtol : 0, differences) {}

  /// Replaces evaluate_start if the derivative at x0 is known.
  void start_with_derivative(const double* f) { std::copy_n(f, n_, f0_); }
  const Jacobian& jacobian() const { return jacobian_; }

 protected:
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();

  /// Root mean square of m components in units of `scale`. A component without a unit (atol 0 at 0) counts only if it
  /// changes.
  template <class Component, class Scale>
  double norm(Component component, Scale scale) const {
    double sum = 0;
    for (std::size_t i = 0; i < m_; ++i) {
      const double value = component(i);
      if (value == 0) continue;
      const double part = value / scale(i);
      sum += part * part;
    }
    return std::sqrt(sum / static_cast<double>(m_));
  }

  std::size_t m_;
  Jacobian jacobian_;
};

}  // namespace eom::implicit
