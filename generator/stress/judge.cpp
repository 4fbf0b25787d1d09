// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "stress/stress.hpp"
#include "stress/yardstick.hpp"

namespace eomgen::stress {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double kept_within = 100;   // tolerances, times the condition of the end state
constexpr double told_within = 10;    // estimates
constexpr std::size_t most_fixed_steps = 2000;
constexpr int shortenings = 24;       // of the span, each to a half at most, until its end is well determined

class Judgement {
 public:
  Judgement(const Case& test, const run::Scene& scene, const Request& request, const Truth* truth)
      : test_(test), scene_(scene), request_(request), truth_(truth) {}

  Row row(const std::string& solver) {
    Row row;
    row.test = test_.name;
    row.solver = solver;
    if (truth_ != nullptr) row.condition = truth_->condition;
    Clock clock(request_.seconds_limit, request_.interrupt);
    const run::RunResult result = made(scene_, solver, clock);
    row.seconds = clock.seconds();
    row.outcome = clock.was_late() ? "interrupted" : eom::name(result.outcome);
    row.note = clock.was_late() ? "takes longer than the limit of time" : !result.detail.empty() ? result.detail : result.estimate_note;
    if (clock.was_late() || result.outcome != eom::Outcome::done) {
      row.error = row.estimate = infinity;
      row.verdict = Verdict::told;
    } else if (truth_ != nullptr) {
      compare(result, run::method_named(solver).adaptive, row);
    } else {
      without_value(result, solver, row);
    }
    return row;
  }

 private:
  run::RunResult made(const run::Scene& given, const std::string& solver, Clock& clock) const {
    run::Scene scene = given;
    scene.solver = solver;
    const std::size_t fixed_steps = std::min(most_fixed_steps, std::max<std::size_t>(1, request_.steps_limit / 4));
    if (!run::method_named(solver).adaptive) scene.step = std::abs(scene.t1 - scene.t0) / static_cast<double>(fixed_steps);
    run::RunRequest request = request_.run(scene);
    request.watch_power = false;
    request.max_steps = request_.steps_limit;
    std::atomic<bool> stop{false};
    request.interrupt = &stop;
    request.progress = [&](double) {
      if (clock.late()) stop = true;
    };
    return run::integrate_scene(request);
  }

  void compare(const run::RunResult& result, bool adaptive, Row& row) const {
    double tolerance = adaptive ? scene_.rtol : 0;  // a fixed step promises no more than what its estimate says
    for (std::size_t i = 0; i < truth_->x.size(); ++i) {
      const std::string& name = result.error_estimate[i].first;
      const auto found = std::find_if(result.final.begin(), result.final.end(), [&](const auto& entry) { return entry.first == name; });
      const double error = std::abs(found->second - truth_->x[i]) / truth_->scale[i];
      row.error = std::isnan(error) ? infinity : std::max(row.error, error);
      row.estimate = std::max(row.estimate, result.error_estimate[i].second / truth_->scale[i]);
      if (adaptive) tolerance = std::max(tolerance, scene_.atol / truth_->scale[i]);
    }
    // The start itself is rounded to binary64, and so is every sum on the way.
    if (row.error <= kept_within * std::max(tolerance, unit) * truth_->condition) row.verdict = Verdict::kept;
    else if (row.error - truth_->uncertainty <= told_within * row.estimate || !result.estimate_note.empty()) row.verdict = Verdict::told;
    else row.verdict = Verdict::silent;
  }

  /// A run that calls itself done although a value is none: its numbers say so, or it is the same run for any value.
  void without_value(const run::RunResult& result, const std::string& solver, Row& row) const {
    row.error = row.estimate = infinity;
    const auto wrong = std::find_if(result.final.begin(), result.final.end(), [](const auto& entry) { return !std::isfinite(entry.second); });
    if (wrong != result.final.end()) {
      row.verdict = Verdict::told;
      row.note = fmt::format("the motion does not depend on it, and {} is {}", wrong->first, wrong->second);
      return;
    }
    row.verdict = Verdict::silent;
    row.note = "no value for it exists, and no number of the result says so";
    for (const double value : {1.0, 2.0}) {
      run::Scene scene = scene_;
      for (const auto& [p, none] : test_.value) scene.parameters[p] = value;
      Clock clock(request_.seconds_limit, request_.interrupt);
      const run::RunResult other = made(scene, solver, clock);
      if (other.outcome != eom::Outcome::done || other.final != result.final) return;
    }
    row.verdict = Verdict::kept;
    row.error = 0;
    row.note = "the same for any value";
  }

  const Case& test_;
  const run::Scene& scene_;
  const Request& request_;
  const Truth* truth_;
};

}  // namespace

std::vector<Row> judge(const Case& test, const run::Scene& given, const Request& request, std::string& left_out) {
  run::Scene scene = given;
  std::vector<Row> rows;
  std::optional<Truth> truth;
  const auto interrupted = [&] { return request.interrupt != nullptr && *request.interrupt; };
  if (!test.without_value) {
    for (int k = 0; k <= shortenings && !truth; ++k) {
      if (interrupted()) return rows;
      double next = 0;
      truth = Yardstick(scene, request).truth(left_out, next);
      if (truth) break;
      if (next == 0) return rows;
      scene.t1 = scene.t0 + next;
    }
    if (!truth) return rows;
  }
  left_out.clear();
  Judgement judgement(test, scene, request, truth ? &*truth : nullptr);
  const run::RunRequest run = request.run(scene);
  for (const std::string& solver : request.solvers) {
    if (interrupted()) break;
    if (!fits(solver, scene, run.code)) continue;
    if (request.progress) request.progress(test.name + ", " + solver);
    rows.push_back(judgement.row(solver));
    if (scene.t1 != given.t1 && rows.back().note.empty()) rows.back().note = fmt::format("until t = {:g}", scene.t1);
  }
  return rows;
}

}  // namespace eomgen::stress
