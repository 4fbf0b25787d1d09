// SPDX-License-Identifier: MIT
// Step size control by error estimates. In: the error norm of a trial step (1: just allowed). Out: the next step size.
// PI control after Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section II.4, and Hairer,
// Wanner, part II, section IV.2: h_new = h safety err^-(1/p - 3/4 beta) err_before^beta, within [shrink, grow] h.
#pragma once

#include <algorithm>
#include <cmath>

#include "eom/explicit_rk/tableau.hpp"

namespace eom::explicit_rk {

/// Chooses the next step from the errors of the last ones.
class Controller {
 public:
  Controller(const StepControl& control, int order) : control_(control), exponent_(1.0 / order - 0.75 * control.beta) {}

  /// The next step after an accepted one of size h with the given error norm; never longer after a rejection.
  double after_accepted(double h, double error) {
    double factor = std::pow(error, exponent_);
    if (control_.beta > 0) factor /= std::pow(error_before_, control_.beta);
    error_before_ = std::max(error, 1e-4);
    double growth = bounded_growth(factor);
    if (rejected_before_) growth = std::min(growth, 1.0);
    rejected_before_ = false;
    return h * growth;
  }

  /// The step to try after one of size h was rejected for its error.
  double after_rejected(double h, double error) {
    rejected_before_ = true;
    return h * std::min(bounded_growth(std::pow(error, exponent_)), 0.95);
  }

  /// The step to try after one of size h could not be completed (a code, or a value that is not finite).
  double after_failed(double h) {
    rejected_before_ = true;
    return 0.25 * h;
  }

 private:
  double bounded_growth(double factor) const {
    const double growth = control_.safety / factor;  // factor 0: infinite, then bounded
    return std::clamp(growth, control_.shrink, control_.grow);
  }

  StepControl control_;
  double exponent_;
  double error_before_ = 1e-4;
  bool rejected_before_ = false;
};

}  // namespace eom::explicit_rk
