// SPDX-License-Identifier: MIT
// Functions of the C ABI of emitted code as integrate() and integrate_modes() take them. In: pointers to NAME_rhs and
// NAME_events, parameters, inputs. Out: callables; nothing is copied, so the arrays have to stay.
#pragma once

namespace eom {

struct CompiledModel {
  using Function = int (*)(double t, const double* x, const double* p, const double* u, int mode, double* result);

  Function rhs_function = nullptr;
  Function events_function = nullptr;
  const double* p = nullptr;
  const double* u = nullptr;  // null: the defaults

  /// The right-hand side, and the event functions, with the mode as the caller's.
  auto rhs() const {
    return [*this](double t, const double* x, int mode, double* dx) { return rhs_function(t, x, p, u, mode, dx); };
  }
  auto events() const {
    return [*this](double t, const double* x, int mode, double* g) { return events_function(t, x, p, u, mode, g); };
  }
  /// The same in one mode.
  auto rhs(int mode) const {
    return [*this, mode](double t, const double* x, double* dx) { return rhs_function(t, x, p, u, mode, dx); };
  }
  auto events(int mode) const {
    return [*this, mode](double t, const double* x, double* g) { return events_function(t, x, p, u, mode, g); };
  }
};

}  // namespace eom
