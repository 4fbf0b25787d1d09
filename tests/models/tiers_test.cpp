// SPDX-License-Identifier: GPL-3.0-or-later
// Results do not depend on how the functions of a model became callable.
#include <doctest/doctest.h>

#include <bit>
#include <filesystem>

#include "error.hpp"
#include "jit/machine_code.hpp"
#include "support/environment.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

void check_same(const std::vector<std::pair<std::string, double>>& a,
                const std::vector<std::pair<std::string, double>>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CAPTURE(a[i].first);
    CAPTURE(a[i].second);
    CAPTURE(b[i].second);
    CHECK(same_bits(a[i].second, b[i].second));
  }
}

void check_same(const run::RunResult& a, const run::RunResult& b) {
  CHECK(a.outcome == b.outcome);
  CHECK(a.solver == b.solver);
  CHECK(same_bits(a.t, b.t));
  CHECK(a.statistics.steps == b.statistics.steps);
  CHECK(a.statistics.rejected == b.statistics.rejected);
  CHECK(a.statistics.rhs_evaluations == b.statistics.rhs_evaluations);
  CHECK(same_bits(a.power_balance, b.power_balance));
  CHECK(same_bits(a.constraint_drift, b.constraint_drift));
  REQUIRE(a.events.size() == b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) CHECK(same_bits(a.events[i].t, b.events[i].t));
  check_same(a.final, b.final);
  check_same(a.error_estimate, b.error_estimate);
}

/// Runs a model in both tiers and compares every row.
pipeline::Simulation compare_runs(const std::string& name,
                                  const std::function<void(pipeline::SimulationRequest&)>& adjust) {
  CAPTURE(name);
  const auto run_in = [&](pipeline::Tier tier) {
    return run_model(name, [&](pipeline::SimulationRequest& request) {
      request.tier = tier;
      adjust(request);
    });
  };
  FinishedRun direct = run_in(pipeline::Tier::jit);
  const FinishedRun compiled = run_in(pipeline::Tier::compiled);
  CHECK(direct.simulation.code.tier() == pipeline::Tier::jit);
  CHECK(compiled.simulation.code.tier() == pipeline::Tier::compiled);
  REQUIRE(direct.rows.size() == compiled.rows.size());
  CHECK(direct.rows.names == compiled.rows.names);
  for (std::size_t i = 0; i < direct.rows.size(); ++i) {
    CAPTURE(i);
    REQUIRE(same_bits(direct.rows.t[i], compiled.rows.t[i]));
    for (std::size_t k = 0; k < direct.rows.y[i].size(); ++k)
      REQUIRE(same_bits(direct.rows.y[i][k], compiled.rows.y[i][k]));
  }
  check_same(direct.simulation.result, compiled.simulation.result);
  return std::move(direct.simulation);
}

}  // namespace

TEST_CASE("every shipped model: compiled code and machine code in memory give the same bits") {
  if (!jit::refusal().empty()) return;
  std::size_t moving = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/models")) {
    if (entry.path().extension() != ".toml") continue;
    CAPTURE(entry.path().string());
    pipeline::SimulationRequest request;
    request.model = model_at(entry.path().string());
    request.tier = pipeline::Tier::compiled;
    request.integrate = false;
    request.charts = false;
    std::optional<pipeline::Simulation> simulation;
    try {
      simulation.emplace(pipeline::simulate(request));
    } catch (const Error& error) {
      // Models whose motion is prescribed have no equations to run.
      CHECK(std::string(error.what()).find("the constraints fix every coordinate") != std::string::npos);
      continue;
    }
    ++moving;
    run::Overrides overrides;
    overrides.t_end = simulation->scene.t0 + (simulation->scene.t1 - simulation->scene.t0) / 8;
    const run::RunResult compiled = pipeline::rerun(*simulation, overrides, false);
    const run::Scene defaults =
        run::resolve_scene(simulation->derived->mechanics, simulation->derived->candidates.front(),
                           simulation->derived->model.scene("default"), {});
    simulation->code = pipeline::assemble(simulation->program,
                                          pipeline::code_context(*simulation->derived, simulation->program, defaults));
    check_same(compiled, pipeline::rerun(*simulation, overrides, false));
  }
  CHECK(moving > 80);
}

TEST_CASE("solvers with Jacobians, series and momenta, and second charts: the same rows in both tiers") {
  if (!jit::refusal().empty()) return;
  const auto with_solver = [](const char* solver, double step = 0) {
    return [solver, step](pipeline::SimulationRequest& request) {
      request.overrides.solver = solver;
      if (step > 0) request.overrides.step = step;
      request.overrides.t_end = 0.5;
      request.rows = 20;
    };
  };
  compare_runs("S6_chain_2", with_solver("radau5"));
  compare_runs("S6_chain_2", with_solver("taylor"));
  compare_runs("S5_double_pendulum_cartesian", with_solver("ggl"));
  compare_runs("S5_double_pendulum_cartesian", with_solver("variational4", 0.01));
  compare_runs("cart_pendulum", with_solver("rk4", 0.01));
  const pipeline::Simulation charts = compare_runs("R1_free_body", [](pipeline::SimulationRequest& request) {
    request.overrides.t_end = 4;
    request.rows = 50;
  });
  REQUIRE(charts.charts != nullptr);
}

TEST_CASE("auto takes machine code, and the compiler only where many fixed steps pay for it") {
  program::Program program;
  program.functions.emplace_back();
  program.functions[0].code.resize(100);
  const auto choose = [&](double steps) {
    return pipeline::choose_tier(pipeline::Tier::automatic, program, steps).tier;
  };
  if (!jit::refusal().empty()) {
    CHECK(choose(0) == pipeline::Tier::compiled);
    return;
  }
  CHECK(choose(0) == pipeline::Tier::jit);
  CHECK(choose(1e6) == pipeline::Tier::jit);
  CHECK(choose(1e8) == pipeline::Tier::compiled);
  {
    const ScopedEnvironmentVariable none("EOMGEN_CC", "/no/compiler");
    const pipeline::TierChoice choice = pipeline::choose_tier(pipeline::Tier::automatic, program, 1e8);
    CHECK(choice.tier == pipeline::Tier::jit);
    CHECK(choice.reason.find("the C compiler `/no/compiler` does not run") != std::string::npos);
  }
  program.functions.emplace_back();  // a long function that is compiled along
  program.functions[1].code.resize(100000);
  CHECK(choose(1e8) == pipeline::Tier::jit);
  CHECK(pipeline::choose_tier(pipeline::Tier::compiled, program, 0).tier == pipeline::Tier::compiled);
}
