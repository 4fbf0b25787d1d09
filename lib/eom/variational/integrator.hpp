// SPDX-License-Identifier: MIT
// Variational integrators with fixed steps: symplectic in (q, p), symmetric in time, with holonomic constraints.
// Source: Marsden, West, Discrete mechanics and variational integrators, Acta Numerica 10 (2001), sections 2.3, 2.7
// and 3.5. The discrete Lagrangian is L_d(q0, q1) = h L((q0 + q1)/2, (q1 - q0)/h) at the time of the middle. With p and
// its rate g = dL/dq there
//   p0 + A(q0)^T l = p - h/2 g,   psi(q1) = 0,   p1 = p + h/2 g + A(q1)^T l1,   A(q1) qdot1 + b = 0;
// g includes forces without a potential (d'Alembert's principle in discrete form). Orders 4 and 6 are compositions of
// such steps. Newton's iteration continues to rounding. Its matrix, by differences, is kept as long as it converges
// fast. Momenta are carried from step to step with their rounding; velocities follow from them. Dense output: the
// Hermite cubic, of order 3 within a step.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "eom/implicit/base.hpp"
#include "eom/implicit/hermite.hpp"
#include "eom/system.hpp"
#include "eom/variational/composition.hpp"

namespace eom::variational {

inline constexpr Refusal refusals[] = {
    {Feature::modes, ", and no discrete Lagrangian has these"},
    {Feature::velocity_constraints,
     ", which follows from no Lagrangian; variational integrators take constraints on positions"},
    {Feature::kinks, ", where the discrete Lagrangian has no derivative"},
    {Feature::other_states, ", which has no momentum"},
    {Feature::charts, "an exchange is not symplectic"}};

/// A vector with compensated summation.
class Summed {
 public:
  Summed(double* values, double* rest) : values_(values), rest_(rest) {}
  double operator[](std::size_t i) const { return values_[i]; }
  void set(std::size_t i, double value) { values_[i] = value, rest_[i] = 0; }
  void add(std::size_t i, double increment) {
    increment += rest_[i];
    const double sum = values_[i] + increment, taken = sum - values_[i];
    rest_[i] = (values_[i] - (sum - taken)) + (increment - taken);
    values_[i] = sum;
  }
  const double* data() const { return values_; }

 private:
  double *values_, *rest_;
};

template <class Composition>
class Integrator : public implicit::Base {
 public:
  static constexpr const char* name = Composition::name;
  static constexpr int order = Composition::order;
  static constexpr int dense_order = std::min(order, 3);
  static constexpr bool adaptive = false;
  static constexpr bool error_uses_end = false;
  static constexpr Needs needs{.required = {Feature::momenta},
                               .refuses = refusals,
                               .alternative = "midpoint, which is symplectic as well",
                               .keeps_constraints = true};

  /// Throws std::invalid_argument if the state does not match the system.
  static void check(const System& system, double, std::span<const double> x0, const Options& options) {
    if (2 * system.coordinates + options.quadratures != x0.size())
      throw std::invalid_argument("eom::integrate: " + std::string(name) +
                                  " needs a state of coordinates, velocities and quadratures");
  }

  Integrator(System& system, std::span<const double> x, const Options& options)
      : Base(system, x, options, implicit::Jacobian::Differences::one_sided),
        of_(system),
        c_(system.coordinates),
        k_(system.constraints),
        lu_(c_ + k_),
        end_(c_ + k_),
        work_(5 * n_ + 12 * c_ + 3 * k_ + 2 * c_ * k_ + 2 * c_ * c_) {
    double* next = work_.data();
    const auto take = [&](std::size_t count) { return std::exchange(next, next + count); };
    at_ = take(n_), middle_ = take(n_), quadrature_ = take(n_);
    q_ = take(n_), q_rest_ = take(n_);
    p_ = take(c_), p_rest_ = take(c_), p_start_ = take(c_), p_rest_start_ = take(c_);
    d_ = take(c_), momentum_ = take(c_), rate_ = take(c_), right_ = take(c_ + k_);
    p_moved_ = take(c_), rate_moved_ = take(c_), b_ = take(k_), psi_ = take(k_);
    A0_ = take(c_ * k_), A1_ = take(c_ * k_), matrix_ = take(c_ * c_), M_ = take(c_ * c_);
    l_.resize(k_);
  }

  /// Computes the trial state at t1. Returns a code of the right-hand side, or code_no_convergence.
  int attempt(double t0, double t1) {
    open(t0, t1);
    Summed q(q_, q_rest_), p(p_, p_rest_);
    for (std::size_t i = 0; i < n_; ++i) q_[i] = x0_[i], q_rest_[i] = carry_[i];
    if (momenta_known_) {
      std::copy_n(p_start_, c_, p_), std::copy_n(p_rest_start_, c_, p_rest_);
    } else if (const int code = first_momenta(p); code != 0) {
      return code;
    }
    double t = t0;
    for (std::size_t s = 0; s < Composition::substeps.size(); ++s) {
      const double h = Composition::substeps[s] * h_;
      const double end = s + 1 == Composition::substeps.size() ? t1 : t + h;
      if (const int code = substep(t, end, h, q, p); code != 0) return code;
      t = end;
    }
    std::copy_n(q_, n_, x1_), std::copy_n(q_rest_, n_, new_carry_);
    return 0;
  }

  // no error estimate and no step size control
  double error_norm(double, double) { return 0; }
  double after_accepted(double h, double) { return h; }
  double after_rejected(double h, double) { return h; }
  double after_failed(double h) { return h; }

  void accept(bool moved) {
    momenta_known_ = !moved;
    std::copy_n(p_, c_, p_start_), std::copy_n(p_rest_, c_, p_rest_start_);
    swap_ends(moved);
  }

  static void interpolate(const void* method, double t, double* x) {
    static_cast<const Integrator*>(method)->interpolate(t, x);
  }

  void interpolate(double t, double* x) const { implicit::hermite((t - t0_) / h_, h_, n_, x0_, f0_, x1_, f1_, x); }

 private:
  static constexpr double keep_matrix = 1e-2;  // of the contraction of Newton's iteration
  static constexpr int most_iterations = 50;
  static constexpr double at_rounding = 1e-8, sure_rounding = 1e-15;
  // The neglected remainder has the same sign in every step and accumulates. Compensated sums resolve more than a
  // rounding of q.
  static constexpr double negligible = epsilon / 1024;
  static constexpr double still = 1e-6;  // of the largest coordinate: smaller coordinates are treated as 0

  int momenta(double t, const double* x, double* p, double* rate) {
    ++counts_.rhs_evaluations;
    const int code = of_.momenta(of_.self, t, x, p, rate);
    if (code != 0) return code;
    const auto finite = [](double value) { return std::isfinite(value); };
    return std::all_of(p, p + c_, finite) && std::all_of(rate, rate + c_, finite) ? 0 : code_not_finite;
  }

  int first_momenta(Summed& p) {
    if (const int code = momenta(t0_, x0_, momentum_, rate_); code != 0) return code;
    for (std::size_t i = 0; i < c_; ++i) p.set(i, momentum_[i]);
    return 0;
  }

  int constrain(double t, const double* x, double* A) {
    return k_ == 0 ? 0 : of_.constrain(of_.self, t, x, psi_, A, b_);
  }

  /// Evaluates the state in the middle, with momentum_ and rate_, for a displacement d of q in the time h.
  int evaluate_middle(double t, double h, const Summed& q, double* p, double* rate) {
    for (std::size_t i = 0; i < c_; ++i) middle_[i] = q[i] + 0.5 * d_[i], middle_[c_ + i] = d_[i] / h;
    for (std::size_t i = 2 * c_; i < n_; ++i) middle_[i] = q[i];
    return momenta(t + 0.5 * h, middle_, p, rate);
  }

  int substep(double t, double t_end, double h, Summed& q, Summed& p) {
    if (const int code = constrain(t, q.data(), A0_); code != 0) return code;
    for (bool anew = matrix_wanted_;; anew = true) {
      start_values(h, q);
      if (anew || std::abs(h - h_factored_) > 1e-9 * std::abs(h)) {
        if (const int code = new_matrix(t, h, q); code != 0) return code;
        anew = true;
      }
      const int code = iterate(t, t_end, h, q, p);
      if (code == 0) break;
      if (code != code_no_convergence) return code;
      ++counts_.newton_failures;
      if (anew) return code;
    }
    return finish(t, t_end, h, q, p);
  }

  /// Start values from the velocity at the start; the iteration corrects them.
  void start_values(double h, const Summed& q) {
    for (std::size_t i = 0; i < c_; ++i) d_[i] = h * q[c_ + i];
    std::fill(l_.begin(), l_.end(), 0.0);
  }

  /// d(p - h/2 g)/dd by differences, bordered by the constraints.
  int new_matrix(double t, double h, const Summed& q) {
    ++counts_.jacobians;
    const std::size_t before = counts_.rhs_evaluations;
    if (const int code = evaluate_middle(t, h, q, momentum_, rate_); code != 0) return code;
    double largest = 0;
    for (std::size_t i = 0; i < c_; ++i) largest = std::max({largest, std::abs(q[i]), std::abs(d_[i])});
    for (std::size_t j = 0; j < c_; ++j) {
      const double kept = d_[j];
      const double size = std::max({std::abs(q[j]), std::abs(kept), 1e-3 * largest});
      d_[j] = kept + 1.5e-8 * (size > 0 ? size : 1);
      const double by = d_[j] - kept;
      const int code = evaluate_middle(t, h, q, p_moved_, rate_moved_);
      d_[j] = kept;
      if (code != 0) return code;
      for (std::size_t i = 0; i < c_; ++i)
        matrix_[i + c_ * j] = ((p_moved_[i] - momentum_[i]) - 0.5 * h * (rate_moved_[i] - rate_[i])) / by;
    }
    counts_.difference_evaluations += counts_.rhs_evaluations - before;
    h_factored_ = h;
    return factor(t, h, q);
  }

  int factor(double t, double h, const Summed& q) {
    for (std::size_t i = 0; i < c_; ++i) at_[i] = q[i] + d_[i], at_[c_ + i] = d_[i] / h;
    if (const int code = constrain(t + h, at_, A1_); code != 0) return code;
    ++counts_.factorisations;
    border(lu_, matrix_, A1_, A0_);
    return lu_.factor() ? 0 : code_no_convergence;
  }

  /// (block, -columns^T; rows, 0).
  void border(Lu<double>& lu, const double* block, const double* rows, const double* columns) {
    for (std::size_t j = 0; j < c_; ++j)
      for (std::size_t i = 0; i < c_; ++i) lu(i, j) = block[i + c_ * j];
    for (std::size_t k = 0; k < k_; ++k) {
      for (std::size_t i = 0; i < c_; ++i) lu(i, c_ + k) = -columns[k + k_ * i], lu(c_ + k, i) = rows[k + k_ * i];
      for (std::size_t j = 0; j < k_; ++j) lu(c_ + j, c_ + k) = 0;
    }
  }

  double transposed(const double* A, const std::vector<double>& by, std::size_t i) const {
    double sum = 0;
    for (std::size_t k = 0; k < k_; ++k) sum += A[k + k_ * i] * by[k];
    return sum;
  }

  int iterate(double t, double t_end, double h, const Summed& q, const Summed& p) {
    double before = 0, least = 0;
    int grown = 0;
    int stalled = 0;  // corrections that did not halve the smallest one; at rounding they may cycle
    for (int iteration = 1; iteration <= most_iterations; ++iteration) {
      if (const int code = evaluate_middle(t, h, q, momentum_, rate_); code != 0) return code;
      ++counts_.newton_iterations;
      for (std::size_t i = 0; i < c_; ++i)
        right_[i] = (p[i] - momentum_[i]) + 0.5 * h * rate_[i] + transposed(A0_, l_, i);
      for (std::size_t i = 0; i < c_; ++i) at_[i] = q[i] + d_[i], at_[c_ + i] = d_[i] / h;
      if (const int code = constrain(t_end, at_, A1_); code != 0) return code;
      for (std::size_t k = 0; k < k_; ++k) right_[c_ + k] = -psi_[k];
      lu_.solve(right_);
      double size = 0, largest = 1e-300;
      for (std::size_t i = 0; i < c_; ++i) largest = std::max({largest, std::abs(q[i]), std::abs(d_[i])});
      for (std::size_t i = 0; i < c_; ++i) {
        d_[i] += right_[i];
        const double part = right_[i] / std::max({std::abs(q[i]), std::abs(d_[i]), still * largest});
        size += part * part / static_cast<double>(c_);
      }
      for (std::size_t k = 0; k < k_; ++k) l_[k] += right_[c_ + k];
      size = std::sqrt(size);
      if (size == 0) return 0;
      if (!std::isfinite(size)) return code_no_convergence;
      if (iteration > 1) {
        const double ratio = size / before;
        if (iteration == 2) matrix_wanted_ = ratio > keep_matrix;
        if (ratio < 0.5 && ratio / (1 - ratio) * size <= negligible) return 0;
        if (size > 0.5 * least && ++stalled >= (least < sure_rounding ? 2 : 6) && least < at_rounding)
          return 0;  // only rounding remains
        // One correction may grow: coordinates that have moved far contribute little to `size`, and their corrections
        // move others.
        if (ratio > 2 && size > at_rounding && ++grown == 3) return code_no_convergence;
      }
      before = size;
      least = iteration == 1 ? size : std::min(least, size);
    }
    return code_no_convergence;
  }

  /// Computes q, p, quadratures and velocities at the end of the substep.
  int finish(double t, double t_end, double h, Summed& q, Summed& p) {
    if (const int code = evaluate_middle(t, h, q, momentum_, rate_); code != 0) return code;
    if (n_ > 2 * c_) {
      if (const int code = evaluate(t + 0.5 * h, middle_, quadrature_); code != 0) return code;
      for (std::size_t i = 2 * c_; i < n_; ++i) q.add(i, h * quadrature_[i]);
    }
    for (std::size_t i = 0; i < c_; ++i) {
      q.add(i, d_[i]);
      p.add(i, h * rate_[i] + transposed(A0_, l_, i));
    }
    return velocities(t_end, h, q, p);
  }

  /// Solves p(q, qdot) = p + A^T l, A qdot + b = 0: linear in qdot, but solved twice to reduce rounding.
  int velocities(double t, double h, Summed& q, Summed& p) {
    for (std::size_t i = 0; i < c_; ++i) q.set(c_ + i, d_[i] / h);
    if (const int code = of_.mass(of_.self, t, q.data(), M_); code != 0) return code;
    if (const int code = constrain(t, q.data(), A1_); code != 0) return code;
    border(end_, M_, A1_, A1_);
    if (!end_.factor()) return code_no_convergence;
    std::fill(l_.begin(), l_.end(), 0.0);
    for (int round = 0; round < 2; ++round) {
      if (const int code = momenta(t, q.data(), momentum_, rate_); code != 0) return code;
      for (std::size_t i = 0; i < c_; ++i) right_[i] = (p[i] - momentum_[i]) + transposed(A1_, l_, i);
      for (std::size_t k = 0; k < k_; ++k) {
        double sum = b_[k];
        for (std::size_t i = 0; i < c_; ++i) sum += A1_[k + k_ * i] * q[c_ + i];
        right_[c_ + k] = -sum;
      }
      end_.solve(right_);
      for (std::size_t i = 0; i < c_; ++i) q.set(c_ + i, q[c_ + i] + right_[i]);
      for (std::size_t k = 0; k < k_; ++k) l_[k] += right_[c_ + k];
    }
    for (std::size_t i = 0; i < c_; ++i) p.add(i, transposed(A1_, l_, i));
    return 0;
  }

  System& of_;
  std::size_t c_, k_;  // coordinates, constraints
  Lu<double> lu_, end_;
  std::vector<double> work_, l_;
  double *at_, *middle_, *quadrature_, *q_, *q_rest_, *p_, *p_rest_, *p_start_, *p_rest_start_;
  double *d_, *momentum_, *rate_, *right_, *p_moved_, *rate_moved_, *b_, *psi_, *A0_, *A1_, *matrix_, *M_;
  double h_factored_ = 0;
  bool momenta_known_ = false, matrix_wanted_ = true;
};

}  // namespace eom::variational
