// SPDX-License-Identifier: MIT
// Steps of Taylor series for members side by side, each with its own order, bitwise equal to those of
// taylor/series.hpp. In: series of many states, the state and step of each lane. Out: trial states, error norms, dense
// output. Allocates in the constructor only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/ensemble/lane_rows.hpp"
#include "eom/taylor/order.hpp"
#include "eom/taylor/series.hpp"

namespace eom::ensemble {

/// The series of one lane at the start and at the end of the trial step.
struct SeriesSteps {
  taylor::SeriesMeasure here, there;
  int trend = 0;  // change of the order

  double after_accepted(double, double) const { return taylor::length(there); }
  double after_rejected(double h, double error) const { return taylor::after_rejected(here, h, error); }
  double after_failed(double h) const { return taylor::after_failed(h); }
};

/// Rhs: as EnsembleRhs, with taylor(count, stride, t, x, p, orders, coefficients, codes), up to the requested order of
/// each state: the coefficient of order k of x_i at [(i + n*k)*stride + s]; and taylor_order(), the highest.
template <class Rhs, std::size_t width>
class SeriesLanes : public LaneRows<Rhs, SeriesSteps, width> {
  using Rows = LaneRows<Rhs, SeriesSteps, width>;

 public:
  SeriesLanes(Rhs& rhs, std::size_t states, std::size_t parameters, const EnsembleOptions& options)
      : Rows(rhs, states, parameters, options, (2 * (rows(rhs) + 1) + 1) * states),
        control_(states, options.rtol, options.atol, rhs.taylor_order()),
        orders_(stride_) {
    f0_ = this->take(n_);
    f1_ = this->take(n_);
    weight_ = this->take(n_);
    here_ = this->take(rows(rhs) * n_);
    there_ = this->take(rows(rhs) * n_);
  }

  /// The series of the last step of lane l.
  void interpolate(std::size_t l, double t, double* x) const {
    const double d = t - lane_[l].t();
    const int highest = lane_[l].steps().here.order;
    for (std::size_t i = 0; i < n_; ++i) {
      double sum = here_[row(i, highest) + l] * d;
      for (int k = highest - 1; k > 0; --k) sum = (sum + here_[row(i, k) + l]) * d;
      x[i] = sum + x0_[i * stride_ + l];
    }
  }

 protected:
  using Rows::accepted_;
  using Rows::codes_;
  using Rows::error_;
  using Rows::f0_;
  using Rows::f1_;
  using Rows::h_;
  using Rows::lane_;
  using Rows::n_;
  using Rows::p_;
  using Rows::padded;
  using Rows::rhs_;
  using Rows::scratch_;
  using Rows::stage_t_;
  using Rows::stride_;
  using Rows::t_;
  using Rows::x0_;
  using Rows::x1_;

  static constexpr bool adaptive_method = true;
  static constexpr bool end_known = false;
  static constexpr int order = taylor::Series::order;
  SeriesSteps steps() const { return {}; }

  /// Computes the series at the starts of lanes, with an order based on the size of the state.
  void begin_slopes(std::size_t first, std::size_t count) {
    for (std::size_t l = first; l < first + count; ++l) {
      lane_[l].count(1);
      orders_[l] = control_.first([&](std::size_t i) { return x0_[i * stride_ + l]; });
    }
    rhs_.taylor(count, stride_, t_ + first, x0_ + first, p_ + first, orders_.data() + first, here_ + first,
                codes_.data() + first);
    for (std::size_t l = first; l < first + count; ++l) {
      for (std::size_t i = 0; i < n_; ++i) f0_[i * stride_ + l] = here_[row(i, 1) + l];
      taylor::SeriesMeasure& here = lane_[l].steps().here;
      here.order = orders_[l];
      if (codes_[l] == 0) measure(l, here_, here, x0_, 0);
    }
  }
  double first_step(std::size_t l) { return taylor::length(lane_[l].steps().here); }

  void attempt() {
    int highest = 0;
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      const taylor::SeriesMeasure& here = lane_[l].steps().here;
      highest = std::max(highest, here.order);
      stage_t_[l] = here.order;
      error_[l] = taylor::error_of(here, h_[l]);
    }
    for (std::size_t l = 0; l < padded(); l += width) {
      const Pack h = load(h_ + l), zero{};
      for (int k = highest; k > 0; --k) {
        const Pack after = load(stage_t_ + l) - static_cast<double>(k);  // below 0: for a lower order
        for (std::size_t i = 0; i < n_; ++i) {
          const Pack term = load(here_ + row(i, k) + l), sum = load(scratch_ + i * stride_ + l);
          store(scratch_ + i * stride_ + l, (after > zero ? sum + term : term) * h);
        }
      }
      for (std::size_t i = 0; i < n_; ++i) this->advance(i, l, load(scratch_ + i * stride_ + l));
    }
  }

  /// Computes the series at the ends, which determine the next step lengths, also for lanes that will be rejected.
  void end_slopes() {
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      SeriesSteps& steps = lane_[l].steps();
      orders_[l] = steps.there.order = control_.after(steps.here.order, steps.trend);
    }
    rhs_.taylor(lane_.size(), stride_, t_, x1_, p_, orders_.data(), there_, codes_.data());
    for (std::size_t i = 0; i < n_; ++i) std::copy_n(there_ + row(i, 1), stride_, f1_ + i * stride_);
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      const bool matches_derivative =
          codes_[l] != 0 || control_.matches_derivative(lane_[l].steps().here.order, h_[l], terms(here_, l), weights(l),
                                                        [&](std::size_t i) { return of(f1_, i, l); });
      if (!matches_derivative) codes_[l] = code_jump;
    }
  }

  void prepare_accepted() {
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (accepted_[l] != 0) measure(l, there_, lane_[l].steps().there, x1_, h_[l]);
    }
  }

  void accept() {
    Rows::accept();
    bool all = true;
    int highest = 0;
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      all = all && accepted_[l] != 0;
      highest = std::max(highest, orders_[l]);
    }
    if (all) {
      std::swap(here_, there_);
    } else {
      const Pack zero{};
      for (std::size_t r = 0; r < (static_cast<std::size_t>(highest) + 1) * n_; ++r) {
        for (std::size_t l = 0; l < padded(); l += width) {
          const std::size_t at = r * stride_ + l;
          store(here_ + at, load(accepted_ + l) == zero ? load(here_ + at) : load(there_ + at));
        }
      }
    }
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (accepted_[l] != 0) lane_[l].steps().here = lane_[l].steps().there;
    }
  }

  void move(std::size_t to, std::size_t from) {
    Rows::move(to, from);
    this->move_rows(weight_, n_, to, from);
    this->move_rows(here_, (static_cast<std::size_t>(lane_[to].steps().here.order) + 1) * n_, to, from);
  }

 private:
  static std::size_t rows(const Rhs& rhs) { return static_cast<std::size_t>(rhs.taylor_order()) + 1; }
  std::size_t row(std::size_t i, int k) const { return (i + n_ * static_cast<std::size_t>(k)) * stride_; }
  double of(const double* array, std::size_t i, std::size_t l) const { return array[i * stride_ + l]; }
  auto terms(const double* series, std::size_t l) const {
    return [this, series, l](std::size_t i, int k) { return series[row(i, k) + l]; };
  }
  auto weights(std::size_t l) const {
    return [this, l](std::size_t i) { return of(weight_, i, l); };
  }

  /// Series::measure of one lane.
  void measure(std::size_t l, const double* series, taylor::SeriesMeasure& at, const double* x, double move) {
    for (std::size_t i = 0; i < n_; ++i)
      weight_[i * stride_ + l] = control_.weight(of(x, i, l), series[row(i, 1) + l], move);
    control_.measure(at, terms(series, l), weights(l));
    lane_[l].steps().trend = control_.trend(at, terms(series, l), weights(l));
  }

  taylor::OrderControl control_;
  std::vector<int> orders_;
  double *weight_, *here_,
      *there_;  // 1 over the tolerance of each component; coefficients at both ends of a step
};

/// Fixed steps, which raise the order until the error is small, and quadratures beside the series require single
/// members.
template <class Rhs, bool dense>
requires requires(Rhs& rhs, const double* a, double* b, const int* orders, int* codes) {
  rhs.taylor(std::size_t{}, std::size_t{}, a, a, a, orders, b, codes);
  rhs.taylor_order();
}
struct LanesOf<taylor::Series, Rhs, dense> {
  using type = SeriesLanes<Rhs, pack_width>;
  static bool supports(const EnsembleOptions& options) { return !(options.fixed_step > 0) && options.quadratures == 0; }
};

}  // namespace eom::ensemble
