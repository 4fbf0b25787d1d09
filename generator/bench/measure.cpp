// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bench/bench.hpp"
#include "bench/median_time.hpp"
#include "run/integration.hpp"

namespace eomgen::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int tightest = 13;   // rtol from 1e-3 to 1e-13
constexpr int step_sizes = 9;  // of solvers with fixed steps, halved from one to the next

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class Measurement {
 public:
  explicit Measurement(const Request& request) : request_(request), scales_(component_scales(request.reference)) {}

  Row row(const std::string& solver, double rtol, double step) {
    Row row;
    row.solver = solver;
    row.rtol = step > 0 ? 0 : rtol;
    row.step = step;
    const run::Scene& scene = request_.run.scene;
    eom::Options options;
    options.rtol = rtol;
    options.atol = scene.rtol > 0 ? rtol * scene.atol / scene.rtol : rtol;
    options.fixed_step = step;
    options.interrupt = request_.run.interrupt;
    run::Integration integration(request_.run, solver);
    const eom::Result result = integrate_and_assess(integration, options, row);
    row.steps = result.statistics.steps;
    row.rejected = result.statistics.rejected;
    row.rhs_evaluations = result.statistics.rhs_evaluations;
    if (result.outcome == eom::Outcome::done) time(integration, options, row);
    return row;
  }

  Row run_external(const ExternalSolver& other, double rtol) {
    const run::Scene& scene = request_.run.scene;
    Row row = other.run(rtol, scene.rtol > 0 ? rtol * scene.atol / scene.rtol : rtol);
    if (row.errors.empty()) {
      row.error = row.error_along = std::numeric_limits<double>::infinity();
      return row;
    }
    row.error = 0;
    for (std::size_t i = 0; i < row.errors.size(); ++i) {  // they hold the end state
      row.errors[i] = std::abs(row.errors[i] - request_.reference.x.back()[i]);
      row.error = std::max(row.error, row.errors[i] / scales_[i]);
    }
    row.error_along = row.error;
    return row;
  }

 private:
  /// The run that determines the error, evaluated at the times of the reference.
  eom::Result integrate_and_assess(run::Integration& integration, const eom::Options& options, Row& row) {
    const Clock::time_point start = Clock::now();
    const auto& reference = request_.reference.x;
    bool late = false;
    std::size_t next = 0;
    std::vector<double> x;
    const auto observe = [&](const eom::StepView& view) {
      x.resize(view.x1.size());
      for (; next + 1 < reference.size(); ++next) {
        const double t = request_.times[next];
        if (view.t1 > view.t0 ? t > view.t1 : t < view.t1) break;
        view.interpolate(t, x);
        row.error_along = std::max(row.error_along, worst(x, reference[next]));
      }
      late = seconds_since(start) > request_.seconds_limit;
      return !late;
    };
    const eom::Result result = integration.run(options, observe);
    row.outcome = late ? eom::name(eom::Outcome::interrupted) : eom::name(result.outcome);
    if (result.outcome != eom::Outcome::done) {
      row.error = row.error_along = std::numeric_limits<double>::infinity();
      row.seconds = seconds_since(start);
      return result;
    }
    row.error = worst(result.x, reference.back());
    row.error_along = std::max(row.error_along, row.error);
    for (std::size_t i = 0; i < scales_.size(); ++i) row.errors.push_back(std::abs(result.x[i] - reference.back()[i]));
    return result;
  }

  double worst(const std::vector<double>& x, const std::vector<double>& exact) const {
    double largest = 0;
    for (std::size_t i = 0; i < scales_.size(); ++i)
      largest = std::max(largest, std::abs(x[i] - exact[i]) / scales_[i]);
    return largest;
  }

  static void time(run::Integration& integration, const eom::Options& options, Row& row) {
    const Median median = median_time([&] { integration.run(options, {}); });
    row.repeats = median.repeats;
    row.seconds = median.seconds;
  }

  const Request& request_;
  std::vector<double> scales_;
};

}  // namespace

std::vector<double> component_scales(const reference::Solution& reference) {
  std::vector<double> result(reference.x.back().size());
  double largest = 0;
  for (const std::vector<double>& x : reference.x) {
    for (std::size_t i = 0; i < x.size(); ++i) result[i] = std::max(result[i], std::abs(x[i]));
  }
  for (const double s : result) largest = std::max(largest, s);
  for (double& s : result) s = std::max({s, 1e-9 * largest, std::numeric_limits<double>::min()});
  return result;
}

std::vector<Row> measure(const Request& request) {
  Measurement measurement(request);
  std::vector<Row> rows;
  const auto interrupted = [&] { return request.run.interrupt != nullptr && *request.run.interrupt; };
  const run::Scene& scene = request.run.scene;
  const double span = std::abs(scene.t1 - scene.t0);
  double first_step = 16 * scene.step;  // a range around the step of the scene
  if (first_step == 0) {
    // As many steps as an adaptive solver of order 5 takes for 1e-3, so that the step sizes suit the motion.
    const Row rough = measurement.row(run::default_solvers.rough, 1e-3, 0);
    first_step = span / static_cast<double>(std::max<std::size_t>(rough.steps, 10));
  }
  for (const std::string& solver : request.solvers) {
    if (request.progress) request.progress(solver);
    const bool adaptive = run::get_method(solver).adaptive;
    for (int k = 0; k < (adaptive ? tightest - 2 : step_sizes); ++k) {
      if (interrupted()) return rows;
      rows.push_back(adaptive
                         ? measurement.row(solver, std::pow(10.0, -3 - k), 0)
                         : measurement.row(solver, scene.rtol > 0 ? scene.rtol : 1e-9, std::ldexp(first_step, -k)));
      if (rows.back().outcome == "interrupted") break;  // tighter tolerances take longer
    }
  }
  for (const ExternalSolver& other : request.external_solvers) {
    if (request.progress) request.progress(other.name);
    for (int k = 0; k < tightest - 2 && !interrupted(); ++k) {
      rows.push_back(measurement.run_external(other, std::pow(10.0, -3 - k)));
      if (rows.back().outcome == "interrupted" || rows.back().outcome == "failed (-1)") break;
    }
  }
  return rows;
}

}  // namespace eomgen::bench
