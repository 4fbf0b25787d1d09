// SPDX-License-Identifier: MIT
// Radau IIA of orders 5, 9 and 13, chosen from step to step, for stiff systems to tight tolerances. Source: Hairer, Wanner, Stiff
// differential equations solved by Radau methods, Journal of Computational and Applied Mathematics 111 (1999); Solving Ordinary
// Differential Equations II, section IV.8. What is said in radau5.hpp holds, with s stages in place of 3: one real and (s - 1)/2 complex
// matrices; an estimate of order s, compared with r^((s+1)/(2s))/10.
// The order goes up where Newton's iteration converges fast (contraction below 0.002) in steps of steady length, and down where it
// converges slowly (above 0.8) or not at all, but not within ten steps of the last change. It starts with 5.
// Options::series_order fixes it; with fixed steps it is 5 unless told. Dense output: the collocation polynomial, of order s.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "eom/implicit/base.hpp"
#include "eom/implicit/newton.hpp"
#include "eom/implicit/radau_tableau.hpp"

namespace eom::implicit {

class Radau : public Base {
 public:
  static constexpr const char* name = "radau";
  static constexpr int order = 5;        // at least
  static constexpr int dense_order = 3;  // at least
  static constexpr bool adaptive = true;
  static constexpr bool error_uses_end = false;

  Radau(Problem& problem, std::span<const double> x, const Options& options)
      : Base(problem, x, options, Jacobian::Differences::one_sided),
        real_(m_), complex_{Lu<Complex>(m_), Lu<Complex>(m_), Lu<Complex>(m_)}, work_((4 * most + 2) * n_), pair_(m_),
        chooses_(options.series_order == 0 && options.fixed_step == 0) {
    if (const int asked = options.series_order; asked != 0 && asked != 5 && asked != 9 && asked != 13)
      throw std::invalid_argument("eom::integrate: series_order of radau has to be 0, 5, 9 or 13");
    double* next = work_.data();
    for (double** block : {&z_, &w_, &f_, &z_before_}) *block = std::exchange(next, next + most * n_);
    estimate_ = std::exchange(next, next + n_);
    right_ = next;
    set_tolerances(options, x);
    use(options.series_order == 13 ? 7 : options.series_order == 9 ? 5 : 3);
  }

  /// Trial state at t1; a code of the right-hand side, or code_no_convergence.
  int attempt(double t0, double t1) {
    open(t0, t1);
    if (jacobian_wanted_ || !jacobian_known_)
      if (const int code = new_jacobian(); code != 0) return code;
    while (true) {
      if (!factored_ || std::abs(h_ - h_factored_) > same_step * std::abs(h_))
        if (!factor()) {
          fail(0.5);
          return code_no_convergence;
        }
      start_values();
      int code = 0;
      if (iterate(code)) break;
      if (code != 0) return code;
      ++counts_.newton_failures;
      failed_ = true;
      if (jacobian_here_) return code_no_convergence;
      if ((code = new_jacobian()) != 0) return code;
    }
    return finish();
  }

  double error_norm(double, double) {
    const auto scale = [&](std::size_t i) { return atol_ + rtol_ * std::max(std::abs(x0_[i]), std::abs(x1_[i])); };
    double error = norm([&](std::size_t i) { return estimate_[i]; }, scale);
    if (error >= 1 && (rejected_ || !accepted_)) {  // once more through the filter: less is asked of a stiff start
      for (std::size_t i = 0; i < n_; ++i) scratch_[i] = x0_[i] + (i < m_ ? estimate_[i] : 0);
      if (evaluate(t0_, scratch_, right_) == 0) {
        for (std::size_t i = 0; i < m_; ++i) right_[i] += defect_of_stages(i) / h_;
        real_.solve(right_);
        const double again = norm([&](std::size_t i) { return right_[i]; }, scale);
        if (std::isfinite(again)) error = again;
      }
    }
    return std::max(error, 1e-10);
  }

  double after_accepted(double h, double error) {
    double quotient = step_quotient(error);
    if (accepted_ && !order_changed_) {
      const double predicted = h_before_ / h * std::pow(error * error / error_before_, exponent()) / safety;
      quotient = std::max(quotient, std::clamp(predicted, 1 / most_growth, most_shrinking));
    }
    h_before_ = h;
    error_before_ = std::max(error, 1e-2);
    double next = h / quotient;
    if (rejected_) next = std::min(next, h);
    order_changed_ = false;
    if (chooses_) choose_order(next / h);
    rejected_ = false;
    accepted_ = true;
    if (!order_changed_ && contraction_ <= keep_jacobian && next >= h && next <= 1.2 * h) return h;  // the factors stay
    return next;
  }

  double after_rejected(double h, double error) {
    jacobian_wanted_ = !jacobian_here_;
    rejected_ = true;
    return accepted_ ? std::min(h / step_quotient(error), 0.95 * h) : 0.1 * h;
  }

  double after_failed(double h) {
    jacobian_wanted_ = !jacobian_here_;
    rejected_ = true;
    if (chooses_ && stages_ > 3) use(stages_ - 2), since_change_ = 0, order_changed_ = true;
    return h * std::exchange(after_failure_, 0.25);
  }

  void accept(bool moved) {
    std::swap(z_, z_before_);
    h_of_before_ = h_;
    of_before_ = made_with_;
    jacobian_here_ = false;
    jacobian_wanted_ = contraction_ > keep_jacobian;
    swap_ends(moved);
  }

  static void interpolate(const void* method, double t, double* x) { static_cast<const Radau*>(method)->interpolate(t, x); }

  void interpolate(double t, double* x) const {
    const double s = (t - t0_) / h_;
    const RadauTableau& tableau = *made_with_;
    RadauTableau::Row weight;
    weights(tableau, s, weight);
    for (std::size_t i = 0; i < n_; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < tableau.stages; ++k) sum += weight[k] * z_[k * n_ + i];
      const double moved = x1_[i] - (x0_[i] + z_[(tableau.stages - 1) * n_ + i]);  // by after_step, and by rounding
      x[i] = x0_[i] + (sum + s * moved);
    }
  }

  /// Of the step that comes.
  std::size_t stages() const { return stages_; }

 private:
  static constexpr std::size_t most = RadauTableau::most;
  static constexpr double safety = 0.9;
  static constexpr double most_growth = 8;
  static constexpr double most_shrinking = 5;
  static constexpr double keep_jacobian = 1e-3;  // of the contraction of Newton's iteration
  static constexpr double same_step = 1e-9;
  static constexpr double fast = 2e-3, slow = 0.8;     // contractions at which the order goes up and down
  static constexpr double steady = 0.8;                // of the step before, or its inverse
  static constexpr int settled = 10;                   // steps after a change of order

  double exponent() const { return 1 / static_cast<double>(stages_ + 1); }
  int most_iterations() const { return 7 + 5 * static_cast<int>(stages_ - 3) / 2; }

  void set_tolerances(const Options& options, std::span<const double> x) {
    double largest = 0;
    for (std::size_t i = 0; i < m_; ++i) largest = std::max(largest, std::abs(x[i]));
    const double of_atol = options.atol > 0 ? options.atol / std::max(largest, 1e-300) : 0;
    tolerance_ = std::clamp(std::max(options.rtol, of_atol), 10 * epsilon, 1e-3);
    asked_rtol_ = options.rtol;
    asked_atol_ = options.atol;
  }

  /// The tableau with s stages, and the tolerances that go with its estimate.
  void use(std::size_t s) {
    stages_ = s;
    tableau_ = &RadauTableau::of(s);
    const double power = static_cast<double>(s + 1) / static_cast<double>(2 * s);
    const double loosened = 0.1 * std::pow(tolerance_, power - 1);
    rtol_ = loosened * asked_rtol_;
    atol_ = loosened * asked_atol_;
    const double compared = loosened * tolerance_;
    newton_tolerance_ = std::max(10 * epsilon / compared, std::min(0.03, std::pow(compared, 1 / power - 1)));
    factored_ = false;
  }

  /// growth: of the step that comes.
  void choose_order(double growth) {
    ++since_change_;
    const double mean = newton_ > 1 ? contraction_ : 0;
    if (failed_ && stages_ > 3) {
      change_order(stages_ - 2);
    } else if (since_change_ >= settled) {
      if (mean >= slow && stages_ > 3) change_order(stages_ - 2);
      else if (mean <= fast && stages_ < most && growth > steady && growth < 1 / steady) change_order(stages_ + 2);
    }
    failed_ = false;
  }
  void change_order(std::size_t s) {
    use(s);
    since_change_ = 0;
    order_changed_ = true;
  }

  int new_jacobian() {
    const int code = jacobian_.evaluate(t0_, x0_, f0_, h_, counts_);
    jacobian_known_ = jacobian_here_ = code == 0;
    jacobian_wanted_ = factored_ = false;
    return code;
  }

  bool factor() {
    ++counts_.factorisations;
    const std::size_t pairs = stages_ / 2;
    for (std::size_t j = 0; j < m_; ++j)
      for (std::size_t i = 0; i < m_; ++i) {
        const double diagonal = i == j ? 1 / h_ : 0, entry = jacobian_(i, j);
        real_(i, j) = tableau_->gamma * diagonal - entry;
        for (std::size_t p = 0; p < pairs; ++p) complex_[p](i, j) = {tableau_->alpha[p] * diagonal - entry, tableau_->beta[p] * diagonal};
      }
    h_factored_ = h_;
    factored_ = real_.factor();
    for (std::size_t p = 0; p < pairs; ++p) factored_ = factored_ && complex_[p].factor();
    return factored_;
  }

  /// The iteration is given up; such a part of the step is tried next.
  bool fail(double part) {
    after_failure_ = part;
    return false;
  }

  /// What the values at the nodes weigh at s, with 0 at 0: Lagrange's polynomials.
  static void weights(const RadauTableau& tableau, double s, RadauTableau::Row& weight) {
    for (std::size_t k = 0; k < tableau.stages; ++k) {
      weight[k] = s / tableau.c[k];
      for (std::size_t j = 0; j < tableau.stages; ++j)
        if (j != k) weight[k] *= (s - tableau.c[j]) / (tableau.c[k] - tableau.c[j]);
    }
  }

  /// The polynomial of the step before, continued; zero where there is none.
  void start_values() {
    RadauTableau::Row weight;
    for (std::size_t k = 0; k < stages_; ++k) {
      if (of_before_ != nullptr) weights(*of_before_, 1 + tableau_->c[k] * h_ / h_of_before_, weight);
      for (std::size_t i = 0; i < n_; ++i) {
        double sum = 0;
        if (of_before_ != nullptr && i < m_) {
          const std::size_t s = of_before_->stages;
          for (std::size_t j = 0; j < s; ++j) sum += weight[j] * z_before_[j * n_ + i];
          sum -= z_before_[(s - 1) * n_ + i];
        }
        z_[k * n_ + i] = sum;
      }
    }
    transform(tableau_->T_inverse, z_, w_);
  }

  void transform(const std::array<RadauTableau::Row, most>& by, const double* from, double* to) const {
    RadauTableau::Row value;
    for (std::size_t i = 0; i < m_; ++i) {
      for (std::size_t k = 0; k < stages_; ++k) value[k] = from[k * n_ + i];
      for (std::size_t k = 0; k < stages_; ++k) {
        double sum = 0;
        for (std::size_t j = 0; j < stages_; ++j) sum += by[k][j] * value[j];
        to[k * n_ + i] = sum;
      }
    }
  }

  int evaluate_stages() {
    for (std::size_t k = 0; k < stages_; ++k) {
      for (std::size_t i = 0; i < n_; ++i) scratch_[i] = x0_[i] + z_[k * n_ + i];
      if (const int code = evaluate(t0_ + tableau_->c[k] * h_, scratch_, f_ + k * n_); code != 0) return code;
    }
    return std::all_of(f_, f_ + stages_ * n_, [](double value) { return std::isfinite(value); }) ? 0 : code_not_finite;
  }

  /// One simplified Newton iteration from stage derivatives in f_; returns the size of the correction.
  double correct() {
    transform(tableau_->T_inverse, f_, f_);
    for (std::size_t i = 0; i < m_; ++i) right_[i] = f_[i] - tableau_->gamma * w_[i] / h_;
    real_.solve(right_);
    double sum = 0;
    const auto scale = [&](std::size_t i) { return newton_scale(i); };
    const double part = norm([&](std::size_t i) { return right_[i]; }, scale);
    sum += part * part;
    for (std::size_t i = 0; i < m_; ++i) w_[i] += right_[i];
    for (std::size_t p = 0; p < stages_ / 2; ++p) {
      double *a = w_ + (1 + 2 * p) * n_, *b = a + n_;
      const double *fa = f_ + (1 + 2 * p) * n_, *fb = fa + n_;
      const double alpha = tableau_->alpha[p], beta = tableau_->beta[p];
      for (std::size_t i = 0; i < m_; ++i)
        pair_[i] = {fa[i] - (alpha * a[i] - beta * b[i]) / h_, fb[i] - (alpha * b[i] + beta * a[i]) / h_};
      complex_[p].solve(pair_.data());
      const double size = norm([&](std::size_t i) { return std::hypot(pair_[i].re, pair_[i].im); }, scale);
      sum += size * size;
      for (std::size_t i = 0; i < m_; ++i) a[i] += pair_[i].re, b[i] += pair_[i].im;
    }
    transform(tableau_->T, w_, z_);
    return std::sqrt(sum / static_cast<double>(stages_));
  }

  double newton_scale(std::size_t i) const {
    const double size = std::max(std::abs(x0_[i]), std::abs(x0_[i] + z_[(stages_ - 1) * n_ + i]));
    const double scale = fixed_ ? size : atol_ + rtol_ * size;
    return scale > 0 ? scale : std::max(std::abs(h_ * f0_[i]), 1e-300);
  }

  /// Newton's iteration; false with a code of the right-hand side, or 0 where it does not converge.
  bool iterate(int& code) {
    remaining_ = std::pow(std::max(remaining_, epsilon), 0.8);
    contraction_ = keep_jacobian;
    ToRounding to_rounding;
    double before = 0, ratio_before = 0;
    const int most_here = most_iterations();
    for (newton_ = 1; fixed_ || newton_ <= most_here; ++newton_) {
      if ((code = evaluate_stages()) != 0) return false;
      ++counts_.newton_iterations;
      const double size = correct();
      if (!std::isfinite(size)) return fail(0.5);
      if (fixed_) {
        const ToRounding::State state = to_rounding.see(size);
        contraction_ = to_rounding.contraction();
        if (state != ToRounding::State::goes_on) return state == ToRounding::State::converged || fail(0.5);
        continue;
      }
      if (newton_ > 1 && newton_ < most_here) {
        const double ratio = size / before;
        contraction_ = newton_ == 2 ? ratio : std::sqrt(ratio * ratio_before);
        ratio_before = ratio;
        if (contraction_ >= 0.99) return fail(0.5);
        remaining_ = contraction_ / (1 - contraction_);
        const int left = most_here - 1 - newton_;
        const double expected = remaining_ * size * std::pow(contraction_, left) / newton_tolerance_;
        if (expected >= 1) return fail(0.8 * std::pow(std::min(expected, 20.0), -1.0 / (4 + left)));
      }
      before = std::max(size, epsilon * epsilon);
      if (remaining_ * size <= newton_tolerance_) return true;
    }
    return fail(0.5);
  }

  /// x1, the quadratures and the filtered estimate.
  int finish() {
    made_with_ = tableau_;
    if (m_ < n_) {
      if (const int code = evaluate_stages(); code != 0) return code;
      for (std::size_t i = m_; i < n_; ++i)
        for (std::size_t k = 0; k < stages_; ++k) {
          double sum = 0;
          for (std::size_t j = 0; j < stages_; ++j) sum += tableau_->A[k][j] * f_[j * n_ + i];
          z_[k * n_ + i] = h_ * sum;
        }
    }
    for (std::size_t i = 0; i < n_; ++i) advance(i, z_[(stages_ - 1) * n_ + i]);
    for (std::size_t i = 0; i < m_; ++i) estimate_[i] = f0_[i] + defect_of_stages(i) / h_;
    real_.solve(estimate_);
    return 0;
  }

  double defect_of_stages(std::size_t i) const {
    double sum = 0;
    for (std::size_t k = 0; k < stages_; ++k) sum += tableau_->slope[k] * z_[k * n_ + i];
    return sum;
  }

  double step_quotient(double error) const {
    const int most_here = most_iterations();
    const double factor = std::min(safety, safety * (1 + 2 * most_here) / (newton_ + 2 * most_here));
    return std::clamp(std::pow(error, exponent()) / factor, 1 / most_growth, most_shrinking);
  }

  Lu<double> real_;
  std::array<Lu<Complex>, most / 2> complex_;
  std::vector<double> work_;
  std::vector<Complex> pair_;
  const RadauTableau *tableau_ = nullptr, *made_with_ = nullptr, *of_before_ = nullptr;  // of the step that comes, the last, the one before
  std::size_t stages_ = 3;
  bool chooses_;
  double *z_, *w_, *f_, *z_before_;  // stage increments, transformed, stage derivatives; of the step before
  double *estimate_, *right_;
  double tolerance_ = 0, asked_rtol_ = 0, asked_atol_ = 0, rtol_ = 0, atol_ = 0, newton_tolerance_ = 0;
  double h_factored_ = 0, h_of_before_ = 0;
  double contraction_ = 0, remaining_ = 1;
  double h_before_ = 0, error_before_ = 1;
  double after_failure_ = 0.25;
  int newton_ = 0, since_change_ = 0;
  bool jacobian_known_ = false, jacobian_here_ = false, jacobian_wanted_ = false, factored_ = false;
  bool accepted_ = false, rejected_ = false, order_changed_ = false, failed_ = false;
};

}  // namespace eom::implicit
