// SPDX-License-Identifier: MIT
// The right-hand side of a run with its derivatives, in the form that eom::integrate expects; event functions with
// their bounds.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

#include "eom/hybrid/run_context.hpp"

namespace eom::hybrid {

/// The right-hand side of a run with its optional members (system.hpp).
struct Motion {
  RunContext& of;
  bool keeps_constraints = false;  // the method satisfies the constraints itself

  int operator()(double t, const double* x, double* dx) const { return of.rhs(t, x, dx); }
  int jacobian(double t, const double* x, double* dfdx, double* dfdt) const {
    return of.model.jacobian(t, x, dfdx, dfdt, of.work_is_state());
  }
  int taylor(double t, const double* x, int order, double* coefficients) const {
    return of.model.taylor(t, x, order, coefficients);
  }
  int taylor_order() const { return of.model.code().taylor_order; }
  std::size_t taylor_states() const { return of.problem.code->layout().size(); }
  int momenta(double t, const double* x, double* p, double* rate) const { return of.model.momenta(t, x, p, rate); }
  int mass(double t, const double* x, double* M) const { return of.model.mass(t, x, M); }
  int constrain(double t, const double* x, double* psi, double* A, double* b) const {
    return of.rows(t, x, of.model.inputs(t), psi, A, b);
  }
  std::size_t coordinates() const { return keeps_constraints ? of.problem.n() : 0; }
  std::size_t constraints() const { return of.rows.size(); }
  std::size_t position_constraints() const { return of.rows.position_row_count(); }
};

/// The event functions of a run, with the crossings that bounds reveal between samples (events/locator.hpp).
struct BoundedEvents {
  RunContext& of;
  const Sampling& sampling;

  int operator()(double t, const double* x, double* g) const { return of.events(t, x, g); }
  double value(double t, const double* x, std::size_t i) const { return of.events.value(t, x, i); }
  std::optional<std::pair<double, double>> hidden_crossing(const StepView& step, std::size_t i, int side, double from,
                                                           double to) const {
    return of.events.hidden_crossing(step, i, side, from, to, sampling);
  }
  void begin_step(const StepView& step) const { of.events.begin_step(step); }
  bool is_clear(const StepView&, std::size_t i, int side) const { return of.events.is_clear(i, side); }
  void forget_step() const { of.events.forget_step(); }
};

}  // namespace eom::hybrid
