// SPDX-License-Identifier: MIT
// NAME_rhs_batch of emitted code as integrate_ensemble() takes it. In: the function, inputs, a mode. Nothing is copied.
#pragma once

#include <cstddef>

namespace eom {

struct CompiledBatch {
  using Function = int (*)(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
                           const double* u, const int* mode, int own, double* dx, int* codes);
  static constexpr int own_time = 1, own_parameters = 2;  // NAME_own_time, NAME_own_parameters

  Function rhs_function = nullptr;
  const double* u = nullptr;  // null: the defaults
  int mode = 0;

  int operator()(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
                 int* codes) const {
    return rhs_function(count, stride, t, x, p, u, &mode, own_time + own_parameters, dx, codes);
  }
};

}  // namespace eom
