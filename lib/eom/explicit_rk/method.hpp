// SPDX-License-Identifier: MIT
// An explicit Runge-Kutta method in the form that drive.hpp expects: the stepper of a tableau, with its step size
// control.
#pragma once

#include <span>

#include "eom/explicit_rk/controller.hpp"
#include "eom/explicit_rk/step.hpp"

namespace eom::explicit_rk {

template <class T, class F>
class Method : public Stepper<T, F> {
 public:
  static constexpr int order = T::order;
  static constexpr bool adaptive = !T::error.empty();
  static constexpr bool error_uses_end = explicit_rk::error_uses_end<T>();

  Method(F& rhs, std::span<const double> x, const Options& options)
      : Stepper<T, F>(rhs, x, options.quadratures), controller_(T::control, T::order) {}

  double after_accepted(double h, double error) { return controller_.after_accepted(h, error); }
  double after_rejected(double h, double error) { return controller_.after_rejected(h, error); }
  double after_failed(double h) { return controller_.after_failed(h); }

 private:
  Controller controller_;
};

}  // namespace eom::explicit_rk
