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

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double pass_within = 100;     // tolerances times the condition of the end state
constexpr double reported_within = 10;  // estimates
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
    TimeLimit clock(request_.seconds_limit, request_.interrupt);
    const run::RunResult result = run_solver(scene_, solver, clock);
    row.seconds = clock.seconds();
    row.outcome = clock.was_exceeded() ? "interrupted" : eom::name(result.outcome);
    row.note = clock.was_exceeded()     ? "exceeds the time limit"
               : !result.detail.empty() ? result.detail
                                        : result.estimate_note;
    if (clock.was_exceeded() || result.outcome != eom::Outcome::done) {
      row.error = row.estimate = unbounded;
      row.verdict = Verdict::reported;
    } else if (reference_ != nullptr) {
      compare(result, run::get_method(solver).adaptive, row);
    } else {
      row.error = row.estimate = unbounded;
      row.verdict = Verdict::undetected;
      row.note = "no motion exists, but the outcome is done";
    }
    return row;
  }

 private:
  double fixed_steps() const {
    const std::size_t usual = std::min(most_fixed_steps, std::max<std::size_t>(1, request_.steps_limit / 4));
    return test_.stability_fraction ? std::ceil((scene_.t1 - scene_.t0) / (*test_.stability_fraction * stable_step_))
                                    : static_cast<double>(usual);
  }

  run::RunResult run_solver(const run::Scene& given, const std::string& solver, TimeLimit& clock) const {
    run::Scene scene = given;
    scene.solver = solver;
    if (!run::get_method(solver).adaptive) scene.step = (scene.t1 - scene.t0) / fixed_steps();
    run::RunRequest request = request_.run(scene);
    request.watch_power = false;
    request.max_steps = request_.steps_limit;
    std::atomic<bool> stop{false};
    request.interrupt = &stop;
    request.progress = [&](double) {
      if (clock.is_exceeded()) stop = true;
    };
    return run::integrate_scene(request);
  }

  void compare(const run::RunResult& result, bool adaptive, Row& row) const {
    const double condition = std::min(reference_->condition, max_condition),
                 largest = *std::max_element(reference_->scale.begin(), reference_->scale.end());
    bool passes = true;
    for (std::size_t i = 0; i < reference_->x.size(); ++i) {
      const double scale = reference_->scale[i], error = std::abs(result.state[i] - reference_->x[i]) / scale;
      // The start and every sum are rounded to binary64, relative to the largest component.
      double tolerance = unit_roundoff * largest / scale;
      if (adaptive)
        tolerance =
            std::max({tolerance, scene_.rtol, scene_.atol / scale});  // a fixed step promises only its error estimate
      passes = passes && error <= pass_within * tolerance * condition;
      row.error = std::isnan(error) ? unbounded : std::max(row.error, error);
      row.estimate = std::max(row.estimate, result.error_estimate[i].second / scale);
    }
    if (passes)
      row.verdict = Verdict::pass;
    else if (row.error - reference_->uncertainty <= reported_within * row.estimate || result.estimate_warning)
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
  run::Integration integration(run, run::default_solvers.adaptive);
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
  if (!test.has_no_motion) {
    for (int k = 0; k <= shortenings && !reference; ++k) {
      if (interrupted()) return rows;
      double next = 0;
      reference =
          ReferenceSolver(scene, given.t1 - given.t0, test.singularity_distance, request).solution(left_out, next);
      if (reference) break;
      if (next == 0) return rows;
      scene.t1 = scene.t0 + next;
    }
    if (!reference) return rows;
  }
  left_out.clear();
  if (reference && request.on_motion) request.on_motion(test, scene, reference->samples);
  const double stable = test.stability_fraction ? stable_step(scene, request) : 0;
  if (test.stability_fraction && !(stable > 0 && (scene.t1 - scene.t0) / stable > fewest_stable)) {
    left_out = "it has no motion that is fast enough to make a few steps unstable";
    return rows;
  }
  Assessment assessment(test, scene, request, reference ? &*reference : nullptr, stable);
  const run::RunRequest run = request.run(scene);
  for (const std::string& solver : request.solvers) {
    if (interrupted()) break;
    if (!run::check_eligibility(solver, scene, run.code) ||
        (test.stability_fraction && run::get_method(solver).adaptive))
      continue;
    if (request.progress) request.progress(test.name + ", " + solver);
    rows.push_back(assessment.row(solver));
    if (scene.t1 != given.t1 && rows.back().note.empty()) rows.back().note = fmt::format("until t = {:g}", scene.t1);
  }
  return rows;
}

}  // namespace eomgen::stress
