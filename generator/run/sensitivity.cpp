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

  /// Adds f times `part` of the change of a time along each direction: s + part f dt. Returns an error code.
  template <class ChangeOfTime>
  int shift_time(double t, std::vector<double>& x, double part, const ChangeOfTime& dt) {
    std::vector<double> f(x.size());
    if (const int code = (*this)(t, x.data(), f.data()); code != 0) return code;
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      const double by = part * directions_[d].scale * dt(directions_[d]);
      for (std::size_t i = 0; i < n_ && by != 0; ++i) x[(d + 1) * n_ + i] += by * f[i];
    }
    return 0;
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

eom::Result run(const RunRequest& request, const std::string& solver, double t_end,
                const std::vector<Direction>& directions, const eom::Options& options) {
  Variational f(request, directions);
  const Scene& scene = request.scene;
  eom::Result total;
  total.t = scene.t0;
  total.x = f.start();
  std::vector<eom::hybrid::Breakpoint> ends;
  for (const eom::hybrid::Breakpoint& kink : kink_times(scene)) {
    if (kink.after < t_end) ends.push_back(kink);
  }
  ends.push_back({t_end, t_end});
  int code = 0;
  for (std::size_t k = 0; k < ends.size() && code == 0; ++k) {
    f.side = (total.t + ends[k].before) / 2;
    if (k == 0) code = f.shift_time(total.t, total.x, -1, [](const Direction& d) { return d.dt0; });
    if (code != 0) break;
    eom::Result segment = eom::integrate(solver, f, total.t, total.x, ends[k].before, options);
    segment.statistics += total.statistics;
    total = std::move(segment);
    if (total.outcome != eom::Outcome::done) return total;
    if (k + 1 == ends.size()) code = f.shift_time(total.t, total.x, 1, [](const Direction& d) { return d.dt1; });
    total.t = ends[k].after;
  }
  if (code != 0) total.outcome = eom::outcome_of_abi_code(code);
  return total;
}

/// The method of the run; if it needs a series, momenta or constraints, a method of similar order that does not.
std::string without_requirements(const std::string& solver) {
  const eom::MethodInfo& method = get_method(solver);
  if (method.needs.required.none()) return solver;
  return uses_jacobian(method) ? "radau5" : "dop853";
}

constexpr const char* by_runs = "compare runs with changed values (--set), or sweep over them";

void require_smooth(const RunRequest& request, const RunResult& result, const std::vector<Direction>& directions) {
  const auto refuse = [](const std::string& what) { throw Error("run", {}, "--sensitivity: " + what, by_runs); };
  if (!request.code.contacts.empty())
    refuse("contacts and friction change the equations during the run, and derivatives of the end jump there");
  if (result.outcome == eom::Outcome::stopped_by_event)
    refuse("an event ends the run, at a time that changes with the values");
  for (const RunEvent& event : result.events) {
    if (event.kind == "impulse") refuse(fmt::format("the run has an impulse at t = {}", event.t));
  }
  const std::vector<eom::hybrid::Breakpoint> kinks = kink_times(request.scene);
  for (const Direction& d : directions) {
    for (std::size_t k = 0; k < kinks.size(); ++k) {
      if (d.dt[k] != 0) refuse(fmt::format("the time of the kink at t = {} depends on {}", kinks[k].before, d.name));
    }
    if (!d.du.empty()) refuse("an input depends on " + d.name);
  }
}

/// x of the variational equations has to end where the run does: otherwise they miss something.
class EndComparison {
 public:
  EndComparison(const RunRequest& request, const RunResult& result, const eom::Result& end)
      : request_(request), result_(result), end_(end) {}

  /// Whether each component agrees within the tolerances, or within 10 of both errors.
  bool agrees(const std::vector<double>& errors) const { return worst(errors) == none; }

  void require(const std::vector<double>& errors) const {
    const std::size_t i = worst(errors);
    if (i == none) return;
    throw Error(
        "run", {},
        fmt::format("--sensitivity: the motion of the variational equations ends at {} = {}, and the run at {}: "
                    "something on the way is not differentiated",
                    request_.state_names[i], end_.x[i], result_.state[i]),
        by_runs);
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::size_t worst(const std::vector<double>& errors) const {
    double size = 0;
    for (std::size_t i = 0; i < request_.state_names.size(); ++i) size = std::max(size, std::abs(result_.state[i]));
    for (std::size_t i = 0; i < request_.state_names.size(); ++i) {
      double allowed = request_.scene.atol + request_.scene.rtol * size;
      if (!errors.empty()) allowed += 10 * errors[i];
      if (i < result_.error_estimate.size()) allowed += 10 * result_.error_estimate[i].second;
      if (!(std::abs(end_.x[i] - result_.state[i]) <= allowed)) return i;
    }
    return none;
  }

  const RunRequest& request_;
  const RunResult& result_;
  const eom::Result& end_;
};

}  // namespace

Sensitivities integrate_sensitivities(const RunRequest& request, const RunResult& motion,
                                      const std::vector<Direction>& directions, bool estimate) {
  require_smooth(request, motion, directions);
  Sensitivities result;
  result.solver = without_requirements(motion.solver);
  eom::Options options;
  options.rtol = request.scene.rtol;
  options.atol = request.scene.atol;
  options.fixed_step = get_method(result.solver).adaptive ? 0 : request.scene.step;
  options.interrupt = request.interrupt;
  options.step_bounds = request.scene.clock.bounds;
  if (request.scene.max_step > 0) options.max_step = request.scene.max_step;
  options.max_steps = request.steps_allowed(options.fixed_step > 0);
  const eom::Result end = run(request, result.solver, motion.t, directions, options);
  result.outcome = end.outcome;
  result.t = motion.t;
  result.statistics = end.statistics;
  const std::size_t n = request.state_names.size();
  for (std::size_t d = 0; d < directions.size(); ++d) {
    result.list.push_back({directions[d].name, {}, {}});
    for (std::size_t i = 0; i < n; ++i)
      result.list.back().value.push_back(end.x[(d + 1) * n + i] / directions[d].scale);
  }
  if (end.outcome != eom::Outcome::done) return result;
  const EndComparison comparison(request, motion, end);
  if (!estimate && comparison.agrees({})) return result;
  const eom::ErrorEstimate error = eom::estimate_error(
      get_method(result.solver).order, request.scene.t0, end, options,
      [&](const eom::Options& tighter) { return run(request, result.solver, motion.t, directions, tighter); });
  comparison.require(error.x);
  if (!estimate) return result;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    for (std::size_t i = 0; i < n; ++i) result.list[d].error.push_back(error.x[(d + 1) * n + i] / directions[d].scale);
  }
  if (error.outcome != eom::Outcome::done)
    result.estimate_note =
        fmt::format("a tighter run ended with '{}'; the estimate is not to be trusted", eom::name(error.outcome));
  return result;
}

}  // namespace eomgen::run
