// SPDX-License-Identifier: MIT
// The effect of rounding alone on a run with fixed steps. In: a run. Out: the end of the same run from a start whose
// last digits differ. It bounds the attainable accuracy in binary64 near singularities of coordinates and near points
// where motions separate; shorter steps do not show this.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "eom/hybrid/integration.hpp"

namespace eom::hybrid {

/// The momenta of a model at a state, and the rates that follow from them. In the model's own charts.
class Momenta {
 public:
  Momenta(const Problem& problem, double t, const std::vector<double>& x)
      : problem_(problem),
        t_(t),
        n_(static_cast<Eigen::Index>(problem.n())),
        p_(Eigen::VectorXd::Zero(n_)),
        scratch_(Eigen::VectorXd::Zero(n_)),
        M_(n_, n_) {
    const Inputs inputs(problem);
    for (std::size_t i = 0; i < inputs.size(); ++i) u_.push_back(inputs(i, t, t));
    valid_ = problem.code->mass(t, x.data(), problem.parameters.data(), M_.data(), scratch_.data()) == 0 &&
             M_.allFinite() && at(x, p_);
    force_ = scratch_;
    if (!valid_) return;
    size_ = M_.diagonal().unaryExpr(
        [](double m) { return m > 0 ? 1 / std::sqrt(m) : 1; });  // sizes of coordinates are not comparable
    solver_.compute(size_.asDiagonal() * M_ * size_.asDiagonal());
  }

  bool at(const std::vector<double>& x, Eigen::VectorXd& p) {
    return problem_.code->momenta(t_, x.data(), problem_.parameters.data(), u_.data(), 0, p.data(), scratch_.data()) ==
               0 &&
           p.allFinite();
  }
  const Eigen::VectorXd& value() const { return p_; }
  const Eigen::VectorXd& force() const { return force_; }  // dL/dq
  /// Zero if there is no value.
  Eigen::VectorXd rates(const Eigen::VectorXd& p) const {
    if (!valid_) return Eigen::VectorXd::Zero(n_);
    const Eigen::VectorXd scaled = size_.cwiseProduct(p), v = size_.cwiseProduct(solver_.solve(scaled));
    return v.allFinite() ? v : Eigen::VectorXd::Zero(n_);
  }

 private:
  const Problem& problem_;
  double t_;
  std::vector<double> u_;
  Eigen::Index n_;
  Eigen::VectorXd p_, scratch_, force_, size_;
  Eigen::MatrixXd M_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver_;
  bool valid_ = false;
};

namespace rounding {

inline constexpr double unit = std::numeric_limits<double>::epsilon();

inline double sign(std::size_t i) { return i % 2 == 0 ? 1 : -1; }

}  // namespace rounding

/// The end of a run from a perturbed start, in the model's own charts. Every component of the start changes by a unit
/// in its last place. A variational solver integrates momenta, so these change by a unit in the last place and the
/// rates by M^-1 times this.
inline Result run_from_perturbed_start(const Problem& problem, const Options& options) {
  const std::size_t n = problem.n();
  Problem moved = problem;
  moved.output_interval = 0;
  moved.row = {};
  moved.progress = {};
  moved.beyond_range = {};
  const std::vector<double> x = Integration(problem).context().start;
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  if (requires_feature(problem.solver, Feature::momenta)) {
    const Momenta momenta(problem, problem.t0, x);
    for (std::size_t i = 0; i < n; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      rates(k) = rounding::sign(i) * rounding::unit * std::abs(momenta.value()(k));
    }
    rates = momenta.rates(rates);
  }
  for (std::size_t i = 0; i < n; ++i) {
    moved.start[i] = x[i] + rounding::sign(i) * rounding::unit * std::abs(x[i]);
    moved.start[n + i] =
        x[n + i] - rounding::sign(i) * rounding::unit * std::abs(x[n + i]) + rates(static_cast<Eigen::Index>(i));
  }
  const StateLayout layout = problem.code->layout();
  for (std::size_t i = layout.first_order_begin(); i < layout.discrete_begin(); ++i)
    moved.start[i] = x[i] + rounding::sign(i) * rounding::unit * std::abs(x[i]);
  Integration integration(moved);
  Result end = integration.run(options, {});
  if (end.outcome == Outcome::done || end.outcome == Outcome::stopped_by_event)
    end.x = integration.context().own_state(end.t, end.x);
  return end;
}

/// For a variational solver, whose rates follow from positions and momenta: the change of the rates of a state caused
/// by the last digits of these and of the accumulated forces.
inline std::vector<double> rate_rounding(const Problem& problem, double t, std::vector<double> x) {
  const std::size_t n = problem.n();
  Momenta momenta(problem, t, x);
  Eigen::VectorXd moved(static_cast<Eigen::Index>(n)), sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    // If positions hardly change, forces are rounded the same way in each step.
    const double q = x[i], p = std::abs(momenta.value()(k)) + std::abs(momenta.force()(k) * (t - problem.t0));
    x[i] = q + rounding::unit * std::abs(q);
    if (momenta.at(x, moved)) sum += momenta.rates(moved - momenta.value()).cwiseAbs();
    x[i] = q;
    moved.setZero();
    moved(k) = rounding::unit * p;
    sum += momenta.rates(moved).cwiseAbs();
  }
  return {sum.begin(), sum.end()};
}

}  // namespace eom::hybrid
