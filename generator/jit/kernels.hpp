// SPDX-License-Identifier: GPL-3.0-or-later
// Functions that machine code calls. They compute what the emitted C computes with the helper functions that it brings
// along, from the same text (templates/kernels) or in the same order of operations.
#pragma once

#include <cstddef>
#include <vector>

#include "jit/steps.hpp"

namespace eomgen::jit {

/// angles[count .. 2 count) = sines of the `count` angles, angles[2 count .. 3 count) = cosines.
using SincosGroup = void (*)(double* angles, std::size_t count);
SincosGroup sincos_group();
/// The same bits with vectors of four angles, for processors with AVX2. `count` is a multiple of 4.
SincosGroup wide_sincos_group();

/// The address of a function of the C library.
const void* library_function(Library function);

/// The signs of order 0 or 1 of all states of a contact (eom::contact_sign), for the last three bits of a state.
inline constexpr std::uint32_t contact_state_mask = 7;
const double* contact_signs(std::size_t order);

using ChartFunction = int (*)(const double* x, double* y);
/// Parts of the function `chart` (docs/abi.md, "Charts").
struct ChartExchange {
  std::size_t states = 0;
  std::size_t first_entry = 0;                   // of `mode`
  std::vector<ChartFunction> to_second, to_own;  // of each chart
};
int exchange_charts(const double* x, const int* mode, const int* to, double* y, const ChartExchange* charts);

using PrepareFunction = int (*)(const double* p, double* w);
/// Parts of the function `prepare` in code with several charts.
struct PrepareInCharts {
  std::vector<PrepareFunction> functions;
  std::vector<std::size_t> offsets;  // in w
};
int prepare_in_charts(const double* p, double* w, const PrepareInCharts* charts);

/// Parts of the function `taylor` (program/taylor.hpp).
struct TaylorSeries {
  int (*start)(double, const double*, const double*, const double*, const int*, double*, double*) = nullptr;
  int (*next)(double, const double*, const double*, double*, double*, double*) = nullptr;
  std::size_t states = 0, first_rate = 0, order_zero_count = 0, product_count = 0, workspace = 0;
  int highest_order = 0;
};
int taylor_series(double t, const double* x, const double* p, const double* u, const int* mode, int order,
                  double* coefficients, const TaylorSeries* series);

}  // namespace eomgen::jit
