// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/variational.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/events/integrate.hpp>
#include <eom/hybrid/impulses.hpp>
#include <functional>

#include "run/bind.hpp"
#include "run/central_differences.hpp"
#include "run/methods.hpp"
#include "run/variational_equations.hpp"

namespace eomgen::run {
namespace {

using eom::hybrid::Breakpoint;
using eom::hybrid::Problem;
using eom::hybrid::RunContext;

double largest(const std::vector<double>& values) {
  double size = 0;
  for (const double v : values) size = std::max(size, std::abs(v));
  return size;
}

constexpr int smaller_differences = -4, most_differences = 8;  // powers of 2; number of the differences tried
constexpr double continuous = 1e-10;                           // of f: a smaller jump is rounding

}  // namespace

class VariationalRun::Run {
 public:
  Run(const RunRequest& request, const RunResult& motion, const std::string& solver,
      const std::vector<Direction>& directions)
      : scene_(request.scene),
        motion_(motion),
        solver_(solver),
        directions_(directions),
        own_(problem_of(request, solver), kink_times(request.scene)),
        n_(own_.problem.states()),
        u_(std::max<std::size_t>(1, scene_.inputs.size())),
        dfdx_(n_ * n_),
        dfdt_(n_),
        dfdp_(n_ * scene_.parameters.size()),
        dfdu_(n_ * u_.size()),
        f_(n_),
        slopes_(n_ * directions.size()) {}

  eom::Result run(const eom::Options& options) {
    RunContext& context = own_.context;
    context.kinks.start();
    eom::Result total;
    total.t = scene_.t0;
    total.x = start();
    for (segment_ = 0;; ++segment_) {
      const bool last = segment_ == own_.kinks.size() || own_.kinks[segment_].after >= motion_.t;
      const double end = last ? motion_.t : own_.kinks[segment_].before;
      own_.enter(segment_);
      context.freeze_branches(total.t, total.x.data(), true);
      if (segment_ == 0 && !begin(total)) return total;
      eom::Result part = integrate(total, end, options);
      part.statistics += total.statistics;
      total = std::move(part);
      if (total.outcome != eom::Outcome::done) return total;
      if (last) break;
      if (!cross_kink_in_time(total)) return total;
    }
    const std::optional<std::size_t> stop = stopping_event();
    std::vector<double> dt;
    for (std::size_t d = 0; d < directions_.size(); ++d)
      dt.push_back(stop ? time_change(*stop, total.t, total.x, d) : directions_[d].dt1);
    if (!shift(total, [&dt](std::size_t d, const Direction&) { return dt[d]; })) return total;
    for (std::size_t d = 0; d < directions_.size(); ++d) total.x.push_back(directions_[d].scale * dt[d]);
    return total;
  }

  // The right-hand side of x and s. dx may alias x: x is read before dx is written.
  int operator()(double t, const double* x, double* dx) {
    eom::hybrid::Model& model = own_.context.model;
    const double* u = model.inputs(t);
    std::copy(u, u + u_.size(), u_.begin());
    if (const int code = derivatives(t, x, model.mode().data()); code != 0) {
      // As for f: a branch that is frozen beyond its surface may have no value there.
      if (derivatives(t, x, 0) != 0) return code;
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
    if (const int code = own_.context.rhs(t, x, f_.data()); code != 0) return code;
    std::copy(f_.begin(), f_.end(), dx);
    std::copy(slopes_.begin(), slopes_.end(), dx + n_);
    return 0;
  }

 private:
  std::vector<double> start() const {
    std::vector<double> x = own_.context.own_start();
    for (const Direction& d : directions_) {
      for (const double dx : d.dx) x.push_back(d.scale * dx);
    }
    return x;
  }

  int derivatives(double t, const double* x, const int* mode) {
    const eom::hybrid::Code& code = *own_.problem.code;
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
    RunContext& context = own_.context;
    std::vector<eom::EventFunction> watched(context.events.size(), {eom::Direction::any, eom::Watch::off});
    const std::size_t first = context.events.first_kink();
    for (std::size_t i = 0; i < first; ++i) {
      const eom::hybrid::WatchedEvent& event = own_.problem.events[i];
      if (!event.reset.set.empty()) watched[i] = {event.direction, eom::Watch::breaking};
    }
    for (std::size_t k = first; k < context.events.first_contact(); ++k) watched[k].watch = eom::Watch::breaking;
    const auto surfaces = [&](double t, const double* x, double* g) { return context.events(t, x, g); };
    const auto cross = [&](const eom::EventPoint& point) {
      const bool changed =
          point.crossing.function < own_.context.events.first_kink() ? reset(point) : cross_surface(point);
      return changed ? eom::EventAction::restart : eom::EventAction::resume;
    };
    return eom::integrate_events(solver_, *this, from.t, from.x, end, options, surfaces, std::move(watched), cross);
  }

  int rhs(double t, const double* x, std::vector<double>& f) { return own_.context.rhs(t, x, f.data()); }

  /// s += f dt. False: f has no value, and the run ends.
  template <class ChangeOfTime>
  bool shift(eom::Result& total, const ChangeOfTime& dt) {
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      const double by = directions_[d].scale * dt(d, directions_[d]);
      if (by == 0) continue;
      if (const int code = rhs(total.t, total.x.data(), f_); code != 0) {
        total.outcome = eom::outcome_of_abi_code(code);
        return false;
      }
      for (std::size_t i = 0; i < n_; ++i) total.x[(d + 1) * n_ + i] += by * f_[i];
    }
    return true;
  }

  /// At the start: the samples there, and s at the fixed time t0. False: f has no value, and the run ends.
  bool begin(eom::Result& total) {
    const std::vector<DueSample> due = due_samples(own_.problem, scene_.t0, scene_.t0);
    if (!due.empty()) {
      for (std::size_t d = 0; d < directions_.size(); ++d) {
        for (const auto& neighbour : neighbours(d)) {
          const Problem& in = neighbour->problem;
          for (const DueSample& sample : due) {
            if (eom::hybrid::sample_between(in.samples[sample.kind], in.t0, in.t0) != sample.k)
              refuse_sensitivity(fmt::format("the sample '{}' at the start moves away from it with {}",
                                             own_.problem.samples[sample.kind].name, directions_[d].name));
          }
        }
      }
      change_by_samples(due, 0, total, [](const Direction& d) { return d.dt0; });
    }
    return shift(total, [](std::size_t, const Direction& d) { return -d.dt0; });
  }

  /// At the end of a segment.
  bool cross_kink_in_time(eom::Result& total) {
    const Breakpoint& kink = own_.kinks[segment_];
    if (!shift(total, [this](std::size_t, const Direction& d) { return d.dt[segment_]; })) return false;
    const std::vector<double> x = total.x;
    eom::Result end;
    end.x.assign(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n_));
    if (cross(own_, end.x)) {
      for (std::size_t d = 0; d < directions_.size(); ++d) change_by_impulse(x, end.x, d, total.x);
      std::copy(end.x.begin(), end.x.end(), total.x.begin());
    }
    total.t = kink.after;
    own_.enter(segment_ + 1);
    const std::vector<DueSample> due = due_samples(own_.problem, kink.before, kink.after);
    if (!due.empty())
      change_by_samples(due, segment_ + 1, total, [this](const Direction& d) { return d.dt[segment_]; });
    own_.context.freeze_branches(total.t, total.x.data(), true);
    return shift(total, [this](std::size_t, const Direction& d) { return -d.dt[segment_]; });
  }

  /// Applies the impulse at the end of the current segment, if there is one.
  bool cross(VariationalEquations& in, std::vector<double>& x) const {
    if (segment_ >= in.kinks.size() || !in.context.events.jumps().has_time_kinks()) return false;
    const Breakpoint& kink = in.kinks[segment_];
    if (kink.after == kink.before) return false;
    in.enter(segment_);
    eom::Result at;
    at.t = kink.before;
    at.x = std::move(x);
    bool changed = false;
    const auto note = [&](const eom::hybrid::Event&, std::span<const double>) { changed = true; };
    const eom::hybrid::Reason open = cross_impulse(in.context, {kink.before, kink.after, 0}, at, note);
    x = std::move(at.x);
    if (open) refuse_sensitivity(fmt::format("the impulse at t = {} is undetermined", kink.before));
    return changed;
  }

  /// The s after an impulse: dJ/dx s + dJ. x: before it, with every s; after: the state.
  void change_by_impulse(const std::vector<double>& x, const std::vector<double>& after, std::size_t d,
                         std::vector<double>& out) {
    const Direction& direction = directions_[d];
    const std::vector<double> own(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n_));
    std::vector<std::vector<double>> beside;
    for (const auto& neighbour : neighbours(d)) {
      beside.push_back(own);
      cross(*neighbour, beside.back());
    }
    const auto what = [&] {
      return fmt::format("the impulse at t = {} does not change smoothly with {}", own_.kinks[segment_].before,
                         direction.name);
    };
    Slopes by_scene = slopes(after, beside, direction.step);
    if (!by_scene.smooth) refuse_sensitivity(what());
    const std::vector<double> by_state = along(0, own, 0, sensitivity(x, d), what, [&](double, std::vector<double> at) {
      cross(own_, at);
      return at;
    });
    for (std::size_t i = 0; i < n_; ++i) out[(d + 1) * n_ + i] = direction.scale * (by_state[i] + by_scene.value[i]);
  }

  /// x and s after samples at the start of a segment: s becomes dJ/dx s + dJ/dt dt + dJ.
  template <class ChangeOfTime>
  void change_by_samples(const std::vector<DueSample>& due, std::size_t segment, eom::Result& total,
                         const ChangeOfTime& dt) {
    const std::vector<double> x = total.x, own(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n_));
    std::vector<double> after = own;
    take_samples(own_, due, total.t, after);
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      const Direction& direction = directions_[d];
      const auto what = [&] {
        return fmt::format("the sample '{}' at t = {} does not change the state smoothly with {}",
                           own_.problem.samples[due.front().kind].name, total.t, direction.name);
      };
      std::vector<std::vector<double>> beside;
      for (const auto& neighbour : neighbours(d)) {
        neighbour->enter(segment);
        neighbour->context.model.set_mode(own_.context.model.mode());
        beside.push_back(own);
        take_samples(*neighbour, due, total.t, beside.back());
      }
      const Slopes by_scene = slopes(after, beside, direction.step);
      if (!by_scene.smooth) refuse_sensitivity(what());
      const std::vector<double> by_state =
          along(total.t, own, dt(direction), sensitivity(x, d), what, [&](double at, std::vector<double> state) {
            take_samples(own_, due, at, state);
            return state;
          });
      for (std::size_t i = 0; i < n_; ++i)
        total.x[(d + 1) * n_ + i] = direction.scale * (by_state[i] + by_scene.value[i]);
    }
    std::copy(after.begin(), after.end(), total.x.begin());
  }

  /// The derivative of a function of (t, x) along (dt, dx), by differences as wide as it is smooth.
  template <class What, class Function>
  std::vector<double> along(double t, const std::vector<double>& x, double dt, const std::vector<double>& dx,
                            const What& what, const Function& function) const {
    const std::vector<double> middle = function(t, x);
    const double size = largest(dx);
    if (size == 0 && dt == 0) return std::vector<double>(middle.size(), 0.0);
    const double widest = std::max(size > 0 ? std::max(largest(x), scene_.atol) / size : 0,
                                   dt != 0 ? (scene_.t1 - scene_.t0) / std::abs(dt) : 0);
    double step = std::ldexp(1.0, std::ilogb(widest));
    for (int attempt = 0; attempt < most_differences; ++attempt) {
      step = std::ldexp(step, smaller_differences);
      std::vector<std::vector<double>> beside;
      for (const double offset : difference_offsets(step)) {
        std::vector<double> at = x;
        for (std::size_t i = 0; i < n_; ++i) at[i] += offset * dx[i];
        beside.push_back(function(t + offset * dt, std::move(at)));
      }
      Slopes found = slopes(middle, beside, step);
      if (found.smooth) return found.value;
    }
    refuse_sensitivity(what());
  }

  /// At an event that changes the state. False: its condition does not hold.
  bool reset(const eom::EventPoint& point) {
    const std::size_t i = point.crossing.function;
    const double t = point.t;
    const std::string& name = own_.problem.events[i].name;
    std::vector<double> x(point.x.begin(), point.x.end()), own(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n_));
    if (!own_.resets.occurs(i, t, own.data())) return false;
    for (const std::size_t j : point.simultaneous) {
      if (j < own_.problem.events.size())
        refuse_sensitivity(
            fmt::format("the events '{}' and '{}' occur at the same time t = {}, and their order changes", name,
                        own_.problem.events[j].name, t));
    }
    std::vector<double> before(n_), behind(n_), after = own;
    if (rhs(t, own.data(), before) != 0) return true;  // the integration reports it
    apply_reset(own_, i, t, after);
    std::vector<double> s_after, times;
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      const Direction& direction = directions_[d];
      const auto what = [&] {
        return fmt::format("the event '{}' at t = {} does not change smoothly with {}", name, t, direction.name);
      };
      times.push_back(time_change(i, t, x, d));
      std::vector<std::vector<double>> beside;
      for (const auto& neighbour : neighbours(d)) {
        neighbour->enter(segment_);
        neighbour->context.model.set_mode(own_.context.model.mode());
        beside.push_back(own);
        apply_reset(*neighbour, i, t, beside.back());
      }
      const Slopes by_scene = slopes(after, beside, direction.step);
      if (!by_scene.smooth) refuse_sensitivity(what());
      std::vector<double> s = sensitivity(x, d);
      for (std::size_t k = 0; k < n_; ++k) s[k] += before[k] * times[d];
      const std::vector<double> by_state = along(t, own, times[d], s, what, [&](double at, std::vector<double> state) {
        apply_reset(own_, i, at, state);
        return state;
      });
      for (std::size_t k = 0; k < n_; ++k) s_after.push_back(direction.scale * (by_state[k] + by_scene.value[k]));
    }
    std::copy(after.begin(), after.end(), point.x.begin());
    own_.context.freeze_branches(t, after.data(), true);
    if (rhs(t, after.data(), behind) != 0) return true;
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      const double by = directions_[d].scale * times[d];
      for (std::size_t k = 0; k < n_; ++k) point.x[(d + 1) * n_ + k] = s_after[d * n_ + k] - by * behind[k];
    }
    return true;
  }

  /// At a kink whose surface depends on the state. False: x and s go on unchanged.
  bool cross_surface(const eom::EventPoint& point) {
    RunContext& context = own_.context;
    std::vector<double> before(n_), after(n_);
    const int code = rhs(point.t, point.x.data(), before);
    const std::vector<double> x(point.x.begin(), point.x.end());
    std::vector<double> dt(directions_.size());
    const eom::ModeArray mode = context.model.mode();
    context.kinks.flip_branch(point.t, point.crossing.function - context.events.first_kink(), point.crossing.up);
    const eom::ModeArray flipped = context.model.mode();
    if (code != 0 || rhs(point.t, point.x.data(), after) != 0) return true;  // the integration reports it
    double jump = 0;
    for (std::size_t i = 0; i < n_; ++i) jump = std::max(jump, std::abs(before[i] - after[i]));
    if (jump <= continuous * largest(before)) return false;
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      context.model.set_mode(mode);
      const double by = directions_[d].scale * time_change(point.crossing.function, point.t, x, d);
      for (std::size_t i = 0; i < n_; ++i) point.x[(d + 1) * n_ + i] += by * (before[i] - after[i]);
    }
    context.model.set_mode(flipped);
    return true;
  }

  /// The change along direction d of the time at which an event function is 0. x: with every s.
  double time_change(std::size_t function, double t, const std::vector<double>& x, std::size_t d) {
    const Direction& direction = directions_[d];
    const std::vector<double> own(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n_));
    const auto value = [&](VariationalEquations& in, double at,
                           const std::vector<double>& state) -> std::vector<double> {
      std::vector<double> g(in.context.events.size());
      if (in.context.events(at, state.data(), g.data()) != 0) return {std::nan("")};
      return {g[function]};
    };
    const auto what = [&] {
      return fmt::format("the time t = {} of an event or kink does not change smoothly with {}", t, direction.name);
    };
    const std::vector<double> middle = value(own_, t, own);
    std::vector<std::vector<double>> beside;
    for (const auto& neighbour : neighbours(d)) {
      neighbour->enter(segment_);
      neighbour->context.model.set_mode(own_.context.model.mode());
      beside.push_back(value(*neighbour, t, own));
    }
    const Slopes by_scene = slopes(middle, beside, direction.step);
    if (!by_scene.smooth) refuse_sensitivity(what());
    const auto own_value = [&](double at, const std::vector<double>& state) { return value(own_, at, state); };
    const double by_state = along(t, own, 0, sensitivity(x, d), what, own_value)[0];
    std::vector<double> f(n_);
    if (rhs(t, own.data(), f) != 0) refuse_sensitivity(what());
    const double dt = -(by_scene.value[0] + by_state) / along(t, own, 1, f, what, own_value)[0];
    if (!std::isfinite(dt)) refuse_sensitivity(what());
    return dt;
  }

  /// s of direction d, without its scale.
  std::vector<double> sensitivity(const std::vector<double>& x, std::size_t d) const {
    std::vector<double> s(n_);
    for (std::size_t i = 0; i < n_; ++i) s[i] = x[(d + 1) * n_ + i] / directions_[d].scale;
    return s;
  }

  const std::vector<std::unique_ptr<VariationalEquations>>& neighbours(std::size_t d) {
    neighbours_.resize(directions_.size());
    std::vector<std::unique_ptr<VariationalEquations>>& made = neighbours_[d];
    if (!made.empty()) return made;
    for (const Scene& scene : directions_[d].beside)
      made.push_back(std::make_unique<VariationalEquations>(problem_in(scene, own_.problem), kink_times(scene)));
    return made;
  }

  /// The event that ended the run.
  std::optional<std::size_t> stopping_event() const {
    if (motion_.outcome != eom::Outcome::stopped_by_event) return std::nullopt;
    for (auto event = motion_.events.rbegin(); event != motion_.events.rend(); ++event) {
      if (event->kind != "stop") continue;
      for (std::size_t i = 0; i < own_.problem.events.size(); ++i) {
        if (own_.problem.events[i].name == event->name) return i;
      }
    }
    refuse_sensitivity("the run is stopped by what is no event of the model");
  }

  const Scene& scene_;
  const RunResult& motion_;
  const std::string& solver_;
  const std::vector<Direction>& directions_;
  VariationalEquations own_;
  std::size_t n_;
  std::size_t segment_ = 0;  // between kinks in time
  std::vector<double> u_, dfdx_, dfdt_, dfdp_, dfdu_, f_, slopes_;
  std::vector<std::vector<std::unique_ptr<VariationalEquations>>> neighbours_;  // per direction, made where needed
};

VariationalRun::VariationalRun(const RunRequest& request, const RunResult& motion, const std::string& solver,
                               const std::vector<Direction>& directions)
    : run_(std::make_unique<Run>(request, motion, solver, directions)) {}
VariationalRun::~VariationalRun() = default;

eom::Result VariationalRun::operator()(const eom::Options& options) { return run_->run(options); }

}  // namespace eomgen::run
