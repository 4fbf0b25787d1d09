// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/measures.hpp"

#include "analysis/benchmark.hpp"
#include "analysis/stress_test.hpp"
#include "eomgen/call.hpp"
#include "eomgen/model.hpp"

namespace eomgen {
namespace {

/// Options that benchmark and stress test have in common: scene, solvers, limits, callbacks and stop request.
template <class Request, class Options>
Request request_of(const std::shared_ptr<const model::Model>& model, const Options& options, const Task& task,
                   const Call& call) {
  Request request;
  request.model = model;
  request.scene = options.scene;
  request.overrides.values = exact(options.parameters);
  request.overrides.t_end = options.t_end;
  request.solvers = options.solvers;
  request.seconds = options.seconds;
  request.seed = options.seed;
  request.progress = task.begins;
  request.interrupt = call.stopped();
  return request;
}

}  // namespace

Benchmark Model::benchmark(const BenchmarkOptions& options, const Task& task) const {
  return with_lock(task, [&](Call& call) {
    auto request = request_of<analysis::BenchmarkRequest>(read_, options, task, call);
    request.libraries = options.libraries;
    const analysis::Benchmark found = analysis::benchmark(request);
    Benchmark result;
    for (const bench::Row& row : found.rows)
      result.rows.push_back(
          {row.solver, row.rtol, row.step, row.error, row.seconds, row.steps, row.rhs_evaluations, row.outcome});
    for (const auto& [solver, why] : found.left_out) result.left_out.push_back({solver, why});
    result.reference_digits = found.reference.digits_at_end;
    result.advice = bench::recommend_solvers(found.rows);
    result.conclusive = found.conclusive();
    return result;
  });
}

StressTest Model::stress_test(const StressOptions& options, const Task& task) const {
  return with_lock(task, [&](Call& call) {
    auto request = request_of<analysis::StressRequest>(read_, options, task, call);
    request.steps = options.steps;
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
