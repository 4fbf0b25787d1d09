// SPDX-License-Identifier: MIT
// Functions of the C ABI of emitted code in the forms that integrate() and integrate_modes() expect. In: pointers to
// NAME_rhs, NAME_events and NAME_jac, parameters, inputs. Out: callables. Nothing is copied, so the arrays must outlive
// them.
#pragma once

#include "eom/with_jacobian.hpp"

namespace eom {

struct CompiledModel {
  using Function = int (*)(double t, const double* x, const double* p, const double* u, int mode, double* result);

  using Derivatives = int (*)(double t, const double* x, const double* p, const double* u, int mode, double* dfdx,
                              double* dfdt);

  Function rhs_function = nullptr;
  Function events_function = nullptr;
  const double* p = nullptr;
  const double* u = nullptr;  // null: the defaults
  Derivatives jac_function = nullptr;

  /// The right-hand side and the event functions, with the mode as an argument.
  auto rhs() const {
    return [*this](double t, const double* x, int mode, double* dx) { return rhs_function(t, x, p, u, mode, dx); };
  }
  auto events() const {
    return [*this](double t, const double* x, int mode, double* g) { return events_function(t, x, p, u, mode, g); };
  }
  /// The right-hand side with its derivatives NAME_jac for implicit methods. They use differences if it is null.
  auto rhs_and_jacobian() const {
    return WithJacobian{rhs(), [*this](double t, const double* x, int mode, double* dfdx, double* dfdt) {
                          return jac_function == nullptr ? no_jacobian_here
                                                         : jac_function(t, x, p, u, mode, dfdx, dfdt);
                        }};
  }
  /// The same for a fixed mode.
  auto rhs(int mode) const {
    return [*this, mode](double t, const double* x, double* dx) { return rhs_function(t, x, p, u, mode, dx); };
  }
  auto events(int mode) const {
    return [*this, mode](double t, const double* x, double* g) { return events_function(t, x, p, u, mode, g); };
  }
};

}  // namespace eom
