// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/benchmark.hpp"

#include "analysis/benchmark.hpp"
#include "analysis/stress_test.hpp"
#include "eomgen/call.hpp"
#include "eomgen/model.hpp"
#include "eomgen/validation.hpp"

namespace eomgen {
namespace {

/// Options that benchmark and stress test have in common: scene, solvers, limits, callbacks and stop request.
template <class Request, class Options>
Request request_of(const std::shared_ptr<const model::Model>& model, const Options& options, const CallControl& control,
                   const CallListener& call) {
  Request request;
  request.model = model;
  request.scene = options.scene;
  request.overrides.values = exact_rationals(options.parameters);
  request.overrides.t_end = options.t_end;
  request.solvers = options.solvers;
  request.max_seconds = options.max_seconds;
  request.seed = options.seed;
  request.progress = control.on_stage;
  request.interrupt = call.stopped();
  return request;
}

}  // namespace

Benchmark Model::benchmark(const BenchmarkOptions& options, const CallControl& control) const {
  require_valid(options);
  return with_lock(control, [&](CallListener& call) {
    auto request = request_of<analysis::BenchmarkRequest>(read_, options, control, call);
    request.other_libraries = options.other_libraries;
    const analysis::Benchmark found = analysis::benchmark(request);
    Benchmark result;
    result.rows = found.rows;
    for (const auto& [solver, why] : found.left_out) result.left_out.push_back({solver, why});
    result.reference_digits = found.reference.digits_at_end;
    result.advice = bench::recommend_solvers(found.rows);
    result.conclusive = found.conclusive();
    return result;
  });
}

StressTest Model::stress_test(const StressOptions& options, const CallControl& control) const {
  require_valid(options);
  return with_lock(control, [&](CallListener& call) {
    auto request = request_of<analysis::StressRequest>(read_, options, control, call);
    request.max_steps = options.max_steps;
    request.quick = options.quick;
    const analysis::StressFindings found = analysis::stress_test(request);
    StressTest result;
    for (const stress::Row& row : found.rows)
      result.rows.push_back(
          {row.test, row.solver, stress::name(row.verdict), row.error, row.estimate, row.outcome, row.note});
    for (const auto& [test, why] : found.left_out) result.left_out.push_back({test, why});
    result.pass = found.count(stress::Verdict::pass);
    result.reported = found.count(stress::Verdict::reported);
    result.undetected = found.count(stress::Verdict::undetected);
    return result;
  });
}

}  // namespace eomgen
