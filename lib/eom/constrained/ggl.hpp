// SPDX-License-Identifier: MIT
// The stabilised index-2 form of Gear, Gupta and Leimkuhler, by Radau IIA of order 5 (collocation.hpp):
//   q' = v - D1 mu,   v' = f(q, v, t) - D2 nu,   0 = psi(q, t),   0 = A v + b.
// Source: Gear, Gupta, Leimkuhler, Automatic integration of Euler-Lagrange equations with constraints, Journal of
// Computational and Applied Mathematics 12 (1985); Hairer, Wanner, Solving Ordinary Differential Equations II, sections
// VII.1 and VII.4.
//
// f are the accelerations of the index-1 form, which contain the multipliers lambda_1 that satisfy A v' + ... = 0. In
// the GGL form lambda is an unknown. With lambda = lambda_1 + nu it becomes the system above with D1 = D2 = M^-1 A^T
// (D1 with the A of the position constraints). The motion satisfies psi = 0 and A v + b = 0 by f alone, so mu = nu = 0
// along it for any D. Each D with C D regular, C = d(psi, A v + b)/dx, gives a system of index 2 with the same
// solutions. Here D is evaluated together with df/dx and constant in between. It is (M + A^T S A)^-1 A^T, which has the
// same range as M^-1 A^T for any S > 0 and requires M to be positive only on the motions that A allows.
//
// Radau IIA ends steps with a stage, so psi = 0 and A v + b = 0 hold there without projection. Newton's iteration ends
// at its tolerance. The last stage is then corrected with the same matrix until the constraints hold to rounding. An
// independent set of rows is selected with each df/dx; redundant rows are only checked at the end of each step. The
// error estimate is that of radau5 through the bordered matrix, so that it is tangent to the constraints. The
// multipliers enter linearly, so the iteration ends when x has converged. Dense output: as in radau5, order 4. Across
// the constraints the stages are accurate but not their slopes; there a different quartic adapts the polynomial to the
// slope at the start.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "eom/constrained/rows.hpp"
#include "eom/implicit/radau5.hpp"

namespace eom::constrained {

inline constexpr Refusal refusals[] = {
    {Feature::modes, ": which constraints hold changes on the way, and it keeps one set of them"}};

/// The quartic with value 0 at 0 and at the three stages, and slope 1 at 0.
inline constexpr double bump_across(double s) { return s * (1 - s) * (1 + s * (-8 + 10 * s)); }

/// The method `ggl`: Radau IIA of order 5 for the stabilised index-2 form.
class Ggl : public implicit::Collocation<Ggl, 3> {
  using Core = implicit::Collocation<Ggl, 3>;

 public:
  static constexpr const char* name = "ggl";
  static constexpr int order = 5;
  static constexpr int dense_order = 4;
  static constexpr Needs needs{.required = {Feature::constraints},
                               .used = {Feature::jacobian},
                               .refuses = refusals,
                               .alternative = "radau5, which projects where there is something to keep",
                               .keeps_constraints = true};

  /// Throws std::invalid_argument if the state does not match the system or violates its constraints.
  static void check(const System& system, double t0, std::span<const double> x0, const Options& options) {
    if (2 * system.coordinates + options.quadratures > x0.size())
      throw std::invalid_argument("eom::integrate: ggl needs a state that begins with coordinates and velocities");
    ConstraintEquations rows(system);
    if (rows.evaluate(t0, x0.data()) == 0 &&
        (rows.select_independent(), !rows.are_satisfied(x0.data(), start_tolerance)))
      throw std::invalid_argument(
          "eom::integrate: the start of ggl does not meet the constraints; eom::Projection "
          "(eom/constraints/projection.hpp) moves it there");
  }

  Ggl(System& system, std::span<const double> x, const Options& options)
      : Core(system, x, options, 3, system.position_constraints + system.constraints),
        of_(system),
        c_(system.coordinates),
        rows_(system),
        mass_(c_),
        C_(extra_ * m_),
        D_(extra_ * c_),
        M_(c_ * c_),
        at_(n_),
        across_(length_) {}

  using Core::interpolate;
  void interpolate(double t, double* x) const {
    const double s = (t - t0_) / h_;
    implicit::RadauTableau::Row weight;
    implicit::stage_weights<3>(*tableau_, s, weight);
    for (std::size_t i = 0; i < n_; ++i) {
      const double along = i < m_ ? tableau_->gamma * estimate_[i] : h_ * f0_[i] + defect(i),
                   across = i < m_ ? across_[i] : 0;
      x[i] = x0_[i] + (polynomial(weight, s, i) + implicit::bump(s) * along + bump_across(s) * across);
    }
  }

  /// Evaluates C and D and selects the rows at the start of the step.
  int linearise() {
    if (const int code = rows_.evaluate(t0_, x0_); code != 0) return code;
    rows_.select_independent();
    if (const int code = compute_directions(); code != 0) return code;
    std::fill(C_.begin(), C_.end(), 0.0);
    for (std::size_t a = 0; a < extra_; ++a)
      for (std::size_t i = 0; i < c_; ++i) C_[a + extra_ * (velocity(a) + i)] = rows_.slope(a, i);
    return velocity_slopes();
  }

  template <class Matrix>
  void border(Matrix& matrix) const {
    for (std::size_t a = 0; a < extra_; ++a) {
      const bool is_selected = rows_.is_selected(a);
      for (std::size_t i = 0; i < m_; ++i) {
        matrix(i, m_ + a) = {0};
        matrix(m_ + a, i) = {is_selected ? -C_[a + extra_ * i] : 0};
      }
      for (std::size_t i = 0; i < c_ && is_selected; ++i) matrix(velocity(a) + i, m_ + a) = {D_[a + extra_ * i]};
      for (std::size_t other = 0; other < extra_; ++other)
        matrix(m_ + other, m_ + a) = {a == other && !is_selected ? 1.0 : 0.0};
    }
  }

  int add_algebraic(double t, const double* x, const double* u, double* f) {
    if (const int code = rows_.evaluate(t, x); code != 0) return code;
    for (std::size_t a = 0; a < extra_; ++a) {
      f[n_ + a] = rows_.is_selected(a) ? rows_.value(a, x) : 0;
      for (std::size_t i = 0; i < c_; ++i) f[velocity(a) + i] -= D_[a + extra_ * i] * u[a];
    }
    return 0;
  }

  template <class Size>
  void border_units(double* w, const Size& size) const {
    for (std::size_t a = 0; a < extra_; ++a)
      for (std::size_t i = 0; i < m_ && rows_.is_selected(a); ++i) w[m_ + a] += std::abs(C_[a + extra_ * i]) * size(i);
  }

  /// Moves the last stage onto its constraints, to rounding. Computes the part of the start slope across them.
  int correct_last_stage() {
    double* z = z_ + 2 * length_;
    double before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < most_rounds; ++round) {
      for (std::size_t i = 0; i < n_; ++i) scratch_[i] = x0_[i] + z[i];
      if (const int code = rows_.evaluate(t1_, scratch_); code != 0) return code;
      const double worst = residual();
      if (!(worst > rounding_level) || worst > stagnation_ratio * before) break;
      before = worst;
      real_.solve(right_.data());
      for (std::size_t i = 0; i < m_; ++i) z[i] += right_[i];
    }
    if (!rows_.are_satisfied(scratch_, tolerance)) return fail(0.25), code_no_convergence;
    slope_across();
    return 0;
  }

 private:
  static constexpr int most_rounds = 40;
  static constexpr double start_tolerance = 1e-6;        // of the coordinates or rates
  static constexpr double stagnation_ratio = 0.9;        // of a residual: above this ratio it no longer decreases
  static constexpr double rounding_level = 4 * epsilon;  // of the terms of a constraint
  static constexpr double tolerance =
      1e-10;  // of the coordinates or rates: a larger residual of a row that is not selected is a contradiction
  static constexpr double difference_step = 1.5e-8;  // of a coordinate, for differences

  /// First of the components that receive the multiplier of g_a and belong to its row of A.
  std::size_t velocity(std::size_t a) const { return a < rows_.position_row_count() ? 0 : c_; }

  /// D by columns: (M + A^T S A)^-1 A^T S, S the mean of the masses.
  int compute_directions() {
    if (const int code = of_.mass(of_.self, t0_, x0_, M_.data()); code != 0) return code;
    double mean = 0;
    for (std::size_t i = 0; i < c_; ++i) mean += std::abs(M_[i + c_ * i]) / static_cast<double>(c_);
    if (mean == 0) mean = 1;
    for (std::size_t j = 0; j < c_; ++j)
      for (std::size_t i = 0; i < c_; ++i) {
        double sum = M_[i + c_ * j];
        for (std::size_t a = rows_.position_row_count(); a < extra_; ++a)
          sum += mean * rows_.slope(a, i) * rows_.slope(a, j);
        mass_(i, j) = sum;
      }
    if (!mass_.factor()) return code_no_convergence;
    for (std::size_t a = 0; a < extra_; ++a) {
      for (std::size_t i = 0; i < c_; ++i) across_[i] = rows_.is_selected(a) ? mean * rows_.slope(a, i) : 0;
      mass_.solve(across_.data());
      for (std::size_t i = 0; i < c_; ++i) D_[a + extra_ * i] = across_[i];
    }
    return 0;
  }

  /// d(A v + b)/dq by differences.
  int velocity_slopes() {
    double largest = 0;
    for (std::size_t i = 0; i < c_; ++i) largest = std::max(largest, std::abs(x0_[i]));
    std::copy_n(x0_, n_, at_.data());
    for (std::size_t a = rows_.position_row_count(); a < extra_; ++a) across_[a] = rows_.value(a, x0_);
    for (std::size_t j = 0; j < c_; ++j) {
      const double size = std::max({std::abs(x0_[j]), std::abs(h_ * x0_[c_ + j]), 1e-3 * largest});
      at_[j] = x0_[j] + difference_step * (size > 0 ? size : 1);
      if (const int code = rows_.evaluate(t0_, at_.data()); code != 0) return code;
      for (std::size_t a = rows_.position_row_count(); a < extra_; ++a)
        C_[a + extra_ * j] = (rows_.value(a, at_.data()) - across_[a]) / (at_[j] - x0_[j]);
      at_[j] = x0_[j];
    }
    return 0;
  }

  /// Writes g at scratch_ into right_, as a right-hand side. Returns the largest residual relative to its terms.
  double residual() {
    double worst = 0;
    std::fill(right_.begin(), right_.end(), 0.0);
    for (std::size_t a = 0; a < extra_; ++a) {
      if (!rows_.is_selected(a)) continue;
      right_[m_ + a] = rows_.value(a, scratch_);
      if (right_[m_ + a] != 0) worst = std::max(worst, std::abs(right_[m_ + a]) / rows_.terms(a, scratch_));
    }
    return worst;
  }

  /// The vector y along D with C y = C (h f0 + defect).
  void slope_across() {
    std::fill(across_.begin(), across_.end(), 0.0);
    for (std::size_t i = 0; i < m_; ++i) {
      const double r = h_ * f0_[i] + defect(i);
      for (std::size_t a = 0; a < extra_; ++a)
        if (rows_.is_selected(a)) across_[m_ + a] -= C_[a + extra_ * i] * r;
    }
    real_.solve(across_.data());
  }

  System& of_;
  std::size_t c_;
  ConstraintEquations rows_;
  Lu<double> mass_;
  std::vector<double> C_, D_, M_, at_, across_;
};

}  // namespace eom::constrained
