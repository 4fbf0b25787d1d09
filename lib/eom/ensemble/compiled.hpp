// SPDX-License-Identifier: MIT
// NAME_rhs_batch of emitted code in the form that integrate_ensemble() expects. In: the function, inputs, a mode.
// Nothing is copied.
#pragma once

#include <cstddef>

namespace eom {

/// NAME_rhs_batch with inputs and a mode, the same for all members.
struct CompiledBatch {
  /// The type of NAME_rhs_batch.
  using Function = int (*)(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
                           const double* u, const int* mode, int own, double* dx, int* codes);
  static constexpr int own_time = 1, own_parameters = 2;  // NAME_own_time, NAME_own_parameters

  Function rhs_function = nullptr;
  const double* u = nullptr;  // null: the defaults
  const int* mode = nullptr;  // null: all entries are 0

  /// dx of `count` states; values of one component lie `stride` apart. codes: one per state. Returns a code
  /// that is not 0, if there is one.
  int operator()(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
                 int* codes) const {
    return rhs_function(count, stride, t, x, p, u, mode, own_time + own_parameters, dx, codes);
  }
};

/// With NAME_jac_batch, for `rodas` with members side by side.
struct CompiledBatchJacobian : CompiledBatch {
  /// The type of NAME_jac_batch.
  using JacobianFunction = int (*)(std::size_t count, std::size_t stride, const double* t, const double* x,
                                   const double* p, const double* u, const int* mode, int own, double* dfdx,
                                   double* dfdt, int* codes);
  JacobianFunction jacobian_function = nullptr;

  /// df/dx and df/dt of `count` states (docs/abi.md). Returns a code that is not 0, if there is one.
  int jacobian(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dfdx,
               double* dfdt, int* codes) const {
    return jacobian_function(count, stride, t, x, p, u, mode, own_time + own_parameters, dfdx, dfdt, codes);
  }
};

/// With NAME_taylor_batch and NAME_taylor_order, for `taylor` with members side by side.
struct CompiledBatchSeries : CompiledBatch {
  /// The type of NAME_taylor_batch.
  using SeriesFunction = int (*)(std::size_t count, std::size_t stride, const double* t, const double* x,
                                 const double* p, const double* u, const int* mode, const int* order, int own,
                                 double* coefficients, int* codes);
  static constexpr int own_orders = 32;  // NAME_own_orders

  SeriesFunction series_function = nullptr;
  int highest_order = 0;

  /// Taylor coefficients of `count` states, each with its own order. Returns a code that is not 0, if there is one.
  int taylor(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
             const int* orders, double* coefficients, int* codes) const {
    return series_function(count, stride, t, x, p, u, mode, orders, own_time + own_parameters + own_orders,
                           coefficients, codes);
  }
  /// The highest order, NAME_taylor_order.
  int taylor_order() const { return highest_order; }
};

}  // namespace eom
