// SPDX-License-Identifier: MIT
// A Rosenbrock method for stiff systems: each stage is one linear solve with df/dx at the start of the step, without
// iteration. Coefficients: rodas5p.hpp. Source: Hairer, Wanner, Solving Ordinary Differential Equations II, section
// IV.7. Its order requires accurate df/dx and df/dt; if they are not given, central differences are used. Quadratures
// are integrated by Lobatto's rule along the dense output, so that df/dx does not contain them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "eom/explicit_rk/controller.hpp"
#include "eom/implicit/base.hpp"
#include "eom/implicit/rodas5p.hpp"

namespace eom::implicit {

/// The method `rodas`.
class Rodas : public Base {
  using T = Rodas5p;

 public:
  static constexpr const char* name = "rodas";
  static constexpr int order = T::order;
  static constexpr int dense_order = T::dense_order;
  static constexpr bool adaptive = true;
  static constexpr bool error_uses_end = false;
  static constexpr Needs needs{.used = {Feature::jacobian}};

  Rodas(System& system, std::span<const double> x, const Options& options)
      : Base(system, x, options, Jacobian::Differences::central),
        controller_(control()),
        lu_(m_),
        work_((T::stages + 1 + 3 + 4) * n_) {
    double* next = work_.data();
    u_ = std::exchange(next, next + T::stages * n_);
    f_ = std::exchange(next, next + n_);
    dense_ = std::exchange(next, next + 3 * n_);
    rates_ = next;
  }

  /// Computes the trial state at t1. Returns a code of the right-hand side, or code_no_convergence for a singular
  /// matrix.
  int attempt(double t0, double t1) {
    open(t0, t1);
    if (!jacobian_here_)
      if (const int code = jacobian_.evaluate(t0_, x0_, f0_, h_, counts_); code != 0) return code;
    jacobian_here_ = true;
    if (!factor()) return code_no_convergence;
    for (std::size_t stage = 0; stage < T::stages; ++stage)
      if (const int code = solve_stage(stage); code != 0) return code;
    for (std::size_t i = 0; i < m_; ++i) {
      advance(i, sum(T::b.data(), i, T::stages));
      for (std::size_t l = 0; l < 3; ++l) dense_[l * n_ + i] = sum(T::dense[l], i, T::stages);
    }
    return m_ < n_ ? integrate_quadratures() : 0;
  }

  double error_norm(double rtol, double atol) const {
    return norm([&](std::size_t i) { return u_[(T::stages - 1) * n_ + i]; },
                [&](std::size_t i) { return atol + rtol * std::max(std::abs(x0_[i]), std::abs(x1_[i])); });
  }

  double after_accepted(double h, double error) { return controller_.after_accepted(h, error); }
  double after_rejected(double h, double error) { return controller_.after_rejected(h, error); }
  double after_failed(double h) { return controller_.after_failed(h); }

  void accept(bool moved) {
    jacobian_here_ = false;
    swap_ends(moved);
  }

  static void interpolate(const void* method, double t, double* x) {
    static_cast<const Rodas*>(method)->interpolate(t, x);
  }

  void interpolate(double t, double* x) const {
    const double s = (t - t0_) / h_;
    motion_at(s, x);
    for (std::size_t i = m_; i < n_; ++i) {
      const double rates[4]{rates_[i], rates_[n_ + i], rates_[2 * n_ + i], rates_[3 * n_ + i]};
      x[i] = quadrature(s, x0_[i], h_, rates);
    }
  }

  static explicit_rk::Controller control() { return {{0.9, 0, 0.2, 6}, order}; }

  /// The dense output of one component at s = (t - t0)/h; bend: its three weighted rows.
  static double motion(double s, double x0, double x1, const std::array<double, 3>& bend) {
    return (1 - s) * x0 + s * (x1 + (1 - s) * (bend[0] + s * (bend[1] + s * bend[2])));
  }
  /// For a quadrature: the integral of the cubic through its derivatives at Lobatto's nodes 0, node, 1 - node, 1.
  static double quadrature(double s, double x0, double h, const double (&g)[4]) {
    const double d01 = (g[1] - g[0]) / node, d12 = (g[2] - g[1]) / (1 - 2 * node), d23 = (g[3] - g[2]) / node;
    const double d012 = (d12 - d01) / (1 - node), d123 = (d23 - d12) / (1 - node), d = d123 - d012;
    const double of_1 = d01 - node * d012 + 0.2 * d, of_2 = d012 - d;  // node (1 - node) = 1/5
    return x0 + h * s * (g[0] + s * (of_1 / 2 + s * (of_2 / 3 + s * d / 4)));
  }
  static constexpr double node = 0.2763932022500210303590826;  // (1 - 1/sqrt 5)/2

 private:
  bool factor() {
    ++counts_.factorisations;
    for (std::size_t j = 0; j < m_; ++j)
      for (std::size_t i = 0; i < m_; ++i) lu_(i, j) = (i == j ? 1 / (h_ * T::gamma) : 0) - jacobian_(i, j);
    return lu_.factor();
  }

  double sum(const double* weights, std::size_t i, std::size_t stages) const {
    double total = 0;
    for (std::size_t j = 0; j < stages; ++j) total += weights[j] * u_[j * n_ + i];
    return total;
  }

  int solve_stage(std::size_t stage) {
    const double* f = f0_;
    if (stage > 0) {
      for (std::size_t i = 0; i < n_; ++i) scratch_[i] = x0_[i] + (i < m_ ? sum(T::a[stage], i, stage) : 0);
      if (const int code = evaluate(t0_ + T::c[stage] * h_, scratch_, f_); code != 0) return code;
      f = f_;
    }
    double* u = u_ + stage * n_;
    for (std::size_t i = 0; i < m_; ++i)
      u[i] = f[i] + sum(T::C[stage], i, stage) / h_ + T::d[stage] * h_ * jacobian_.dfdt(i);
    lu_.solve(u);
    return 0;
  }

  void motion_at(double s, double* x) const {
    for (std::size_t i = 0; i < m_; ++i)
      x[i] = motion(s, x0_[i], x1_[i], {dense_[i], dense_[n_ + i], dense_[2 * n_ + i]});
  }

  int integrate_quadratures() {
    std::copy_n(f0_, n_, rates_);
    std::copy(x0_ + m_, x0_ + n_, scratch_ + m_);
    for (std::size_t k = 1; k < 4; ++k) {
      const double s = k == 1 ? node : k == 2 ? 1 - node : 1;
      motion_at(s, scratch_);
      if (const int code = evaluate(t0_ + s * h_, scratch_, rates_ + k * n_); code != 0) return code;
    }
    for (std::size_t i = m_; i < n_; ++i)
      advance(i, h_ / 12 * (rates_[i] + 5 * (rates_[n_ + i] + rates_[2 * n_ + i]) + rates_[3 * n_ + i]));
    return 0;
  }

  explicit_rk::Controller controller_;
  Lu<double> lu_;
  std::vector<double> work_;
  double *u_, *f_, *dense_, *rates_;  // stages, a derivative, dense output; derivatives at Lobatto's nodes
  bool jacobian_here_ = false;
};

}  // namespace eom::implicit
