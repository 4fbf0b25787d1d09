// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/variational.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "run/central_differences.hpp"
#include "run/slip_turn.hpp"
#include "run/variational_jumps.hpp"

namespace eomgen::run {
namespace {

constexpr double relative_difference = 1e-3;  // of the state

/// Weights of the derivative to order 6 from the scenes beside at h/2, h/4 and h/8, in the order of difference_offsets,
/// times h. Scenes are as far away as their values change smoothly, and 1/m is not smooth enough for order 4.
constexpr std::array<double, 8> order_six{0, 0, 1.0 / 45, -1.0 / 45, -40.0 / 45, 40.0 / 45, 256.0 / 45, -256.0 / 45};

}  // namespace

class VariationalRun::Run {
 public:
  Run(const RunRequest& request, const RunResult& motion, const std::string& solver,
      const std::vector<Direction>& directions)
      : scene_(request.scene),
        solver_(solver),
        directions_(directions),
        jumps_(request, motion, solver, directions),
        n_(jumps_.states()),
        u_(std::max<std::size_t>(1, scene_.inputs.size())),
        dfdx_(n_ * n_),
        dfdt_(n_),
        dfdp_(n_ * scene_.parameters.size()),
        dfdu_(n_ * u_.size()),
        f_(n_),
        slopes_(n_ * directions.size()) {}

  eom::Result run(const eom::Options& options) {
    eom::Result result = run(options, false);
    if (result.outcome != eom::Outcome::step_too_small || !jumps_.equations().has_slip_of_two()) return result;
    const eom::Statistics first = result.statistics;
    result = run(options, true);
    result.statistics += first;
    return result;
  }

  VariationalJumps& jumps() { return jumps_; }

  // The right-hand side of x and s. dx may alias x: x is read before dx is written.
  int operator()(double t, const double* x, double* dx) {
    auto& context = jumps_.equations().context;
    const eom::hybrid::Code& code = *jumps_.equations().problem.code;
    if (context.solved_contacts || code.jac == nullptr || code.jac_p == nullptr) return differences(t, x, dx);
    eom::hybrid::Model& model = context.model;
    const double* u = model.inputs(t);
    std::copy(u, u + u_.size(), u_.begin());
    const double* const at = model.led_state(t, x, u_.data());
    if (const int code = derivatives(t, at, model.mode().data()); code != 0) {
      // As for f: a branch that is frozen beyond its surface may have no value there.
      if (derivatives(t, at, nullptr) != 0) return code;
    }
    std::fill(slopes_.begin(), slopes_.end(), 0.0);
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      const Direction& direction = directions_[d];
      double* slope = slopes_.data() + d * n_;
      add(dfdx_, n_, slope, [&](std::size_t j) { return x[(d + 1) * n_ + j]; });
      add(dfdp_, direction.dp.size(), slope, [&](std::size_t j) { return direction.scale * direction.dp[j]; });
      add(dfdu_, direction.du.size(), slope,
          [&](std::size_t j) { return direction.scale * direction.du[j](t, model.segment_time()); });
    }
    if (const int code = context.rhs(t, x, f_.data()); code != 0) return code;
    std::copy(f_.begin(), f_.end(), dx);
    std::copy(slopes_.begin(), slopes_.end(), dx + n_);
    return 0;
  }

 private:
  eom::Result run(const eom::Options& options, bool coarse) {
    eom::Result total;
    jumps_.set_tolerances(options.rtol, options.atol, coarse);
    total.t = scene_.t0;
    total.x = start();
    if (!jumps_.start(total)) return total;
    for (;;) {
      eom::Result part = integrate(total, jumps_.segment_end(), options);
      part.statistics += total.statistics;
      total = std::move(part);
      if (total.outcome != eom::Outcome::done) return total;
      if (jumps_.is_last_segment()) break;
      if (!jumps_.cross_kink_in_time(total)) return total;
    }
    jumps_.end(total);
    return total;
  }

  std::vector<double> start() {
    std::vector<double> x = jumps_.equations().context.own_start();
    for (const Direction& d : directions_) {
      for (const double dx : d.dx) x.push_back(d.scale * dx);
    }
    return x;
  }

  // f(t, x + h s) to order 4 and f(t, x, p + h dp, u + h du) to order 6.
  int differences(double t, const double* x, double* dx) {
    const std::vector<double> at(x, x + n_ * (directions_.size() + 1));
    std::vector<double> state(n_), value(n_);
    SlipTurn turn(jumps_.equations(), t, at.data());
    Slips rates;
    const auto add = [&](VariationalEquations& in, double weight, std::size_t d) {
      turn.hold(in);
      if (const int code = turn.add_slips(in, t, state.data(), weight, rates); code != 0) return code;
      if (const int code = in.context.rhs(t, state.data(), value.data()); code != 0) return code;
      for (std::size_t i = 0; i < n_; ++i) slopes_[d * n_ + i] += weight * value[i];
      return 0;
    };
    std::fill(slopes_.begin(), slopes_.end(), 0.0);
    const std::vector<double> own(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(n_));
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      const std::vector<double> s(at.begin() + static_cast<std::ptrdiff_t>((d + 1) * n_),
                                  at.begin() + static_cast<std::ptrdiff_t>((d + 2) * n_));
      const double size = largest_magnitude(s);
      rates = turn.zero();
      const double h = size > 0 ? relative_difference * jumps_.scales().magnitude(own) / size : 0;
      for (const auto& [offset, weight] : order_four) {
        if (size == 0) break;
        for (std::size_t i = 0; i < n_; ++i) state[i] = own[i] + offset * h * s[i];
        if (const int code = add(jumps_.equations(), weight / h, d); code != 0) return code;
      }
      state = own;
      const auto& beside = jumps_.neighbours(d, NeighbourInputs::of_same_times);
      for (std::size_t k = 0; k < order_six.size() && k < beside.size(); ++k) {
        const double weight = order_six[k] * directions_[d].scale / directions_[d].step;
        if (weight == 0) continue;
        if (const int code = add(jumps_.in_segment(*beside[k]), weight, d); code != 0) return code;
      }
      if (const int code = turn.add_turn(t, own.data(), rates, slopes_.data() + d * n_); code != 0) return code;
    }
    if (const int code = jumps_.equations().context.rhs(t, own.data(), f_.data()); code != 0) return code;
    std::copy(f_.begin(), f_.end(), dx);
    std::copy(slopes_.begin(), slopes_.end(), dx + n_);
    return 0;
  }

  int derivatives(double t, const double* x, const int* mode) {
    const eom::hybrid::Code& code = *jumps_.equations().problem.code;
    const double* p = scene_.parameters.data();
    if (const int bad = code.jac(t, x, p, u_.data(), mode, dfdx_.data(), dfdt_.data()); bad != 0) return bad;
    if (const int bad = code.jac_p(t, x, p, u_.data(), mode, dfdp_.data()); bad != 0) return bad;
    return code.jac_u == nullptr ? 0 : code.jac_u(t, x, p, u_.data(), mode, dfdu_.data());
  }

  /// slope += matrix v
  template <class Vector>
  void add(const std::vector<double>& matrix, std::size_t columns, double* slope, const Vector& v) const {
    for (std::size_t j = 0; j < columns; ++j) {
      const double by = v(j);
      if (by == 0) continue;
      for (std::size_t i = 0; i < n_; ++i) slope[i] += matrix[i + n_ * j] * by;
    }
  }

  eom::Result integrate(const eom::Result& from, double end, const eom::Options& options) {
    const auto surfaces = [&](double t, const double* x, double* g) {
      return jumps_.equations().context.events(t, x, g);
    };
    const auto cross = [&](const eom::EventPoint& point) {
      jumps_.settle_branch(point.crossing);
      return jumps_.cross_event(point) ? eom::EventAction::restart : eom::EventAction::resume;
    };
    const auto observe = [&](const eom::StepView& step) {
      jumps_.observe_state(step.t1, step.x1.data());
      return true;
    };
    return eom::integrate_events(solver_, eom::system_of(*this), from.t, from.x, end, options, surfaces,
                                 jumps_.watched_functions(), cross, observe);
  }

  const Scene& scene_;
  const std::string& solver_;
  const std::vector<Direction>& directions_;
  VariationalJumps jumps_;
  std::size_t n_;
  std::vector<double> u_, dfdx_, dfdt_, dfdp_, dfdu_, f_, slopes_;
};

VariationalRun::VariationalRun(const RunRequest& request, const RunResult& motion, const std::string& solver,
                               const std::vector<Direction>& directions)
    : run_(std::make_unique<Run>(request, motion, solver, directions)) {}
VariationalRun::~VariationalRun() = default;

eom::Result VariationalRun::operator()(const eom::Options& options) { return run_->run(options); }
VariationalJumps& VariationalRun::jumps() { return run_->jumps(); }

}  // namespace eomgen::run
