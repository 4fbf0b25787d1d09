// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/error_estimate.hpp>
#include <eom/ode.hpp>

namespace eomgen::run {
namespace {

/// The state: x, followed by each s times its scale.
class Variational {
 public:
  Variational(const RunRequest& request, const std::vector<Direction>& directions)
      : code_(request.code),
        scene_(request.scene),
        directions_(directions),
        n_(request.state_names.size()),
        w_(code_.prepare != nullptr ? code_.prepared : 0),
        u_(std::max<std::size_t>(1, scene_.inputs.size())),
        dfdx_(n_ * n_),
        dfdt_(n_),
        dfdp_(n_ * scene_.parameters.size()) {
    prepared_ = code_.prepare != nullptr && code_.prepare(scene_.parameters.data(), w_.data()) == 0;
  }

  std::vector<double> start() const {
    std::vector<double> x;
    for (const std::uint32_t i : code_.free) x.push_back(scene_.q[i]);
    for (const std::uint32_t i : code_.free) x.push_back(scene_.qdot[i]);
    x.resize(n_);
    for (const Direction& d : directions_) {
      for (const double dx : d.dx) x.push_back(d.scale * dx);
    }
    return x;
  }

  int operator()(double t, const double* x, double* dx) {
    for (std::size_t i = 0; i < scene_.inputs.size(); ++i) u_[i] = scene_.inputs[i](t, side);
    const double* p = scene_.parameters.data();
    // dx may alias x: x is read before dx is written.
    if (const int code = code_.jac(t, x, p, u_.data(), 0, dfdx_.data(), dfdt_.data()); code != 0) return code;
    if (const int code = code_.jac_p(t, x, p, u_.data(), 0, dfdp_.data()); code != 0) return code;
    slopes_.assign(n_ * directions_.size(), 0.0);
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      double* slope = slopes_.data() + d * n_;
      const double* s = x + (d + 1) * n_;
      for (std::size_t j = 0; j < n_; ++j) {
        for (std::size_t i = 0; i < n_; ++i) slope[i] += dfdx_[i + n_ * j] * s[j];
      }
      for (std::size_t k = 0; k < directions_[d].dp.size(); ++k) {
        const double change = directions_[d].scale * directions_[d].dp[k];
        if (change == 0) continue;
        for (std::size_t i = 0; i < n_; ++i) slope[i] += dfdp_[i + n_ * k] * change;
      }
    }
    const int code =
        prepared_ ? code_.rhs_prepared(t, x, p, w_.data(), u_.data(), 0, dx) : code_.rhs(t, x, p, u_.data(), 0, dx);
    if (code == 0) std::copy(slopes_.begin(), slopes_.end(), dx + n_);
    return code;
  }

  double side = 0;  // a time inside the current segment between jumps of inputs

 private:
  const Code& code_;
  const Scene& scene_;
  const std::vector<Direction>& directions_;
  std::size_t n_;
  std::vector<double> w_, u_, dfdx_, dfdt_, dfdp_, slopes_;
  bool prepared_ = false;
};

/// Ends of the segments between jumps of inputs and kinks in time, and the beginnings of the next ones.
std::vector<eom::hybrid::Breakpoint> segments(const Scene& scene, double t_end) {
  using eom::hybrid::Breakpoint;
  std::vector<Breakpoint> ends;
  const double direction = t_end < scene.t0 ? -1 : 1;
  for (const Signal& signal : scene.inputs) {
    for (const double t : signal.jumps()) {
      if ((t - scene.t0) * direction > 0 && (t_end - t) * direction > 0) ends.push_back({t, t});
    }
  }
  for (const Breakpoint& b : scene.clock.breakpoints) {
    if ((b.before - scene.t0) * direction > 0 && (t_end - b.after) * direction > 0)
      ends.push_back(direction > 0 ? b : Breakpoint{b.after, b.before});
  }
  std::sort(ends.begin(), ends.end(), [direction](const Breakpoint& a, const Breakpoint& b) {
    return a.before * direction < b.before * direction;
  });
  ends.erase(std::unique(ends.begin(), ends.end(),
                         [](const Breakpoint& a, const Breakpoint& b) { return a.before == b.before; }),
             ends.end());
  ends.push_back({t_end, t_end});
  return ends;
}

eom::Result run(const RunRequest& request, const std::string& solver, double t_end,
                const std::vector<Direction>& directions, const eom::Options& options) {
  Variational f(request, directions);
  eom::Result total;
  total.t = request.scene.t0;
  total.x = f.start();
  for (const auto& [end, next] : segments(request.scene, t_end)) {
    f.side = (total.t + end) / 2;
    eom::Result segment = eom::integrate(solver, f, total.t, total.x, end, options);
    segment.statistics += total.statistics;
    total = std::move(segment);
    if (total.outcome != eom::Outcome::done) break;
    total.t = next;
  }
  return total;
}

/// The method of the run; if it needs a series, momenta or constraints, a method of similar order that does not.
std::string without_requirements(const std::string& solver) {
  const eom::MethodInfo& method = get_method(solver);
  if (method.needs.required.none()) return solver;
  return uses_jacobian(method) ? "radau5" : "dop853";
}

void require_smooth(const RunRequest& request) {
  if (request.code.contacts.empty()) return;
  throw Error("run", {},
              "contacts and friction change the equations during the run, and derivatives of the end jump there",
              "compare runs with changed parameters (--set), or sweep over them");
}

}  // namespace

Sensitivities integrate_sensitivities(const RunRequest& request, const std::string& solver, double t_end,
                                      const std::vector<Direction>& directions, bool estimate) {
  require_smooth(request);
  Sensitivities result;
  result.solver = without_requirements(solver);
  eom::Options options;
  options.rtol = request.scene.rtol;
  options.atol = request.scene.atol;
  options.fixed_step = get_method(result.solver).adaptive ? 0 : request.scene.step;
  options.interrupt = request.interrupt;
  if (t_end > request.scene.t0) options.step_bounds = request.scene.clock.bounds;
  if (request.scene.max_step > 0) options.max_step = request.scene.max_step;
  options.max_steps = request.steps_allowed(options.fixed_step > 0);
  const eom::Result end = run(request, result.solver, t_end, directions, options);
  result.outcome = end.outcome;
  result.t = end.t;
  result.statistics = end.statistics;
  const std::size_t n = request.state_names.size();
  for (std::size_t d = 0; d < directions.size(); ++d) {
    result.list.push_back({directions[d].name, {}, {}});
    for (std::size_t i = 0; i < n; ++i)
      result.list.back().value.push_back(end.x[(d + 1) * n + i] / directions[d].scale);
  }
  if (!estimate || end.outcome != eom::Outcome::done) return result;
  const eom::ErrorEstimate error = eom::estimate_error(
      get_method(result.solver).order, request.scene.t0, end, options,
      [&](const eom::Options& tighter) { return run(request, result.solver, t_end, directions, tighter); });
  for (std::size_t d = 0; d < directions.size(); ++d) {
    for (std::size_t i = 0; i < n; ++i) result.list[d].error.push_back(error.x[(d + 1) * n + i] / directions[d].scale);
  }
  if (error.outcome != eom::Outcome::done)
    result.estimate_note =
        fmt::format("a tighter run ended with '{}'; the estimate is not to be trusted", eom::name(error.outcome));
  return result;
}

}  // namespace eomgen::run
