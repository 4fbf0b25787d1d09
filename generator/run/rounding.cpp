// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/rounding.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

#include "run/integration.hpp"

namespace eomgen::run {
namespace {

constexpr double unit = std::numeric_limits<double>::epsilon();

double sign(std::size_t i) { return i % 2 == 0 ? 1 : -1; }

std::vector<double> inputs(const RunRequest& request, double t) {
  std::vector<double> u;
  for (const Signal& signal : request.scene.inputs) u.push_back(signal(t, t));
  return u;
}

/// The momenta of a model, and what rates they give.
class Momenta {
 public:
  Momenta(const RunRequest& request, double t, const std::vector<double>& x)
      : request_(request),
        t_(t),
        u_(inputs(request, t)),
        n_(static_cast<Eigen::Index>(request.code.free.size())),
        p_(Eigen::VectorXd::Zero(n_)),
        scratch_(Eigen::VectorXd::Zero(n_)),
        M_(n_, n_) {
    valid_ = request.code.mass(t, x.data(), request.scene.parameters.data(), M_.data(), scratch_.data()) == 0 &&
             M_.allFinite() && at(x, p_);
    force_ = scratch_;
    if (!valid_) return;
    size_ = M_.diagonal().unaryExpr(
        [](double m) { return m > 0 ? 1 / std::sqrt(m) : 1; });  // of one coordinate beside another says nothing
    solver_.compute(size_.asDiagonal() * M_ * size_.asDiagonal());
  }

  bool at(const std::vector<double>& x, Eigen::VectorXd& p) {
    return request_.code.momenta(t_, x.data(), request_.scene.parameters.data(), u_.data(), 0, p.data(),
                                 scratch_.data()) == 0 &&
           p.allFinite();
  }
  const Eigen::VectorXd& value() const { return p_; }
  const Eigen::VectorXd& force() const { return force_; }  // dL/dq
  /// Zero where there is no value.
  Eigen::VectorXd rates(const Eigen::VectorXd& p) const {
    if (!valid_) return Eigen::VectorXd::Zero(n_);
    const Eigen::VectorXd scaled = size_.cwiseProduct(p), v = size_.cwiseProduct(solver_.solve(scaled));
    return v.allFinite() ? v : Eigen::VectorXd::Zero(n_);
  }

 private:
  const RunRequest& request_;
  double t_;
  std::vector<double> u_;
  Eigen::Index n_;
  Eigen::VectorXd p_, scratch_, force_, size_;
  Eigen::MatrixXd M_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver_;
  bool valid_ = false;
};

Scene rounded(const RunRequest& request, const std::string& solver, const std::vector<double>& x) {
  const std::size_t n = request.code.free.size();
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  if (method_named(solver).variational) {
    const Momenta momenta(request, request.scene.t0, x);
    for (std::size_t i = 0; i < n; ++i)
      rates(static_cast<Eigen::Index>(i)) = sign(i) * unit * std::abs(momenta.value()(static_cast<Eigen::Index>(i)));
    rates = momenta.rates(rates);
  }
  Scene scene = request.scene;
  for (std::size_t i = 0; i < n; ++i) {
    scene.q[request.code.free[i]] = x[i] + sign(i) * unit * std::abs(x[i]);
    scene.qdot[request.code.free[i]] =
        x[n + i] - sign(i) * unit * std::abs(x[n + i]) + rates(static_cast<Eigen::Index>(i));
  }
  return scene;
}

}  // namespace

eom::Result from_rounded_start(const RunRequest& request, const std::string& solver, const eom::Options& options) {
  const Scene scene = rounded(request, solver, Integration(request, solver).initial_state());
  RunRequest moved{.code = request.code,
                   .scene = scene,
                   .state_names = request.state_names,
                   .conserved = request.conserved,
                   .events = request.events,
                   .watch_power = request.watch_power,
                   .estimate = false,
                   .row = {},
                   .progress = {},
                   .interrupt = request.interrupt,
                   .integrals = request.integrals,
                   .contacts = request.contacts,
                   .magnitudes = request.magnitudes,
                   .charts = request.charts,
                   .in_charts = request.in_charts,
                   .ranges = request.ranges,
                   .narrow = request.narrow,
                   .constraint_names = request.constraint_names,
                   .max_steps = request.max_steps};
  Integration integration(moved, solver);
  eom::Result end = integration.run(options, {});
  if (end.outcome == eom::Outcome::done || end.outcome == eom::Outcome::stopped_by_event)
    end.x = integration.own_state(end);
  return end;
}

std::vector<double> rounding_of_rates(const RunRequest& request, double t, std::vector<double> x) {
  const std::size_t n = request.code.free.size();
  Momenta momenta(request, t, x);
  Eigen::VectorXd moved(static_cast<Eigen::Index>(n)), sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    // Where positions hardly move, forces are rounded in the same way in each step.
    const double q = x[i], p = std::abs(momenta.value()(k)) + std::abs(momenta.force()(k) * (t - request.scene.t0));
    x[i] = q + unit * std::abs(q);
    if (momenta.at(x, moved)) sum += momenta.rates(moved - momenta.value()).cwiseAbs();
    x[i] = q;
    moved.setZero();
    moved(k) = unit * p;
    sum += momenta.rates(moved).cwiseAbs();
  }
  return {sum.begin(), sum.end()};
}

}  // namespace eomgen::run
