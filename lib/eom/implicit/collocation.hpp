// SPDX-License-Identifier: MIT
// Steps of Radau IIA with error control, for stiff systems: the common part of radau5, radau and ggl. Source: Hairer,
// Wanner, Solving Ordinary Differential Equations II, section IV.8. Simplified Newton iterations compute the stage
// increments, transformed so that one real and (s - 1)/2 complex matrices are factored. The error estimate has order s
// and is filtered by the real matrix. Step sizes are predicted from two steps (Gustafsson). df/dx and its factors are
// kept as long as Newton converges.
//
// The estimate has a lower order than the method. stage_tolerances.hpp determines its tolerance, so that the error of
// the step remains proportional to the requested tolerance. With fixed steps there is no estimate, and the iteration
// continues to rounding. A Method has name, order, dense_order, interpolate. A method with algebraic equations
// 0 = g(x, u) overrides the hooks below; u and g follow the state in each stage, and the motion in matrices.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "eom/implicit/base.hpp"
#include "eom/implicit/collocation_parts.hpp"
#include "eom/implicit/newton.hpp"
#include "eom/implicit/radau_tableau.hpp"
#include "eom/implicit/stage_tolerances.hpp"

namespace eom::implicit {

/// most: largest number of stages; for 3 the loops over stages are unrolled.
template <class Method, std::size_t most>
class Collocation : public Base, public CollocationHooks {
 public:
  static constexpr bool adaptive = true, error_uses_end = false;

  /// Computes the trial state at t1. Returns a code of the right-hand side, or code_no_convergence.
  int attempt(double t0, double t1) {
    open(t0, t1);
    if (jacobian_wanted_ || !jacobian_known_)
      if (const int code = new_jacobian(); code != 0) return code;
    if (!fixed_ && !std::exchange(begun_, true))
      if (const double fast = std::abs(h_) * jacobian_.estimate_spectral_radius(f_, f_ + n_);
          fast > first_step && std::isfinite(fast))
        return fail(first_step / fast), code_no_convergence;
    while (true) {
      if (!factored_ || std::abs(h_ - h_factored_) > same_step * std::abs(h_))
        if (!factor()) return fail(0.5), code_no_convergence;
      start_values();
      int code = 0;
      if (iterate(code)) break;
      if (code != 0) return code;
      ++counts_.newton_failures;
      if (jacobian_here_) return code_no_convergence;
      if ((code = new_jacobian()) != 0) return code;
    }
    return finish();
  }

  double error_norm(double, double) {
    const auto scale = [&](std::size_t i) {
      return tolerances_.atol + tolerances_.rtol * std::max(std::abs(x0_[i]), std::abs(x1_[i]));
    };
    double error = norm([&](std::size_t i) { return estimate_[i]; }, scale);
    if (error >= 1 && (rejected_ || !accepted_)) {  // filtered again: a stiff start has a weaker requirement
      for (std::size_t i = 0; i < n_; ++i) scratch_[i] = x0_[i] + (i < m_ ? estimate_[i] : 0);
      if (evaluate(t0_, scratch_, f_) == 0) {
        filter(f_, right_.data());
        const double again = norm([&](std::size_t i) { return right_[i]; }, scale);
        if (std::isfinite(again)) error = again;
      }
    }
    return std::max(error, 1e-10);
  }

  double after_accepted(double h, double error) {
    double quotient = step_quotient(error);
    if (accepted_ && !stages_changed_) {
      const double predicted = h_before_ / h * std::pow(error * error / error_before_, exponent()) / safety;
      quotient = std::max(quotient, std::clamp(predicted, 1 / most_growth, most_shrinking));
    }
    h_before_ = h;
    error_before_ = std::max(error, 1e-2);
    double next = h / quotient;
    if (rejected_) next = std::min(next, h);
    stages_changed_ = false;
    method().choose_stages(next / h);
    rejected_ = false;
    accepted_ = true;
    if (!stages_changed_ && contraction_ <= keep_jacobian && next >= h && next <= 1.2 * h)
      return h;  // the factors are kept
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

  static void interpolate(const void* method, double t, double* x) {
    static_cast<const Method*>(method)->interpolate(t, x);
  }

  /// Number of stages of the next step.
  std::size_t stages() const { return most == 3 ? 3 : stages_; }

 protected:
  static constexpr double safety = 0.9, most_growth = 8, most_shrinking = 5;
  static constexpr double keep_jacobian = 1e-3;  // of Newton's contraction
  // Limit on h |lambda| of the fastest motion. In longer steps the filter of the estimate would treat an impact like a
  // motion that has decayed.
  static constexpr double first_step = 1, same_step = 1e-9;

  Collocation(System& system, std::span<const double> x, const Options& options, std::size_t stages,
              std::size_t algebraic = 0)
      : Base(system, x, options, Jacobian::Differences::one_sided),
        extra_(algebraic),
        length_(n_ + algebraic),
        real_(m_ + algebraic),
        complex_(most / 2, Lu<Complex>(m_ + algebraic)),
        units_(m_, m_ + algebraic),
        tolerances_(options, x.first(m_)),
        work_(4 * most * length_),
        estimate_(length_),
        right_(length_),
        pair_(m_ + algebraic) {
    double* next = work_.data();
    for (double** block : {&z_, &w_, &f_, &z_before_}) *block = std::exchange(next, next + most * length_);
    use(stages);
  }

  Method& method() { return static_cast<Method&>(*this); }

  double exponent() const { return 1 / static_cast<double>(stages() + 1); }
  int most_iterations() const { return 7 + 5 * static_cast<int>(stages() - 3) / 2; }

  /// act(index in a stage, row of the matrices) for the motion, then for algebraic unknowns.
  template <class Act>
  void each_unknown(Act act) const {
    for (std::size_t i = 0; i < m_; ++i) act(i, i);
    for (std::size_t j = 0; j < extra_; ++j) act(n_ + j, m_ + j);
  }

  void use(std::size_t s) {
    stages_ = s;
    tableau_ = &RadauTableau::of(s);
    tolerances_.use(s);
    factored_ = false;
    stages_changed_ = true;
  }

  int new_jacobian() {
    int code = jacobian_.evaluate(t0_, x0_, f0_, h_, counts_);
    if (code == 0) code = method().linearise();
    jacobian_known_ = jacobian_here_ = code == 0;
    jacobian_wanted_ = factored_ = false;
    return code;
  }

  bool factor() {
    ++counts_.factorisations;
    const std::size_t pairs = stages() / 2;
    const double inverse = 1 / h_;
    for (std::size_t j = 0; j < m_; ++j)
      for (std::size_t i = 0; i < m_; ++i) {
        const double diagonal = i == j ? inverse : 0, entry = jacobian_(i, j);
        real_(i, j) = tableau_->gamma * diagonal - entry;
        for (std::size_t p = 0; p < pairs; ++p)
          complex_[p](i, j) = {tableau_->alpha[p] * diagonal - entry, tableau_->beta[p] * diagonal};
      }
    method().border(real_);
    for (std::size_t p = 0; p < pairs; ++p) method().border(complex_[p]);
    h_factored_ = h_;
    factored_ = real_.factor();
    for (std::size_t p = 0; p < pairs; ++p) factored_ = factored_ && complex_[p].factor();
    return factored_;
  }

  /// Gives up the iteration; the next trial has the fraction `part` of the step.
  bool fail(double part) {
    after_failure_ = part;
    return false;
  }

  /// The collocation polynomial of the last step; moved: towards x1, by after_step and by rounding.
  double polynomial(const RadauTableau::Row& weight, double s, std::size_t i) const {
    double sum = 0;
    each_stage<most>(*made_with_, [&](std::size_t k) { sum += weight[k] * z_[k * length_ + i]; });
    const double moved = x1_[i] - (x0_[i] + z_[(made_with_->stages - 1) * length_ + i]);
    return sum + s * moved;
  }

  /// Dense output of order 4 of a step of three stages.
  void interpolate_three_stages(double t, double* x) const {
    const double s = (t - t0_) / h_;
    RadauTableau::Row weight;
    stage_weights<3>(*made_with_, s, weight);
    const auto towards_slope = [&](std::size_t i) {
      return i < m_ ? made_with_->gamma * estimate_[i] : h_ * f0_[i] + defect(i);
    };
    for (std::size_t i = 0; i < n_; ++i) x[i] = x0_[i] + (polynomial(weight, s, i) + bump(s) * towards_slope(i));
  }

  /// Extrapolates the polynomial of the previous step. Zero if there is none, and for algebraic unknowns.
  void start_values() {
    RadauTableau::Row weight;
    std::fill_n(z_, stages() * length_, 0.0);
    for (std::size_t k = 0; k < stages() && of_before_ != nullptr; ++k) {
      stage_weights<most>(*of_before_, 1 + tableau_->c[k] * h_ / h_of_before_, weight);
      const double* const end = z_before_ + (of_before_->stages - 1) * length_;
      for (std::size_t i = 0; i < m_; ++i) {
        double sum = -end[i];
        each_stage<most>(*of_before_, [&](std::size_t j) { sum += weight[j] * z_before_[j * length_ + i]; });
        z_[k * length_ + i] = sum;
      }
    }
    transform(tableau_->T_inverse, z_, w_);
  }

  void transform(const std::array<RadauTableau::Row, RadauTableau::most>& by, const double* from, double* to) const {
    std::array<double, most> value;
    each_unknown([&](std::size_t i, std::size_t) {
      each_stage<most>(*tableau_, [&](std::size_t k) { value[k] = from[k * length_ + i]; });
      each_stage<most>(*tableau_, [&](std::size_t k) {
        double sum = 0;
        each_stage<most>(*tableau_, [&](std::size_t j) { sum += by[k][j] * value[j]; });
        to[k * length_ + i] = sum;
      });
    });
  }

  int evaluate_stages() {
    for (std::size_t k = 0; k < stages(); ++k) {
      const double* z = z_ + k * length_;
      double* f = f_ + k * length_;
      const double t = t0_ + tableau_->c[k] * h_;
      for (std::size_t i = 0; i < n_; ++i) scratch_[i] = x0_[i] + z[i];
      if (const int code = evaluate(t, scratch_, f); code != 0) return code;
      if (const int code = method().add_algebraic(t, scratch_, z + n_, f); code != 0) return code;
    }
    const auto is_finite = [](double value) { return std::isfinite(value); };
    return std::all_of(f_, f_ + stages() * length_, is_finite) ? 0 : code_not_finite;
  }

  /// Makes one simplified Newton iteration from stage derivatives in f_. Returns the size of the correction.
  double correct() {
    transform(tableau_->T_inverse, f_, f_);
    const double inverse = 1 / h_;
    const auto per_h = [&](std::size_t row) { return row < m_ ? inverse : 0; };  // algebraic rows have no derivative
    each_unknown([&](std::size_t i, std::size_t row) { right_[row] = f_[i] - tableau_->gamma * w_[i] * per_h(row); });
    real_.solve(right_.data());
    const double part =
        norm([&](std::size_t i) { return right_[i]; }, [&](std::size_t i) { return newton_scale(i, right_[i]); });
    double sum = part * part;
    each_unknown([&](std::size_t i, std::size_t row) { w_[i] += right_[row]; });
    for (std::size_t p = 0; p < stages() / 2; ++p) {
      double *a = w_ + (1 + 2 * p) * length_, *b = a + length_;
      const double *fa = f_ + (1 + 2 * p) * length_, *fb = fa + length_;
      const double alpha = tableau_->alpha[p], beta = tableau_->beta[p];
      each_unknown([&](std::size_t i, std::size_t row) {
        pair_[row] = {fa[i] - (alpha * a[i] - beta * b[i]) * per_h(row),
                      fb[i] - (alpha * b[i] + beta * a[i]) * per_h(row)};
      });
      complex_[p].solve(pair_.data());
      const auto of_pair = [&](std::size_t i) {
        return std::sqrt(pair_[i].re * pair_[i].re + pair_[i].im * pair_[i].im);
      };
      const double size = norm(of_pair, [&](std::size_t i) { return newton_scale(i, of_pair(i)); });
      sum += size * size;
      each_unknown([&](std::size_t i, std::size_t row) { a[i] += pair_[row].re, b[i] += pair_[row].im; });
    }
    transform(tableau_->T, w_, z_);
    return std::sqrt(sum / static_cast<double>(stages()));
  }

  double newton_scale(std::size_t i, double correction) const {
    const double size = std::max(std::abs(x0_[i]), std::abs(x0_[i] + z_[(stages() - 1) * length_ + i]));
    if (fixed_) return units_(i, size, correction);
    const double scale = tolerances_.atol + tolerances_.rtol * size;
    return scale > 0 ? scale : std::max(std::abs(h_ * f0_[i]), 1e-300);
  }

  /// Newton's iteration. False with a code of the right-hand side, or with 0 if it does not converge.
  bool iterate(int& code) {
    remaining_ = std::pow(std::max(remaining_, epsilon), 0.8);
    contraction_ = keep_jacobian;
    if (fixed_)
      units_.compute(
          jacobian_, x0_, f0_, h_, 1, [&](double* w) { real_.solve(w); },
          [&](double* w, const auto& size) { method().border_units(w, size); });
    RoundingConvergence convergence;
    double before = 0, ratio_before = 0;
    const int most_here = most_iterations();
    for (newton_ = 1; fixed_ || newton_ <= most_here; ++newton_) {
      if ((code = evaluate_stages()) != 0) return false;
      ++counts_.newton_iterations;
      const double size = correct();
      if (!std::isfinite(size)) return fail(0.5);
      if (fixed_) {
        const RoundingConvergence::State state = convergence.update(size);
        contraction_ = convergence.contraction();
        if (state != RoundingConvergence::State::iterating)
          return state == RoundingConvergence::State::converged || fail(0.5);
        continue;
      }
      if (newton_ > 1 && newton_ < most_here) {
        const double ratio = size / before;
        contraction_ = newton_ == 2 ? ratio : std::sqrt(ratio * ratio_before);
        ratio_before = ratio;
        if (contraction_ >= 0.99) return fail(0.5);
        remaining_ = contraction_ / (1 - contraction_);
        const int left = most_here - 1 - newton_;
        const double expected = remaining_ * size * std::pow(contraction_, left) / tolerances_.newton;
        if (expected >= 1) return fail(0.8 * std::pow(std::min(expected, 20.0), -1.0 / (4 + left)));
      }
      before = std::max(size, epsilon * epsilon);
      if (remaining_ * size <= tolerances_.newton) return true;
    }
    return fail(0.5);
  }

  /// Computes x1, the quadratures and the filtered estimate.
  int finish() {
    made_with_ = tableau_;
    if (const int code = method().correct_last_stage(); code != 0) return code;
    const std::size_t s = stages();
    if (m_ < n_) {
      if (const int code = evaluate_stages(); code != 0) return code;
      for (std::size_t i = m_; i < n_; ++i)
        for (std::size_t k = 0; k < s; ++k) {
          double sum = 0;
          for (std::size_t j = 0; j < s; ++j) sum += tableau_->A[k][j] * f_[j * length_ + i];
          z_[k * length_ + i] = h_ * sum;
        }
    }
    for (std::size_t i = 0; i < n_; ++i) advance(i, z_[(s - 1) * length_ + i]);
    filter(f0_, estimate_.data());
    return 0;
  }

  /// The difference between f at the start and the slope of the collocation polynomial there, filtered by the real
  /// matrix.
  void filter(const double* f, double* result) {
    for (std::size_t i = 0; i < m_; ++i) result[i] = f[i] + defect(i) / h_;
    std::fill_n(result + m_, extra_, 0.0);
    real_.solve(result);
  }

  /// Minus h times the slope of the collocation polynomial at the start.
  double defect(std::size_t i) const {
    double sum = 0;
    each_stage<most>(*made_with_, [&](std::size_t k) { sum += made_with_->slope[k] * z_[k * length_ + i]; });
    return sum;
  }

  double step_quotient(double error) const {
    const int most_here = most_iterations();
    const double factor = std::min(safety, safety * (1 + 2 * most_here) / (newton_ + 2 * most_here));
    return std::clamp(std::pow(error, exponent()) / factor, 1 / most_growth, most_shrinking);
  }

  std::size_t extra_, length_;  // number of algebraic unknowns; length of a stage
  Lu<double> real_;
  std::vector<Lu<Complex>> complex_;
  CorrectionUnits units_;
  StageTolerances tolerances_;
  std::vector<double> work_, estimate_, right_;
  std::vector<Complex> pair_;
  // Of the next step, the last one and the one before.
  const RadauTableau *tableau_ = nullptr, *made_with_ = nullptr, *of_before_ = nullptr;
  std::size_t stages_ = 3;
  double *z_, *w_, *f_, *z_before_;  // stage increments, transformed, stage derivatives; of the previous step
  double h_factored_ = 0, h_of_before_ = 0;
  double contraction_ = 0, remaining_ = 1;
  double h_before_ = 0, error_before_ = 1;
  double after_failure_ = 0.25;
  int newton_ = 0;
  bool jacobian_known_ = false, jacobian_here_ = false, jacobian_wanted_ = false, factored_ = false;
  bool begun_ = false, accepted_ = false, rejected_ = false, stages_changed_ = false;
};

}  // namespace eom::implicit
