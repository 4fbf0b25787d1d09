// SPDX-License-Identifier: MIT
// One step of an explicit Runge-Kutta method and its exact derivatives: the step's own formulas differentiated, stage
// by stage. In: a tableau (explicit_rk/tableau.hpp), functions of a model. Out: x1 with the bits of a first step of
// eom::integrate, and derivatives. With the stages X_i = x + h sum_j a_ij k_j, k_i = f(t + c_i h, X_i), a derivative '
// is
//   X_i' = x' + h' sum_j a_ij k_j + h sum_j a_ij k_j',   k_i' = df/dx X_i' + df/dt (t' + c_i h') + df/dp p' + df/du u'.
// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section II.6. Allocates in the
// constructor only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/discrete/functions.hpp"
#include "eom/explicit_rk/tableau.hpp"

namespace eom::discrete {

template <explicit_rk::Tableau T>
class ExplicitRk {
 public:
  static constexpr const char* name = T::name;
  static constexpr int order = T::order;

  explicit ExplicitRk(const Sizes& sizes)
      : sizes_(sizes),
        n_(sizes.states),
        slopes_(T::stages * n_),
        stage_(n_),
        jacobian_(n_ * n_),
        by_time_(n_),
        tangents_(n_ * most_columns()),
        slope_tangents_(T::stages * n_ * most_columns()) {}

  /// x1: N. Returns the first code of the right-hand side that is not 0.
  template <class F>
  int step(const F& f, const Arguments& at, double* x1) {
    if (const int code = stages_from<0>(f, at); code != 0) return code;
    combine<T::stages>(at, x1);
    return 0;
  }

  /// The same with derivatives. Returns code_no_function if the model lacks a function that they need.
  template <class F>
  int derivatives(const F& f, const Arguments& at, double* x1, const Derivatives& to) {
    if (const int code = step(f, at, x1); code != 0 || !to.any()) return code;
    const Columns columns(to, sizes_);
    if (const int code = tangents_from<0>(f, at, columns); code != 0) return code;
    combine_tangents<T::stages>(at, columns);
    const auto copy = [&](std::size_t first, std::size_t count, double* result) {
      if (result != nullptr) std::copy_n(&tangents_[n_ * first], n_ * count, result);
    };
    copy(columns.x, n_, to.x);
    copy(columns.p, sizes_.parameters, to.p);
    copy(columns.u, sizes_.inputs, to.u);
    copy(columns.t, 1, to.t);
    copy(columns.h, 1, to.h);
    return 0;
  }

 private:
  /// The first column of each derivative in the arrays of tangents.
  struct Columns {
    Columns(const Derivatives& to, const Sizes& sizes) : wanted(to) {
      const auto take = [&](const double* result, std::size_t columns) {
        return result != nullptr ? std::exchange(count, count + columns) : count;
      };
      x = take(to.x, sizes.states);
      p = take(to.p, sizes.parameters);
      u = take(to.u, sizes.inputs);
      t = take(to.t, 1);
      h = take(to.h, 1);
    }
    const Derivatives& wanted;
    std::size_t count = 0, x, p, u, t, h;
  };

  std::size_t most_columns() const { return n_ + sizes_.parameters + sizes_.inputs + 2; }

  template <std::size_t Row>
  double stage_sum(std::size_t i) const {
    return explicit_rk::weighted_sum<T::a, Row>(&slopes_[i], n_, std::make_index_sequence<T::stages>{});
  }

  template <std::size_t Row>
  void combine(const Arguments& at, double* to) const {
    for (std::size_t i = 0; i < n_; ++i) to[i] = at.x[i] + at.h * stage_sum<Row>(i);
  }

  template <std::size_t Row, class F>
  int stages_from(const F& f, const Arguments& at) {
    if constexpr (Row < T::stages) {
      combine<Row>(at, stage_.data());
      const int code = detail::rhs(f, at, at.t + T::c[Row] * at.h, stage_.data(), &slopes_[Row * n_]);
      return code != 0 ? code : stages_from<Row + 1>(f, at);
    } else {
      return 0;
    }
  }

  /// tangents_ = those of stage Row, from the tangents of the slopes before it.
  template <std::size_t Row>
  void combine_tangents(const Arguments& at, const Columns& columns) {
    const std::size_t size = n_ * columns.count;
    for (std::size_t i = 0; i < size; ++i)
      tangents_[i] = at.h * explicit_rk::weighted_sum<T::a, Row>(&slope_tangents_[i], n_ * most_columns(),
                                                                 std::make_index_sequence<T::stages>{});
    if (columns.wanted.x != nullptr)
      for (std::size_t i = 0; i < n_; ++i) tangents_[n_ * (columns.x + i) + i] += 1;
    if (columns.wanted.h != nullptr)
      for (std::size_t i = 0; i < n_; ++i) tangents_[n_ * columns.h + i] += stage_sum<Row>(i);
  }

  template <std::size_t Row, class F>
  int tangents_from(const F& f, const Arguments& at, const Columns& columns) {
    if constexpr (Row < T::stages) {
      const int code = slope_tangents<Row>(f, at, columns);
      return code != 0 ? code : tangents_from<Row + 1>(f, at, columns);
    } else {
      return 0;
    }
  }

  /// The tangents of slope Row.
  template <std::size_t Row, class F>
  int slope_tangents(const F& f, const Arguments& at, const Columns& columns) {
    combine<Row>(at, stage_.data());
    combine_tangents<Row>(at, columns);
    const double t = at.t + T::c[Row] * at.h;
    const double* const x = stage_.data();
    const Derivatives& wanted = columns.wanted;
    double* const to = &slope_tangents_[Row * n_ * most_columns()];
    std::fill_n(to, n_ * columns.count, 0.0);
    const bool timed = wanted.t != nullptr || wanted.h != nullptr;
    if (const int code = detail::jac(f, at, t, x, jacobian_.data(), timed ? by_time_.data() : nullptr); code != 0)
      return code;
    if (wanted.p != nullptr)
      if (const int code = detail::jac_p(f, at, t, x, to + n_ * columns.p); code != 0) return code;
    if (wanted.u != nullptr)
      if (const int code = detail::jac_u(f, at, t, x, to + n_ * columns.u); code != 0) return code;
    if (wanted.t != nullptr) std::copy_n(by_time_.data(), n_, to + n_ * columns.t);
    if (wanted.h != nullptr)
      for (std::size_t i = 0; i < n_; ++i) to[n_ * columns.h + i] = T::c[Row] * by_time_[i];
    for (std::size_t c = 0; c < columns.count; ++c)
      for (std::size_t j = 0; j < n_; ++j) {
        const double factor = tangents_[n_ * c + j];
        if (factor == 0) continue;
        for (std::size_t i = 0; i < n_; ++i) to[n_ * c + i] += jacobian_[i + n_ * j] * factor;
      }
    return 0;
  }

  Sizes sizes_;
  std::size_t n_;
  std::vector<double> slopes_, stage_, jacobian_, by_time_;
  std::vector<double> tangents_, slope_tangents_;  // of the stage, and of all slopes
};

}  // namespace eom::discrete
