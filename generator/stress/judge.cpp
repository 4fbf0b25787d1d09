// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "run/integration.hpp"
#include "stress/stress.hpp"

namespace eomgen::stress {
namespace {

using Clock = std::chrono::steady_clock;
using State = std::vector<double>;

constexpr double kept_within = 100;         // tolerances, times the condition of the end state
constexpr double told_within = 10;          // estimates
constexpr double most_condition = 1.6e5;    // e^12: beyond twelve Lyapunov times only invariants say anything
constexpr double disturbance = 1e-7;        // of the start: large against rounding, small against what bends
constexpr int shortenings = 12;             // of the span, halved each time, until its end is well determined
constexpr double unit = std::numeric_limits<double>::epsilon();

/// Ends a run that takes too long.
class Alarm {
 public:
  Alarm(double seconds, const std::atomic<bool>* interrupt) : end_(Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds))), interrupt_(interrupt) {}
  bool operator()(const eom::StepView&) { return !(late_ = Clock::now() > end_ || (interrupt_ != nullptr && *interrupt_)); }
  bool late() const { return late_; }

 private:
  Clock::time_point end_;
  const std::atomic<bool>* interrupt_;
  bool late_ = false;
};

/// Where the motion ends, and how well that is known.
struct Truth {
  State x;
  State scale;             // largest value of each component along the motion
  double uncertainty = 0;  // relative to it
  double condition = 1;
};

double distance(const State& a, const State& b, const State& scale) {
  double largest = 0;
  for (std::size_t i = 0; i < scale.size(); ++i) {
    const double d = std::abs(a[i] - b[i]) / scale[i];
    if (!(d <= largest)) largest = d;
  }
  return largest;
}

class Judgement {
 public:
  Judgement(const run::Scene& scene, const Request& request) : scene_(scene), request_(request), run_(request.run(scene)) {
    run_.estimate = false;
    run_.watch_power = false;
  }

  /// Two tight runs by methods that have nothing in common but the right-hand side; nothing where they do not come to the end or not to the same.
  std::optional<Truth> truth(std::string& why) {
    Truth truth;
    State first, second;
    why = "no solver comes to the end in time at a tight tolerance";
    for (const auto& [solver, rtol] : {std::pair<const char*, double>{"dop853", 1e-14}, {"taylor", 1e-15}, {"radau5", 1e-12}, {"rodas", 1e-11}}) {
      if (!fits(solver)) continue;
      State scale;
      const std::optional<State> x = tight(solver, rtol, nullptr, &scale);
      if (!x) continue;
      if (first.empty()) {
        first = *x;
        truth.scale = scale;
        tight_solver_ = solver;
        tight_rtol_ = rtol;
      } else {
        second = *x;
        break;
      }
    }
    if (second.empty()) return std::nullopt;
    truth.x = first;
    truth.uncertainty = distance(first, second, truth.scale);
    truth.condition = condition(truth);
    return truth;
  }

  Row row(const std::string& test, const std::string& solver, const Truth* truth) {
    Row row;
    row.test = test;
    row.solver = solver;
    run::Scene scene = scene_;
    scene.solver = solver;
    const eom::MethodInfo& method = run::method_named(solver);
    if (!method.adaptive) scene.step = std::abs(scene.t1 - scene.t0) / fixed_steps;
    run::RunRequest request = request_.run(scene);
    request.watch_power = false;
    std::atomic<bool> stop{false};
    Alarm alarm(request_.seconds_limit, request_.interrupt);
    request.interrupt = &stop;
    request.progress = [&](double) {
      if (!alarm(eom::StepView{})) stop = true;
    };
    const Clock::time_point start = Clock::now();
    const run::RunResult result = run::integrate_scene(request);
    row.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    row.outcome = alarm.late() ? "interrupted" : eom::name(result.outcome);
    row.note = alarm.late() ? "takes longer than the limit" : !result.detail.empty() ? result.detail : result.estimate_note;
    const bool done = !alarm.late() && result.outcome == eom::Outcome::done;
    if (truth == nullptr) {
      row.verdict = done ? Verdict::silent : Verdict::told;
      row.error = row.estimate = std::numeric_limits<double>::infinity();
      return row;
    }
    row.condition = truth->condition;
    if (!done) {
      row.error = row.estimate = std::numeric_limits<double>::infinity();
      return row;
    }
    judge(result, *truth, method.adaptive, row);
    return row;
  }

  bool fits(const std::string& solver) const { return run::unfit(solver, scene_).empty() && (!run::method_named(solver).series || run_.code.taylor != nullptr); }

 private:
  static constexpr double fixed_steps = 2000;

  void judge(const run::RunResult& result, const Truth& truth, bool adaptive, Row& row) const {
    double tolerance = scene_.rtol;
    for (std::size_t i = 0; i < truth.x.size(); ++i) {
      const std::string& name = run_.state_names[i];
      const auto found = std::find_if(result.final.begin(), result.final.end(), [&](const auto& entry) { return entry.first == name; });
      const auto told = std::find_if(result.error_estimate.begin(), result.error_estimate.end(), [&](const auto& entry) { return entry.first == name; });
      const double error = std::abs(found->second - truth.x[i]) / truth.scale[i];
      if (!(error <= row.error)) row.error = error;
      if (told != result.error_estimate.end()) row.estimate = std::max(row.estimate, told->second / truth.scale[i]);
      tolerance = std::max(tolerance, scene_.atol / truth.scale[i]);
    }
    const double beyond = row.error - truth.uncertainty;
    // The start itself is rounded to binary64, and so is every sum on the way.
    if (adaptive && beyond <= kept_within * std::max(tolerance, unit) * truth.condition) row.verdict = Verdict::kept;
    else if (beyond <= told_within * row.estimate || !result.estimate_note.empty()) row.verdict = Verdict::told;
    else row.verdict = std::isnan(row.error) ? Verdict::told : Verdict::silent;
  }

  std::optional<State> tight(const std::string& solver, double rtol, const State* start, State* scale) {
    run::Scene scene = scene_;
    if (start != nullptr) put(*start, scene);
    run::RunRequest request = request_.run(scene);
    request.estimate = request.watch_power = false;
    run::Integration integration(request, solver);
    eom::Options options;
    options.rtol = rtol;
    options.atol = rtol * 1e-3;
    Alarm alarm(request_.seconds_limit, request_.interrupt);
    const State x0 = integration.initial_state();
    if (scale != nullptr) scale->assign(x0.size(), 0);
    const eom::Result end = integration.run(options, [&](const eom::StepView& view) {
      for (std::size_t i = 0; scale != nullptr && i < view.x1.size(); ++i) (*scale)[i] = std::max((*scale)[i], std::abs(view.x1[i]));
      return alarm(view);
    });
    if (end.outcome != eom::Outcome::done || alarm.late()) return std::nullopt;
    if (scale != nullptr) level(*scale, x0);
    return State(end.x.begin(), end.x.begin() + static_cast<std::ptrdiff_t>(run_.state_names.size()));
  }

  // A component that stays 0 beside others of its kind is 0 to their rounding.
  void level(State& scale, const State& x0) const {
    scale.resize(run_.state_names.size());
    double largest = 0;
    for (std::size_t i = 0; i < scale.size(); ++i) largest = std::max(largest, scale[i] = std::max(scale[i], std::abs(x0[i])));
    for (double& s : scale) s = std::max({s, 1e-9 * largest, std::numeric_limits<double>::min()});
  }

  void put(const State& x, run::Scene& scene) const {
    const std::vector<std::uint32_t>& free = run_.code.free;
    for (std::size_t i = 0; i < free.size(); ++i) {
      scene.q[free[i]] = x[i];
      scene.qdot[free[i]] = x[free.size() + i];
    }
  }

  /// By how much more than the start the end moves, both relative: of disturbances along and against, the larger.
  double condition(const Truth& truth) {
    double largest = 1;
    run::Integration integration(run_, tight_solver_);
    const State x0 = integration.initial_state();
    const std::size_t n = run_.code.free.size();
    for (const int pattern : {0, 1, 2}) {
      State x = x0;
      for (std::size_t i = 0; i < 2 * n; ++i) {
        const double sign = pattern == 0 ? 1 : ((i >> (pattern - 1)) & 1) != 0 ? -1 : 1;
        x[i] += sign * disturbance * truth.scale[i];
      }
      const std::optional<State> end = tight(tight_solver_, std::max(tight_rtol_, 1e-13), &x, nullptr);
      if (end) largest = std::max(largest, distance(*end, truth.x, truth.scale) / disturbance);
    }
    return largest;
  }

  const run::Scene& scene_;
  const Request& request_;
  run::RunRequest run_;
  std::string tight_solver_;
  double tight_rtol_ = 0;
};

}  // namespace

std::vector<Row> judge(const Case& test, const run::Scene& given, const Request& request, std::string& left_out) {
  run::Scene scene = given;
  std::vector<Row> rows;
  std::optional<Truth> truth;
  if (!test.without_value) {
    for (int k = 0; k <= shortenings; ++k) {
      if (request.interrupt != nullptr && *request.interrupt) return rows;
      truth = Judgement(scene, request).truth(left_out);
      if (truth && truth->condition <= most_condition && truth->uncertainty < 1e-6) break;
      if (truth) left_out = fmt::format("the end depends on the start by a factor of {:.1e}, and is known to {:.1e}", truth->condition, truth->uncertainty);
      truth.reset();
      scene.t1 = scene.t0 + (scene.t1 - scene.t0) / 2;
    }
    if (!truth) return rows;
  }
  left_out.clear();
  Judgement judgement(scene, request);
  for (const std::string& solver : request.solvers) {
    if (request.interrupt != nullptr && *request.interrupt) break;
    if (!judgement.fits(solver)) continue;
    if (request.progress) request.progress(test.name + ", " + solver);
    rows.push_back(judgement.row(test.name, solver, truth ? &*truth : nullptr));
    if (scene.t1 != given.t1 && rows.back().note.empty()) rows.back().note = fmt::format("until t = {:g}", scene.t1);
  }
  return rows;
}

}  // namespace eomgen::stress
