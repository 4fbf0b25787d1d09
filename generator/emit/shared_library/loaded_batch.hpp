// SPDX-License-Identifier: GPL-3.0-or-later
// In: the output of target batch. Out: its functions for many states, compiled for the processor of this machine and
// loaded. The cache is that of loaded_model.hpp. Fused multiply-add is disabled, so that every processor computes the
// same bits.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "emit/shared_library/loaded_model.hpp"

namespace eomgen::emit {

using BatchFunction = int (*)(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
                              const double* u, const int* mode, int own, double* dx, int* codes);
using PreparedBatchFunction = int (*)(std::size_t count, std::size_t stride, const double* t, const double* x,
                                      const double* p, const double* w, const double* u, const int* mode, int own,
                                      double* dx, int* codes);
using BatchJacobian = int (*)(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
                              const double* u, const int* mode, int own, double* dfdx, double* dfdt, int* codes);
using BatchSeries = int (*)(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
                            const double* u, const int* mode, const int* order, int own, double* coefficients,
                            int* codes);

/// NAME_own_time, ... of NAME_batch.h (docs/abi.md).
inline constexpr int own_time = 1, own_parameters = 2, own_inputs = 4, own_prepared = 16, own_orders = 32;

class LoadedBatch {
 public:
  /// Throws Error{ErrorKind::tool} as LoadedModel does, and if a batch of the default state differs in any bit from
  /// that state alone.
  LoadedBatch(const std::string& path, const std::string& name);

  LoadedModel model;
  BatchFunction rhs = nullptr;
  PreparedBatchFunction rhs_prepared = nullptr;  // exists if `prepare` exists
  BatchJacobian jac = nullptr;                   // null if not emitted or too large for lanes
  BatchSeries taylor = nullptr;
  int width = 1;                                     // number of lanes
  std::shared_ptr<const ScratchFolder> folder = {};  // private folder of this process, if used

 private:
  struct Close {
    void operator()(void* handle) const;
  };
  std::unique_ptr<void, Close> handle_;
};

/// Compiles and loads. `files`: name and text of NAME.c, NAME.h, NAME_batch.c and NAME_batch.h.
LoadedBatch compile_and_load_batch(const std::vector<std::pair<std::string, std::string>>& files,
                                   const std::string& name, const std::atomic<bool>* interrupt);

}  // namespace eomgen::emit
