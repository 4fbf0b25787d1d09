// SPDX-License-Identifier: MIT
// Taylor series of adaptive order: the coefficients at the start of a step give its end, its error, its length and, as
// they are, the dense output. Steps are chosen before they are made, so that nearly none is rejected. Source: Jorba,
// Zou, A software package for the numerical integration of ODEs by means of high-order Taylor methods, Experimental
// Mathematics 14 (2005): the length from the last two coefficients, an order that is worth its cost.
//
// An order p costs about (p + 6)^2 and allows the step h_p at which the last two terms are of the size of the
// tolerance: the order goes where h_p / (p + 6)^2 is largest, by 1 from step to step. With fixed steps, or where a step
// is made anew with an end that others have chosen, the order rises until the last terms are below the tolerance.
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
#include "eom/taylor/quadrature.hpp"

namespace eom::taylor {

inline constexpr Refusal refusals[] = {
    {Feature::moving_inputs, ", and its series knows inputs that stand still or jump"},
    {Feature::charts, "its series is that of the model's own coordinates"}};

class Series : public StepEnds {
 public:
  static constexpr const char* name = "taylor";
  static constexpr int order = 20;  // typical
  static constexpr int dense_order = 20;
  static constexpr bool adaptive = true;
  static constexpr bool error_uses_end = false;
  static constexpr Needs needs{.required = {Feature::series}, .refuses = refusals};

  /// Throws std::invalid_argument where the state or the order asked for cannot be those of the series.
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
        rtol_(options.rtol),
        atol_(options.atol),
        highest_(system.taylor_order),
        order_(options.series_order > 0 ? std::min(options.series_order, highest_) : first_order(x)),
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
  /// The series at the end too: it decides the length of the next step.
  int evaluate_end() {
    if (fixed_) return evaluate(t1_, x1_, f1_);
    const int code = expand(t1_, x1_, f1_, there_, next_order());
    return code != 0 || goes_on() ? code : code_jump;
  }

  double first_step() { return length(here_); }

  /// Trial state at t1; a code of the right-hand side.
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

  /// Of the terms as they were measured when the step was chosen.
  double error_norm(double, double) const {
    const double h = std::log2(std::abs(h_));
    return std::exp2(std::max(here_.last + here_.order * h, here_.before + (here_.order - 1) * h));
  }
  double after_accepted(double h, double) {
    measure(there_, x1_, h);
    return length(there_);
  }
  double after_rejected(double h, double error) {
    return h * std::clamp(std::pow(aim / error, 1.0 / here_.order), 0.1, 0.95);
  }
  double after_failed(double h) { return 0.25 * h; }

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
  struct At {
    double* c = nullptr;
    int order = 0;                // 0: not computed
    double last = 0, before = 0;  // log2 of the last two terms at h = 1, as far as they count for the error
  };

  static constexpr int lowest_order = 4;
  static constexpr double aim = 0.5, log2_aim = -1;  // of the tolerance that a step may use
  static constexpr double tail =
      -2.3;  // log2 of what is left out, in units of the last terms: the next ones are shorter by h/radius
  static constexpr double jump =
      4;  // times the order, of the tolerance: what the derivative at the end may be off by, over the step
  static constexpr double smooth = 1e-9;  // of the derivative: what is off by less is rounding
  static constexpr double overhead = 6;   // an order p costs (p + overhead)^2, measured

  /// Where the terms of a series that loses e^-1.6 from one to the next reach the tolerance.
  int first_order(std::span<const double> x) const {
    double largest = 0;
    for (std::size_t i = 0; i < error_; ++i) largest = std::max(largest, std::abs(x[i]));
    const double tolerance = std::max(rtol_, std::min(1e-2, atol_ / std::max(largest, 1e-3)));
    const int wanted = static_cast<int>(std::ceil(1 - 0.62 * std::log(std::max(tolerance, 1e-18))));
    return std::clamp(wanted, std::min(lowest_order, highest_), highest_);
  }

  int expand(double t, const double* x, double* f, At& at, int terms) {
    ++counts_.rhs_evaluations;
    at.order = 0;
    if (const int code = system_.taylor(system_.self, t, x, terms, at.c); code != 0) return code;
    at.order = terms;
    std::copy_n(at.c + s_, s_, f);
    if (s_ == n_) return 0;
    const int code = evaluate(t, x, scratch_);
    std::copy(scratch_ + s_, scratch_ + n_, f + s_);
    return code;
  }

  /// Whether the series ends with the derivative that the right-hand side has there. Where it jumps, or bends within
  /// less than the series sees (dry friction in a plane as the slip passes by zero), the coefficients know nothing of
  /// it, nor does their size.
  bool goes_on() const {
    double off = 0, size = 0;
    for (std::size_t i = 0; i < error_; ++i) {
      const double* term = here_.c + static_cast<std::size_t>(here_.order) * s_ + i;
      double slope = here_.order * *term;
      for (int k = here_.order - 1; k > 0; --k) slope = slope * h_ + k * *(term -= s_);
      const double difference = (f1_[i] - slope) * weight_[i], whole = f1_[i] * weight_[i];
      off += difference * difference;
      size += whole * whole;
    }
    const double count = static_cast<double>(error_);
    return !(std::sqrt(off / count) * std::abs(h_) > jump * here_.order && off > smooth * smooth * size);
  }

  /// log2 of the root mean square of the terms of order k at h = 1, in units of the tolerance.
  double size_of_term(const At& at, int k) const {
    const double* term = at.c + static_cast<std::size_t>(k) * s_;
    double sum = 0;
    for (std::size_t i = 0; i < error_; ++i) {
      const double part = term[i] == 0 ? 0 : term[i] * weight_[i];
      sum += part * part;
    }
    return 0.5 * std::log2(sum / static_cast<double>(error_));
  }

  /// The last terms, for a state that moves on by about `move` times its rate; and whether the next series is worth
  /// another order.
  void measure(At& at, const double* x, double move) {
    const double* slope = at.c + s_;
    for (std::size_t i = 0; i < error_; ++i)
      weight_[i] = 1 / (atol_ + rtol_ * (std::abs(x[i]) + 0.5 * std::abs(slope[i] * move)));
    const int p = at.order;
    at.last = tail + size_of_term(at, p);
    at.before = 2 * tail + size_of_term(at, p - 1);
    if (order_is_given_ || fixed_) return;
    trend_ = 1;
    if (p < lowest_order + 2) return;
    const At lower{at.c, p - 2, tail + size_of_term(at, p - 2), 2 * tail + size_of_term(at, p - 3)};
    const double gain = log2_length(at) - log2_length(lower) - 2 * std::log2((p + overhead) / (p - 2 + overhead));
    trend_ = gain > 1e-3 ? 1 : gain < -1e-3 ? -1 : 0;
  }

  /// Ends the series of a fixed step at its smallest terms, where they do not become small: the step is longer than the
  /// radius of convergence, or rounding grows from term to term (near a place where constraints lose rank).
  void cut() {
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int p = here_.order; p >= std::min(lowest_order, highest_); --p) {
      here_.order = p;
      measure(here_, x0_, h_);
      if (const double error = error_norm(0, 0); error < least) least = error, best = p;
    }
    if (best == 0) return;
    here_.order = best;
    measure(here_, x0_, h_);
  }

  /// Of the step at which the last terms use what may be used of the tolerance.
  static double log2_length(const At& at) {
    return -std::max((at.last - log2_aim) / at.order, (at.before - log2_aim) / (at.order - 1));
  }
  static double length(const At& at) {
    return std::min(std::exp2(log2_length(at)), std::numeric_limits<double>::max());
  }

  int next_order() const {
    return order_is_given_ ? here_.order : std::clamp(here_.order + trend_, std::min(lowest_order, highest_), highest_);
  }

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

  /// What has no series: integrated along the one that the others have.
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
  double rtol_, atol_;
  int highest_, order_;
  bool order_is_given_;
  int trend_ = 0;
  std::vector<double> work_;
  double *node_, *weight_;
  At here_, there_;
  Gauss gauss_;
};

}  // namespace eom::taylor
