// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "run/integration.hpp"

namespace eomgen::run {

/// The right-hand side with its derivatives as methods take them.
struct MotionOf {
  Integration& of;
  int operator()(double t, const double* x, double* dx) const { return of.rhs(t, x, dx); }
  int jacobian(double t, const double* x, double* dfdx, double* dfdt) const { return of.jacobian(t, x, dfdx, dfdt); }
  int taylor(double t, const double* x, int order, double* coefficients) const {
    return of.taylor(t, x, order, coefficients);
  }
  std::size_t coordinates() const { return of.keeps_constraints_ ? of.n_ : 0; }
  std::size_t constraints() const { return of.rows_.size(); }
  std::size_t position_constraints() const { return of.rows_.on_positions(); }
  int momenta(double t, const double* x, double* p, double* rate) const { return of.momenta(t, x, p, rate); }
  int mass(double t, const double* x, double* M) const { return of.mass(t, x, M); }
  int constrain(double t, const double* x, double* psi, double* A, double* b) const {
    return of.rows_(t, x, of.inputs(t), psi, A, b);
  }
  int taylor_order() const { return of.compiled().taylor_order; }
  std::size_t taylor_states() const { return 2 * of.n_ + of.compiled().integrals; }
};

/// Event functions, with their bounds along a step.
struct EventsOf {
  Integration& of;
  int operator()(double t, const double* x, double* g) const { return of.events(t, x, g); }
  std::optional<std::pair<double, double>> hidden(const eom::StepView& step, std::size_t i, int side, double from,
                                                  double to) const {
    return of.hidden(step, i, side, from, to);
  }
};

}  // namespace eomgen::run
