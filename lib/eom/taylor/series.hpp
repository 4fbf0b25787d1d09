// SPDX-License-Identifier: MIT
// Taylor series of adaptive order. The coefficients at the start of a step give its end, its error, its length and the
// dense output. The length of a step is chosen before it is made, so that almost none is rejected. The length follows
// from the last two coefficients, the order from its cost (order.hpp).
//
// An order p costs about (p + 6)^2 and allows the step h_p at which the last two terms reach the tolerance. The order
// moves by 1 from step to step to the largest h_p / (p + 6)^2. With fixed steps, or if a step is repeated with a given
// end, the order increases until the last terms are below the tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "eom/run_types.hpp"
#include "eom/step_ends.hpp"
#include "eom/taylor/order.hpp"
#include "eom/taylor/quadrature.hpp"

namespace eom::taylor {

inline constexpr Refusal refusals[] = {
    {Feature::moving_inputs, ", and its series knows inputs that stand still or jump"},
    {Feature::charts, "its series is that of the model's own coordinates"},
    {Feature::contact_forces, ", and its series knows inputs that stand still or jump"}};

/// The method `taylor`.
class Series : public StepEnds {
  struct At : SeriesMeasure {
    double* c = nullptr;
  };

  auto terms_of(const At& at) const {
    return [c = at.c, s = s_](std::size_t i, int k) { return c[static_cast<std::size_t>(k) * s + i]; };
  }
  auto weights() const {
    return [this](std::size_t i) { return weight_[i]; };
  }

 public:
  static constexpr const char* name = "taylor";
  static constexpr int order = 20;  // typical
  static constexpr int dense_order = 20;
  static constexpr bool adaptive = true;
  static constexpr bool error_uses_end = false;
  static constexpr Needs needs{.required = {Feature::series}, .refuses = refusals};

  /// Throws std::invalid_argument if the state or the requested order does not match the series.
  static void check(const System& system, double, std::span<const double> x0, const Options& options) {
    if (system.taylor_states > x0.size())
      throw std::invalid_argument("eom::integrate: the series has more components than the state");
    if (options.series_order < 0 || options.series_order == 1 || options.series_order > system.taylor_order)
      throw std::invalid_argument(
          "eom::integrate: series_order has to be 0, or from 2 to the highest order of the series");
  }

  Series(System& system, std::span<const double> x, const Options& options)
      : StepEnds(system, x, options),
        s_(system.taylor_states),
        error_(std::min(s_, n_ - options.quadratures)),
        control_(error_, options.rtol, options.atol, system.taylor_order),
        highest_(system.taylor_order),
        order_(options.series_order > 0 ? std::min(options.series_order, highest_)
                                        : control_.first([&](std::size_t i) { return x[i]; })),
        order_is_given_(options.series_order > 0),
        work_(2 * n_ + 2 * s_ * (static_cast<std::size_t>(highest_) + 1)) {
    double* next = work_.data();
    for (double** vector : {&node_, &weight_}) *vector = std::exchange(next, next + n_);
    for (At* at : {&here_, &there_}) at->c = std::exchange(next, next + s_ * (static_cast<std::size_t>(highest_) + 1));
  }

  int evaluate_start(double t) {
    if (fixed_) return evaluate(t, x0_, f0_);
    const int code = expand(t, x0_, f0_, here_, order_);
    if (code == 0) measure(here_, x0_, 0);
    return code;
  }
  /// Also computes the series at the end, which determines the length of the next step.
  int evaluate_end() {
    if (fixed_) return evaluate(t1_, x1_, f1_);
    const int code = expand(t1_, x1_, f1_, there_, next_order());
    const bool matches_derivative =
        code != 0 || control_.matches_derivative(here_.order, h_, terms_of(here_), weights(),
                                                 [this](std::size_t i) { return f1_[i]; });
    return matches_derivative ? code : code_jump;
  }

  double first_step() { return length(here_); }

  /// Computes the trial state at t1. Returns a code of the right-hand side.
  int attempt(double t0, double t1) {
    open(t0, t1);
    for (int terms = order_;
         here_.order == 0 || (fixed_ && !order_is_given_ && here_.order < highest_ && error_norm(0, 0) > 1);
         terms = std::min(terms + 4, highest_)) {
      if (const int code = expand(t0, x0_, f0_, here_, terms); code != 0) return code;
      measure(here_, x0_, h_);
    }
    if (fixed_ && !order_is_given_ && !(error_norm(0, 0) <= 1)) cut();
    increments(h_, node_);
    for (std::size_t i = 0; i < s_; ++i) advance(i, node_[i]);
    return s_ < n_ ? quadratures() : 0;
  }

  /// From the terms that were measured when the step was chosen.
  double error_norm(double, double) const { return error_of(here_, h_); }
  double after_accepted(double h, double) {
    measure(there_, x1_, h);
    return length(there_);
  }
  double after_rejected(double h, double error) { return taylor::after_rejected(here_, h, error); }
  double after_failed(double h) { return taylor::after_failed(h); }

  void accept(bool moved) {
    swap_ends(moved);
    std::swap(here_, there_);
    if (fixed_) here_.order = 0;
  }

  static void interpolate(const void* method, double t, double* x) {
    static_cast<const Series*>(method)->interpolate(t, x);
  }

  void interpolate(double t, double* x) const {
    const double d = t - t0_, s = d / h_;
    interpolate_series(d, x);
    for (std::size_t i = s_; i < n_; ++i) {  // quadratures: the Hermite cubic
      const double d1 = x1_[i] - x0_[i], d2 = h_ * f0_[i] - d1, d3 = d1 - h_ * f1_[i] - d2;
      x[i] = x0_[i] + s * (d1 + (1 - s) * (d2 + s * d3));
    }
  }

 private:
  int expand(double t, const double* x, double* f, At& at, int terms) {
    ++counts_.rhs_evaluations;
    at.order = 0;
    // Coefficients grow by 1/radius per order: on a fast time scale those of a high order overflow.
    int code = system_.taylor(system_.self, t, x, terms, at.c);
    while (code == code_not_finite && !order_is_given_ && terms > control_.lowest())
      code = system_.taylor(system_.self, t, x, --terms, at.c);
    if (code != 0) return code;
    at.order = order_is_given_ ? terms : largest_finite_order(at, terms);
    std::copy_n(at.c + s_, s_, f);
    if (s_ == n_) return 0;
    code = evaluate(t, x, scratch_);
    std::copy(scratch_ + s_, scratch_ + n_, f + s_);
    return code;
  }

  /// The largest order whose coefficients, times the order, do not overflow.
  int largest_finite_order(const At& at, int terms) const {
    constexpr double largest = std::numeric_limits<double>::max() / 1024;
    const auto is_finite = [&](int k) {
      const double* const term = at.c + static_cast<std::size_t>(k) * s_;
      return std::all_of(term, term + s_, [](double c) { return std::abs(c) < largest; });
    };
    while (terms > control_.lowest() && !is_finite(terms)) --terms;
    return terms;
  }

  /// Measures the last terms for a state that changes by about `move` times its rate, and the change of the next order.
  void measure(At& at, const double* x, double move) {
    for (std::size_t i = 0; i < error_; ++i) weight_[i] = control_.weight(x[i], at.c[s_ + i], move);
    control_.measure(at, terms_of(at), weights());
    if (!order_is_given_ && !fixed_) trend_ = control_.trend(at, terms_of(at), weights());
  }

  /// Truncates the series of a fixed step at its smallest terms if these do not become small. Then the step exceeds the
  /// radius of convergence, or rounding grows from term to term (near a rank-deficient configuration).
  void cut() {
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int p = here_.order; p >= control_.lowest(); --p) {
      here_.order = p;
      measure(here_, x0_, h_);
      if (const double error = error_norm(0, 0); error < least) least = error, best = p;
    }
    if (best == 0) return;
    here_.order = best;
    measure(here_, x0_, h_);
  }

  int next_order() const { return order_is_given_ ? here_.order : control_.after(here_.order, trend_); }

  /// x(t0 + d) - x0 of the components with a series.
  void increments(double d, double* out) const {
    const double* term = here_.c + static_cast<std::size_t>(here_.order) * s_;
    for (std::size_t i = 0; i < s_; ++i) out[i] = term[i] * d;
    for (int k = here_.order - 1; k > 0; --k) {
      term -= s_;
      for (std::size_t i = 0; i < s_; ++i) out[i] = (out[i] + term[i]) * d;
    }
  }

  void interpolate_series(double d, double* x) const {
    increments(d, x);
    for (std::size_t i = 0; i < s_; ++i) x[i] += x0_[i];
    std::copy(x0_ + s_, x0_ + n_, x + s_);
  }

  /// Components without a series: integrated along the series of the others.
  int quadratures() {
    std::fill(scratch_ + s_, scratch_ + n_, 0.0);
    for (std::size_t g = 0; g < Gauss::count; ++g) {
      const double d = gauss_.node[g] * h_;
      interpolate_series(d, node_);
      if (const int code = evaluate(t0_ + d, node_, x1_node()); code != 0) return code;
      for (std::size_t i = s_; i < n_; ++i) scratch_[i] += gauss_.weight[g] * x1_node()[i];
    }
    for (std::size_t i = s_; i < n_; ++i) advance(i, h_ * scratch_[i]);
    return 0;
  }
  double* x1_node() { return f1_; }  // free until the end is evaluated

  std::size_t s_, error_;
  OrderControl control_;
  int highest_, order_;
  bool order_is_given_;
  int trend_ = 0;
  std::vector<double> work_;
  double *node_, *weight_;
  At here_, there_;
  Gauss gauss_;
};

}  // namespace eom::taylor
