// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "numeric/dense.hpp"
#include "stress/reference_solution.hpp"
#include "stress/stress.hpp"

namespace eomgen::stress {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double kept_within = 100;  // tolerances times the condition of the end state
constexpr double told_within = 10;   // estimates
constexpr std::size_t most_fixed_steps = 2000;
constexpr double limit_of_rk4 = 2.8;  // 2.785 along the real axis, 2.828 along the imaginary one
constexpr double fewest_stable = 4;   // least number of stable steps in a span
constexpr int shortenings = 24;       // of the span, each at least by half, until its end state is well determined

class Assessment {
 public:
  Assessment(const Case& test, const run::Scene& scene, const Request& request, const ReferenceSolution* reference,
            double stable_step)
      : test_(test), scene_(scene), request_(request), reference_(reference), stable_step_(stable_step) {}

  Row row(const std::string& solver) {
    Row row;
    row.test = test_.name;
    row.solver = solver;
    if (reference_ != nullptr) row.condition = reference_->condition;
    Clock clock(request_.seconds_limit, request_.interrupt);
    const run::RunResult result = made(scene_, solver, clock);
    row.seconds = clock.seconds();
    row.outcome = clock.was_late() ? "interrupted" : eom::name(result.outcome);
    row.note = clock.was_late()         ? "exceeds the time limit"
               : !result.detail.empty() ? result.detail
                                        : result.estimate_note;
    if (clock.was_late() || result.outcome != eom::Outcome::done) {
      row.error = row.estimate = infinity;
      row.verdict = Verdict::reported;
    } else if (reference_ != nullptr) {
      compare(result, run::method_named(solver).adaptive, row);
    } else {
      row.error = row.estimate = infinity;
      row.verdict = Verdict::undetected;
      row.note = "no motion exists, but the outcome is done";
    }
    return row;
  }

 private:
  double fixed_steps() const {
    const std::size_t usual = std::min(most_fixed_steps, std::max<std::size_t>(1, request_.steps_limit / 4));
    return test_.of_limit ? std::ceil((scene_.t1 - scene_.t0) / (*test_.of_limit * stable_step_))
                          : static_cast<double>(usual);
  }

  run::RunResult made(const run::Scene& given, const std::string& solver, Clock& clock) const {
    run::Scene scene = given;
    scene.solver = solver;
    if (!run::method_named(solver).adaptive) scene.step = (scene.t1 - scene.t0) / fixed_steps();
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
    const double condition = std::min(reference_->condition, most_condition),
                 largest = *std::max_element(reference_->scale.begin(), reference_->scale.end());
    bool kept = true;
    for (std::size_t i = 0; i < reference_->x.size(); ++i) {
      const double scale = reference_->scale[i], error = std::abs(result.state[i] - reference_->x[i]) / scale;
      // The start and every sum are rounded to binary64, relative to the largest component.
      double tolerance = unit * largest / scale;
      if (adaptive)
        tolerance =
            std::max({tolerance, scene_.rtol, scene_.atol / scale});  // a fixed step promises only its error estimate
      kept = kept && error <= kept_within * tolerance * condition;
      row.error = std::isnan(error) ? infinity : std::max(row.error, error);
      row.estimate = std::max(row.estimate, result.error_estimate[i].second / scale);
    }
    if (kept)
      row.verdict = Verdict::pass;
    else if (row.error - reference_->uncertainty <= told_within * row.estimate || result.doubt)
      row.verdict = Verdict::reported;
    else
      row.verdict = Verdict::undetected;
  }

  const Case& test_;
  const run::Scene& scene_;
  const Request& request_;
  const ReferenceSolution* reference_;
  double stable_step_;  // for cases with fixed steps near the stability limit
};

/// The longest step at which rk4 does not amplify any mode of the Jacobian of the right-hand side at the start.
double stable_step(const run::Scene& scene, const Request& request) {
  run::RunRequest run = request.run(scene);
  run.watch_power = false;
  run::Integration integration(run, "dop853");
  const State x = integration.initial_state();
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd J(n, n);
  State high(x.size()), low(x.size()), moved = x;
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto k = static_cast<std::size_t>(j);
    const double d = 1e-6 * std::max(1.0, std::abs(x[k]));
    moved[k] = x[k] + d;
    const int above = integration.derivative(scene.t0, moved.data(), high.data());
    moved[k] = x[k] - d;
    const int below = integration.derivative(scene.t0, moved.data(), low.data());
    moved[k] = x[k];
    if (above != 0 || below != 0) return 0;
    for (Eigen::Index i = 0; i < n; ++i)
      J(i, j) = (high[static_cast<std::size_t>(i)] - low[static_cast<std::size_t>(i)]) / (2 * d);
  }
  if (!J.allFinite()) return 0;
  const double fastest = numeric::eigenvalues(J).cwiseAbs().maxCoeff();
  return fastest > 0 ? limit_of_rk4 / fastest : 0;
}

}  // namespace

std::vector<Row> assess(const Case& test, const run::Scene& given, const Request& request, std::string& left_out) {
  run::Scene scene = given;
  std::vector<Row> rows;
  std::optional<ReferenceSolution> reference;
  const auto interrupted = [&] { return request.interrupt != nullptr && *request.interrupt; };
  if (!test.without_value) {
    for (int k = 0; k <= shortenings && !reference; ++k) {
      if (interrupted()) return rows;
      double next = 0;
      reference = ReferenceRuns(scene, given.t1 - given.t0, test.nearness, request).solution(left_out, next);
      if (reference) break;
      if (next == 0) return rows;
      scene.t1 = scene.t0 + next;
    }
    if (!reference) return rows;
  }
  left_out.clear();
  if (reference && request.seen) request.seen(test, scene, reference->samples);
  const double stable = test.of_limit ? stable_step(scene, request) : 0;
  if (test.of_limit && !(stable > 0 && (scene.t1 - scene.t0) / stable > fewest_stable)) {
    left_out = "it has no motion that is fast enough to make a few steps unstable";
    return rows;
  }
  Assessment assessment(test, scene, request, reference ? &*reference : nullptr, stable);
  const run::RunRequest run = request.run(scene);
  for (const std::string& solver : request.solvers) {
    if (interrupted()) break;
    if (!run::eligible(solver, scene, run.code) || (test.of_limit && run::method_named(solver).adaptive)) continue;
    if (request.progress) request.progress(test.name + ", " + solver);
    rows.push_back(assessment.row(solver));
    if (scene.t1 != given.t1 && rows.back().note.empty()) rows.back().note = fmt::format("until t = {:g}", scene.t1);
  }
  return rows;
}

}  // namespace eomgen::stress
