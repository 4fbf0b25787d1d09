// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/prepared_runs.hpp"

#include <algorithm>
#include <tuple>

namespace eomgen {
namespace {

bool are_equal(const run::Overrides& a, const run::Overrides& b) {
  const auto values = [](const run::Overrides& o) {
    return std::tie(o.t_end, o.rtol, o.atol, o.step, o.max_step, o.every, o.solver, o.outputs, o.allow_empty_span,
                    o.can_exchange_charts);
  };
  return values(a) == values(b) && a.values == b.values;
}

bool are_equal(const program::Request& a, const program::Request& b) {
  const auto values = [](const program::Request& r) { return std::tie(r.with, r.outputs, r.parameters, r.optimise); };
  return values(a) == values(b) && a.fix == b.fix;
}

/// Moves the entry that satisfies `wanted` to the front. False: there is none.
template <class Entry, class Wanted>
bool find_first(std::list<Entry>& entries, Wanted&& wanted) {
  const auto found = std::find_if(entries.begin(), entries.end(), wanted);
  if (found == entries.end()) return false;
  entries.splice(entries.begin(), entries, found);
  return true;
}

template <class Entry>
void put_first(std::list<Entry>& entries, Entry entry, std::size_t most) {
  entries.push_front(std::move(entry));
  if (entries.size() > most) entries.pop_back();
}

}  // namespace

std::shared_ptr<pipeline::BoundRun> PreparedRun::bind(run::Scene scene, bool estimate) const {
  std::shared_ptr<pipeline::BoundRun> run(new pipeline::BoundRun(*derived, *compilation, std::move(scene), estimate),
                                          LockedDelete{});
  run::RunRequest& request = run->request();
  request.holds_beyond_range = [holds = std::move(request.holds_beyond_range)](std::uint32_t coordinate, double t,
                                                                               std::span<const double> x) {
    const std::scoped_lock lock(library_mutex());
    return holds(coordinate, t, x);
  };
  if (request.code_for_charts) {
    request.code_for_charts = [code = std::move(request.code_for_charts)](unsigned charts) -> const run::Code& {
      const std::scoped_lock lock(library_mutex());
      return code(charts);
    };
  }
  return run;
}

PreparedRun PreparedRuns::prepare(pipeline::SimulationRequest request, bool with_constraints) {
  Derivation& derivation = derive(request);
  if (with_constraints) {
    if (!derivation.derived->candidates.front().active.empty()) request.with.push_back("constraints");
    if (!derivation.derived->mechanics.constraints.empty()) request.with.push_back("reactions");
  }
  PreparedRun run{derivation.derived, nullptr, plan(derivation, request)};
  run.compilation = compile(derivation, *run.plan, request);
  return run;
}

PreparedRuns::Derivation& PreparedRuns::derive(const pipeline::SimulationRequest& request) {
  const auto wanted = [&](const Derivation& d) { return d.approach == request.approach && d.form == request.form; };
  if (!find_first(derivations_, wanted)) {
    std::shared_ptr<pipeline::DerivedModel> derived(
        pipeline::derive_model(model_, request.approach, request.form).release(), LockedDelete{});
    put_first(derivations_, Derivation{request.approach, request.form, std::move(derived)}, most_derivations);
    // Entries of an older derivation cannot be found any more.
    const auto is_old = [this](const auto& entry) {
      return std::none_of(derivations_.begin(), derivations_.end(),
                          [&](const Derivation& d) { return d.derived.get() == entry.of; });
    };
    std::erase_if(compilations_, is_old);
    std::erase_if(plans_, is_old);
  }
  return derivations_.front();
}

std::shared_ptr<const pipeline::RunPlan> PreparedRuns::plan(Derivation& derivation,
                                                            const pipeline::SimulationRequest& request) {
  pipeline::DerivedModel& derived = *derivation.derived;
  const auto wanted = [&](const Plan& p) {
    return p.of == &derived && p.scene == request.scene && p.charts == request.charts && p.with == request.with &&
           are_equal(p.overrides, request.overrides);
  };
  if (!find_first(plans_, wanted)) {
    trim_graph(derivation);
    std::shared_ptr<const pipeline::RunPlan> made(new pipeline::RunPlan(pipeline::plan_run(derived, request)),
                                                  LockedDelete{});
    put_first(plans_, Plan{&derived, request.scene, request.overrides, request.charts, request.with, std::move(made)},
              most_plans);
  }
  return plans_.front().plan;
}

/// Every scene adds its numbers to the graph. Nodes that compiled code refers to are kept.
void PreparedRuns::trim_graph(Derivation& derivation) {
  bool compiled = false, charts = false;
  for (const Compiled& c : compilations_) {
    if (c.of != derivation.derived.get()) continue;
    compiled = true;
    charts = charts || c.compilation->charts != nullptr;
  }
  if (!compiled) return;
  if (!derivation.graph) derivation.graph.emplace(*derivation.derived->mechanics.dag, charts);
  derivation.graph->trim();
}

run::Scene PreparedRuns::scene(const PreparedRun& run, const run::Overrides& replaced) {
  for (Derivation& derivation : derivations_) {
    if (derivation.derived == run.derived) trim_graph(derivation);
  }
  run::Overrides overrides = run.plan->overrides;
  for (const auto& [name, value] : replaced.values) overrides.values[name] = value;
  const auto take = [](const auto& from, auto& to) {
    if (from) to = from;
  };
  take(replaced.rtol, overrides.rtol);
  take(replaced.atol, overrides.atol);
  take(replaced.step, overrides.step);
  take(replaced.max_step, overrides.max_step);
  take(replaced.solver, overrides.solver);
  pipeline::DerivedModel& derived = *run.derived;
  return run::resolve_scene(derived.mechanics, derived.candidates.front(), derived.model.scene(run.plan->scene.name),
                            overrides, derived.scene_tables);
}

std::shared_ptr<const pipeline::Compilation> PreparedRuns::compile(Derivation& derivation,
                                                                   const pipeline::RunPlan& plan,
                                                                   const pipeline::SimulationRequest& request) {
  pipeline::DerivedModel& derived = *derivation.derived;
  const auto wanted = [&](const Compiled& c) {
    return c.of == &derived && c.exchanges_charts == plan.exchanges_charts && c.seed == request.seed &&
           are_equal(c.functions, plan.functions) &&
           pipeline::choose_tier(request.tier, c.compilation->program, pipeline::fixed_steps(plan.scene)).tier ==
               c.compilation->tier.tier;
  };
  if (!find_first(compilations_, wanted)) {
    std::shared_ptr<const pipeline::Compilation> made(
        new pipeline::Compilation(pipeline::compile_run(derived, plan, request)), LockedDelete{});
    put_first(compilations_, Compiled{&derived, plan.functions, plan.exchanges_charts, request.seed, std::move(made)},
              most_compilations);
    derivation.graph.reset();
  }
  return compilations_.front().compilation;
}

}  // namespace eomgen
