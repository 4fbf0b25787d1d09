// SPDX-License-Identifier: MIT
// Taylor series of adaptive order: the coefficients at the start of a step give its end, its error, its length and, as they
// are, the dense output. Steps are chosen before they are made, so that nearly none is rejected.
// Source: Jorba, Zou, A software package for the numerical integration of ODEs by means of high-order Taylor methods,
// Experimental Mathematics 14 (2005): the length from the last two coefficients, an order that is worth its cost.
//
// An order p costs about (p + 5)^2 and allows the step h_p at which the last two terms are of the size of the tolerance: the
// order goes where h_p / (p + 5)^2 is largest, by 1 from step to step. With fixed steps, or where a step is made anew with an end that
// others have chosen, the order rises until the last terms are below the tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "eom/run_types.hpp"
#include "eom/taylor/problem.hpp"
#include "eom/taylor/quadrature.hpp"

namespace eom::taylor {

class Series {
 public:
  static constexpr const char* name = "taylor";
  static constexpr int order = 20;  // typical
  static constexpr int dense_order = 20;
  static constexpr bool adaptive = true;
  static constexpr bool error_uses_end = false;

  Series(Problem& problem, std::span<const double> x, const Options& options)
      : problem_(problem),
        n_(x.size()),
        s_(problem.states),
        error_(std::min(s_, n_ - options.quadratures)),
        rtol_(options.rtol),
        atol_(options.atol),
        fixed_(options.fixed_step > 0),
        highest_(problem.highest_order),
        order_(options.series_order > 0 ? std::min(options.series_order, highest_) : first_order(x)),
        order_is_given_(options.series_order > 0),
        work_(8 * n_ + 2 * s_ * (static_cast<std::size_t>(highest_) + 1)) {
    double* next = work_.data();
    for (double** vector : {&x0_, &x1_, &f0_, &f1_, &scratch_, &carry_, &new_carry_, &node_}) *vector = std::exchange(next, next + n_);
    for (At* at : {&here_, &there_}) at->c = std::exchange(next, next + s_ * (static_cast<std::size_t>(highest_) + 1));
    std::copy(x.begin(), x.end(), x0_);
  }
  Series(const Series&) = delete;
  Series& operator=(const Series&) = delete;

  std::size_t size() const { return n_; }
  double* x0() { return x0_; }
  double* x1() { return x1_; }
  const double* derivative0() const { return f0_; }
  const double* derivative1() const { return f1_; }
  double* scratch() { return scratch_; }
  const Statistics& statistics() const { return counts_; }

  int evaluate(double t, const double* x, double* dx) {
    ++counts_.rhs_evaluations;
    return problem_.f(problem_.self, t, x, dx);
  }
  int evaluate_start(double t) { return fixed_ ? evaluate(t, x0_, f0_) : expand(t, x0_, f0_, here_, order_); }
  /// The series at the end too: it decides the length of the next step.
  int evaluate_end() { return fixed_ ? evaluate(t1_, x1_, f1_) : expand(t1_, x1_, f1_, there_, next_order()); }

  double first_step() { return length(here_, x0_, 0); }

  /// Trial state at t1; a code of the right-hand side.
  int attempt(double t0, double t1) {
    t0_ = t0;
    h_ = t1 - t0;
    t1_ = t1;
    if (here_.order == 0)
      if (const int code = expand(t0, x0_, f0_, here_, order_); code != 0) return code;
    const bool raised = fixed_ && !order_is_given_;
    while (raised && here_.order < highest_ && last_terms(here_, std::abs(h_), x0_, h_) > 1)
      if (const int code = expand(t0, x0_, f0_, here_, std::min(here_.order + 4, highest_)); code != 0) return code;
    for (std::size_t i = 0; i < s_; ++i) advance(i, increment(i, h_));
    return s_ < n_ ? quadratures() : 0;
  }

  double error_norm(double, double) const {
    return last_terms(here_, std::abs(h_), x0_, h_);
  }
  double after_accepted(double h, double) { return length(there_, x1_, h); }
  double after_rejected(double h, double error) { return h * std::clamp(std::pow(0.5 / error, 1.0 / here_.order), 0.1, 0.95); }
  double after_failed(double h) { return 0.25 * h; }

  void accept(bool moved) {
    std::swap(x0_, x1_);
    std::swap(f0_, f1_);
    std::swap(here_, there_);
    if (fixed_) here_.order = 0;
    if (moved)
      std::fill_n(carry_, n_, 0.0);
    else
      std::swap(carry_, new_carry_);
  }

  static void interpolate(const void* method, double t, double* x) { static_cast<const Series*>(method)->interpolate(t, x); }

  void interpolate(double t, double* x) const {
    const double d = t - t0_, s = d / h_;
    for (std::size_t i = 0; i < s_; ++i) x[i] = x0_[i] + increment(i, d);
    for (std::size_t i = s_; i < n_; ++i) {  // quadratures: the Hermite cubic
      const double d1 = x1_[i] - x0_[i], d2 = h_ * f0_[i] - d1, d3 = d1 - h_ * f1_[i] - d2;
      x[i] = x0_[i] + s * (d1 + (1 - s) * (d2 + s * d3));
    }
  }

 private:
  struct At {
    double* c = nullptr;
    int order = 0;  // 0: not computed
  };

  static constexpr int lowest_order = 4;
  static constexpr double aim = 0.5;       // of the tolerance that a step may use
  static constexpr double tail = 0.2;      // what is left out, in units of the last terms: the next ones are shorter by h/radius
  static constexpr double overhead = 5;    // an order p costs (p + overhead)^2

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
    if (const int code = problem_.series(problem_.self, t, x, terms, at.c); code != 0) return code;
    at.order = terms;
    std::copy_n(at.c + s_, s_, f);
    if (s_ == n_) return 0;
    const int code = evaluate(t, x, scratch_);
    std::copy(scratch_ + s_, scratch_ + n_, f + s_);
    return code;
  }

  /// Root mean square of the terms of one order, for h = 1, in units of the tolerance where x moves on by `move`.
  double size_of_term(const At& at, int k, const double* x, double move) const {
    const double* term = at.c + static_cast<std::size_t>(k) * s_;
    const double* slope = at.c + s_;
    double sum = 0;
    for (std::size_t i = 0; i < error_; ++i) {
      if (term[i] == 0) continue;
      const double scale = atol_ + rtol_ * (std::abs(x[i]) + 0.5 * std::abs(slope[i] * move));
      const double part = term[i] / scale;
      sum += part * part;
    }
    return std::sqrt(sum / static_cast<double>(error_));
  }

  double last_terms(const At& at, double h, const double* x, double move) const {
    const int p = at.order;
    const double last = size_of_term(at, p, x, move) * std::pow(h, p);
    const double before = p > 1 ? size_of_term(at, p - 1, x, move) * std::pow(h, p - 1) : 0;
    return tail * std::max(last, tail * before);
  }

  /// The step at which the last terms of order p use what may be used of the tolerance.
  double length(const At& at, int p, const double* x, double move) const {
    const double last = tail * size_of_term(at, p, x, move) / aim;
    const double before = p > 1 ? tail * tail * size_of_term(at, p - 1, x, move) / aim : 0;
    const double steps = std::max(std::pow(last, 1.0 / p), p > 1 ? std::pow(before, 1.0 / (p - 1)) : 0.0);
    return steps > 0 ? 1 / steps : std::numeric_limits<double>::max();
  }

  /// The length of the step from `at`; and whether the next series is worth another order.
  double length(const At& at, const double* x, double move) {
    const int p = at.order;
    const double h = length(at, p, x, move);
    trend_ = 0;
    if (order_is_given_ || p < lowest_order + 2) {
      if (!order_is_given_ && p < highest_) trend_ = 1;
      return h;
    }
    const double shorter = length(at, p - 2, x, move);
    const auto cost = [](double q) { return (q + overhead) * (q + overhead); };
    const double gain = h * cost(p - 2) / (shorter * cost(p));
    if (gain > 1 + 1e-3) trend_ = 1;
    if (gain < 1 - 1e-3) trend_ = -1;
    return h;
  }

  int next_order() const {
    return order_is_given_ ? here_.order : std::clamp(here_.order + trend_, std::min(lowest_order, highest_), highest_);
  }

  double increment(std::size_t i, double d) const {
    double sum = 0;
    for (int k = here_.order; k > 0; --k) sum = (sum + here_.c[static_cast<std::size_t>(k) * s_ + i]) * d;
    return sum;
  }

  void advance(std::size_t i, double step) {
    step += carry_[i];
    const double sum = x0_[i] + step, taken = sum - x0_[i];  // Knuth's two-sum, as in explicit_rk/step.hpp
    new_carry_[i] = (x0_[i] - (sum - taken)) + (step - taken);
    x1_[i] = sum;
  }

  /// What has no series: integrated along the one that the others have.
  int quadratures() {
    std::fill(scratch_ + s_, scratch_ + n_, 0.0);
    for (std::size_t g = 0; g < Gauss::count; ++g) {
      const double d = gauss_.node[g] * h_;
      for (std::size_t i = 0; i < n_; ++i) node_[i] = i < s_ ? x0_[i] + increment(i, d) : x0_[i];
      if (const int code = evaluate(t0_ + d, node_, x1_node()); code != 0) return code;
      for (std::size_t i = s_; i < n_; ++i) scratch_[i] += gauss_.weight[g] * x1_node()[i];
    }
    for (std::size_t i = s_; i < n_; ++i) advance(i, h_ * scratch_[i]);
    return 0;
  }
  double* x1_node() { return f1_; }  // free until the end is evaluated

  Problem& problem_;
  std::size_t n_, s_, error_;
  double rtol_, atol_;
  bool fixed_;
  int highest_, order_;
  bool order_is_given_;
  int trend_ = 0;
  Statistics counts_;
  std::vector<double> work_;
  double *x0_, *x1_, *f0_, *f1_, *scratch_, *carry_, *new_carry_, *node_;
  At here_, there_;
  Gauss gauss_;
  double t0_ = 0, t1_ = 0, h_ = 0;
};

}  // namespace eom::taylor
