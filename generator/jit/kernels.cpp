// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled without fused multiplications and at -O2 in every configuration, as emitted code is.
#include "jit/kernels.hpp"

#include <array>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <eom/modes/contact_state.hpp>

#include "program/kinks.hpp"

namespace eomgen::jit {
namespace {

#include "skeletons/sincos_kernel.inc"

// As in emitted code: small angles first, all at once, since a branch after each pair would separate their operations.
void group(double* angles, std::size_t count) {
  double* const sine = angles + count;
  double* const cosine = angles + 2 * count;
  kernel_lanes reach = {0};
  std::array<double, 2> s{}, c{};
  std::size_t i = 0;
  for (; i + 1 < count; i += 2) kernel_sincos_near(angles[i], angles[i + 1], sine + i, cosine + i, &reach);
  if (i < count) {
    kernel_sincos_near(angles[i], 0.0, s.data(), c.data(), &reach);
    sine[i] = s[0];
    cosine[i] = c[0];
  }
  if (kernel_is_near(&reach)) return;
  for (i = 0; i < count; ++i) {
    kernel_sincos(angles[i], 0.0, s.data(), c.data());
    sine[i] = s[0];
    cosine[i] = c[0];
  }
}

}  // namespace

SincosGroup sincos_group() { return group; }

const void* library_function(Library function) {
  using One = double (*)(double);
  using Two = double (*)(double, double);
  const auto one = [](One f) { return reinterpret_cast<const void*>(f); };
  const auto two = [](Two f) { return reinterpret_cast<const void*>(f); };
  switch (function) {
    case Library::pow: return two(std::pow);
    case Library::sin: return one(std::sin);
    case Library::cos: return one(std::cos);
    case Library::tan: return one(std::tan);
    case Library::asin: return one(std::asin);
    case Library::acos: return one(std::acos);
    case Library::atan: return one(std::atan);
    case Library::sinh: return one(std::sinh);
    case Library::cosh: return one(std::cosh);
    case Library::tanh: return one(std::tanh);
    case Library::exp: return one(std::exp);
    case Library::log: return one(std::log);
    case Library::atan2: break;
  }
  return two(std::atan2);
}

const double* contact_signs(std::size_t order) {
  constexpr std::size_t states = contact_state_mask + 1;
  static constexpr auto table = [] {
    std::array<std::array<double, states>, 2> signs{};
    for (std::size_t k = 0; k < signs.size(); ++k) {
      for (std::size_t state = 0; state < states; ++state)
        signs[k][state] = eom::contact_sign(static_cast<int>(state), k);
    }
    return signs;
  }();
  return table.at(order).data();
}

int exchange_charts(const double* x, const int* mode, const int* to, double* y, const ChartExchange* charts) {
  for (std::size_t i = 0; i < charts->states; ++i) y[i] = x[i];
  for (std::size_t j = 0; j < charts->to_second.size(); ++j) {
    const auto is_second = [&](const int* of) { return of != nullptr && of[charts->first_entry + j] != 0; };
    if (is_second(mode) == is_second(to)) continue;
    const int code = (is_second(to) ? charts->to_second[j] : charts->to_own[j])(y, y);
    if (code != 0) return code;
  }
  return 0;
}

int prepare_in_charts(const double* p, double* w, const PrepareInCharts* charts) {
  for (std::size_t k = 0; k < charts->functions.size(); ++k) {
    const int code = charts->functions[k](p, w + charts->offsets[k]);
    if (code != 0) return code;
  }
  return 0;
}

int taylor_series(double t, const double* x, const double* p, const double* u, const int* mode, int order,
                  double* coefficients, const TaylorSeries* series) {
  if (order < 0 || order > series->highest_order) return 6;
  const std::size_t n = series->states, products = series->product_count;
  for (std::size_t i = 0; i < n; ++i) coefficients[i] = x[i];
  if (order == 0) return 0;
  thread_local std::vector<double> room;
  const std::size_t length = products * static_cast<std::size_t>(series->highest_order);
  if (room.size() < 2 * length + series->workspace) room.resize(2 * length + series->workspace);
  double* const a = room.data();
  double* const b = a + length;
  double* const w = b + length;
  const int code = series->start(t, x, p, u, mode, w, coefficients + n);
  if (code != 0) return code;
  for (std::size_t k = 1; k < static_cast<std::size_t>(order); ++k) {
    double* const sums = w + series->order_zero_count;
    for (std::size_t i = 0; i < products; ++i) sums[i] = 0;
    for (std::size_t j = 1; j < k; ++j) {
      const double* const left = a + j * products;
      const double* const right = b + (k - j) * products;
      for (std::size_t i = 0; i < products; ++i) sums[i] += left[i] * right[i];
    }
    w[series->workspace - 2] = k == 1 ? 1 : 0;
    w[series->workspace - 1] = 1 / static_cast<double>(k);
    double* const after = coefficients + n * (k + 1);
    series->next(static_cast<double>(k), coefficients + n * k, w, a + products * k, b + products * k, after);
    for (std::size_t i = 0; i < n; ++i) after[i] = after[i] / static_cast<double>(k + 1);
  }
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum = sum + coefficients[n * static_cast<std::size_t>(order) + i];
  return sum - sum <= 0 ? 0 : 5;
}

}  // namespace eomgen::jit
