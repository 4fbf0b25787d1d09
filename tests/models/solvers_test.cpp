// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit solvers on shipped models of every kind: constraints that are projected, inputs that vary, integrals, kinks.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "error.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

test::FinishedRun motion_until(const std::string& model, const std::string& solver, double t_end) {
  return test::run_model(model, [&](pipeline::SimulationRequest& request) {
    request.overrides.solver = solver;
    request.overrides.rtol = 1e-10;
    request.overrides.atol = 1e-12;
    request.overrides.t_end = t_end;
  });
}

/// Largest difference of the states at the end.
double distance(const test::FinishedRun& a, const test::FinishedRun& b) {
  double largest = 0;
  for (const model::Coordinate& c : a.simulation.derived->model.coordinates)
    for (const std::string& name : {c.name, c.name + "_dot"})
      largest = std::max(largest, std::abs(a.final(name) - b.final(name)));
  return largest;
}

}  // namespace

TEST_CASE("solvers: the implicit ones end where dop853 does, with df/dx from the equations") {
  for (const char* model : {"P2_planar_pendulum", "S5_double_pendulum_cartesian", "P3_moving_plane_gust",
                            "bilinear_oscillator", "cart_pendulum", "knife_edge", "P7_moving_sphere_pfaffian"}) {
    const std::string of_model = model;
    CAPTURE(of_model);
    const test::FinishedRun reference = motion_until(model, "dop853", 1.5);
    for (const char* solver : {"radau5", "rodas"}) {
      CAPTURE(std::string(solver));
      const test::FinishedRun other = motion_until(model, solver, 1.5);
      const run::RunResult& result = other.simulation.result;
      CHECK(result.outcome == eom::Outcome::done);
      CHECK(distance(other, reference) < 1e-6);
      CHECK(result.statistics.jacobians > 0);
      CHECK(result.statistics.difference_evaluations == 0);  // inputs, where there are any, stand still
    }
  }
}

TEST_CASE("solvers: an implicit one on code that was compiled without df/dx takes differences, and says so") {
  const test::FinishedRun first = motion_until("cart_pendulum", "dop853", 1.5);
  run::Overrides overrides;
  overrides.solver = "radau5";
  overrides.rtol = 1e-10;
  overrides.t_end = 1.5;
  const run::RunResult again = pipeline::rerun(first.simulation, overrides, false);
  CHECK(again.outcome == eom::Outcome::done);
  CHECK(run::to_text(again.reason) == "as asked for, df/dx by differences, since it was not compiled");
  CHECK(again.statistics.difference_evaluations > 0);
  CHECK(std::abs(test::value_of(again.final, "theta") - first.final("theta")) < 1e-6);
}

TEST_CASE("solvers: auto hands a stiff spring to radau and says when, why, and where df/dx is from") {
  const auto stiff = [](double rtol) {
    return test::run_model("elastic_pendulum", [&](pipeline::SimulationRequest& request) {
      request.scene = "stiff";
      request.overrides.solver = "auto";
      request.overrides.rtol = request.overrides.atol = rtol;
      request.estimate = true;
    });
  };
  for (const double rtol : {1e-5, 1e-8}) {
    const test::FinishedRun found = stiff(rtol);
    const run::RunResult& result = found.simulation.result;
    CHECK(result.outcome == eom::Outcome::done);
    CHECK(result.solver == "radau");
    const std::vector<eom::MethodChange>& changes = result.reason.changes;
    REQUIRE(!changes.empty());
    CHECK(changes.back().to == std::string_view("radau"));
    CHECK(changes.back().why == eom::ChangeReason::beyond_stability);
    CHECK(result.reason.jacobian_after_change == run::SolverReason::JacobianSource::differences);
    CHECK(run::to_text(result.reason)
              .ends_with("df/dx by differences, since it was not compiled (solver radau5 has it compiled)"));
    CHECK(result.statistics.steps < 4000);  // dop853: 40000 and more
    CHECK(test::value_of(result.error_estimate, "theta") < 1e3 * rtol);
  }
}

TEST_CASE(
    "solvers: variational ones converge to dop853 with their order: free, with multipliers, moving constraints, "
    "damping, inputs") {
  for (const char* model : {"P2_planar_pendulum", "S5_double_pendulum_cartesian", "P3_moving_plane", "cart_pendulum"}) {
    const test::FinishedRun reference = test::run_model(model, [&](pipeline::SimulationRequest& request) {
      request.overrides.solver = "dop853";
      request.overrides.rtol = request.overrides.atol = 1e-13;
      request.overrides.t_end = 1;
    });
    for (const char* solver : {"variational2", "variational4", "variational6"}) {
      const std::string of_model = model;
      CAPTURE(of_model);
      CAPTURE(std::string(solver));
      const int order = run::get_method(solver).order;
      const auto error = [&](double step) {
        const test::FinishedRun found = test::run_model(model, [&](pipeline::SimulationRequest& request) {
          request.overrides.solver = solver;
          request.overrides.step = step;
          request.overrides.t_end = 1;
        });
        const run::RunResult& result = found.simulation.result;
        CHECK(result.outcome == eom::Outcome::done);
        CHECK(result.reason.uses_momenta);
        CHECK(result.constraint_drift < 1e-11);
        return distance(found, reference);
      };
      const double coarse = error(order == 6 ? 0.025 : 0.01), fine = error(order == 6 ? 0.0125 : 0.005);
      CHECK(fine < 1e-3);
      CHECK((fine < 1e-11 || std::log2(coarse / fine) > order - 0.5));  // below, dop853 is no better
    }
  }
}

TEST_CASE("solvers: variational ones keep energy within bounds, and tell why they refuse a model") {
  const auto drift = [](double end) {
    return test::run_model("S5_double_pendulum_cartesian",
                           [&](pipeline::SimulationRequest& request) {
                             request.overrides.solver = "variational4";
                             request.overrides.step = 0.02;
                             request.overrides.t_end = end;
                           })
        .simulation.result.invariants.front();
  };
  const run::Invariant brief = drift(10), lasting = drift(200);
  CHECK(brief.name == "energy");
  CHECK(lasting.max_relative_drift < 3 * brief.max_relative_drift);
  CHECK(brief.max_relative_drift < 1e-3);
  const std::pair<const char*, const char*> refused[] = {
      {"knife_edge", "constraint on velocities"}, {"bouncing_ball", "contacts"}, {"bilinear_oscillator", "kinks"}};
  for (const auto& [model, why] : refused) {
    const std::string of_model = model;
    CAPTURE(of_model);
    try {
      test::run_model(model, [&](pipeline::SimulationRequest& request) {
        request.overrides.solver = "variational2";
        request.overrides.step = 0.01;
      });
      FAIL("not refused");
    } catch (const Error& error) {
      CHECK(std::string(error.what()).find(why) != std::string::npos);
    }
  }
}

TEST_CASE(
    "solvers: long runs of variational ones: angles that have gone far do not end the iteration, rounding does not add "
    "up in the momentum") {
  const auto run = [](const char* model, const char* solver, double step, double end) {
    return test::run_model(model, [&](pipeline::SimulationRequest& request) {
      request.overrides.solver = solver;
      request.overrides.step = step;
      request.overrides.t_end = end;
      if (model == std::string("kepler_eccentric")) request.overrides.values["e"] = symbolic::Rational(1) / 2;
      request.estimate = false;
    });
  };
  const test::FinishedRun far = run("P1_spherical_pendulum", "variational2", 0.021838206, 1600);  // theta = 5800 rad
  CHECK(far.simulation.result.outcome == eom::Outcome::done);
  CHECK(far.drift("energy") < 1e-3);
  CHECK(far.drift("momentum.theta") < 1e-13);
  for (const char* solver : {"midpoint", "variational2"}) {
    const test::FinishedRun orbits = run("kepler_eccentric", solver, 0.0314159265, 6283);
    CHECK(orbits.simulation.result.outcome == eom::Outcome::done);
    CHECK(orbits.drift("angular_momentum.E3") <
          1e-13);  // 1e-14; corrections of Newton's iteration left out at a quarter of an ulp: 1e-12
  }
}

TEST_CASE("solvers: taylor ends where dop853 does, through constraints, tables, kinks, friction, impacts and rolling") {
  for (const char* model : {"P2_planar_pendulum", "S5_double_pendulum_cartesian", "P3_moving_plane_gust",
                            "bilinear_oscillator", "cart_pendulum", "knife_edge", "P7_moving_sphere_pfaffian",
                            "R6_rolling_disk", "stick_slip_belt", "bouncing_ball", "P5_rough_sphere"}) {
    const std::string of_model = model;
    CAPTURE(of_model);
    const test::FinishedRun reference = motion_until(model, "dop853", 1.5), other = motion_until(model, "taylor", 1.5);
    const run::RunResult& result = other.simulation.result;
    CHECK(result.outcome == reference.simulation.result.outcome);
    CHECK(run::to_text(result.reason) == "as asked for, series from the equations");
    CHECK(distance(other, reference) < 1e-6);
    CHECK(result.events.size() == reference.simulation.result.events.size());
    CHECK(result.power_balance < 1e-6);
  }
}

TEST_CASE(
    "solvers: taylor takes inputs that jump, refuses those that are expressions of t, and code without a series") {
  const std::string folder = test::build_folder(), text = test::read_text(test::model_path("cart_pendulum"));
  test::write_text(folder + "/cart_table.toml", text + "inputs = { F = { t = [0, 0.7], value = [5, -3] } }\n");
  test::write_text(folder + "/cart_pushed.toml", text + "inputs = { F = \"3*sin(2*t)\" }\n");
  const std::string table = folder + "/cart_table.toml", pushed = folder + "/cart_pushed.toml";
  CHECK(distance(motion_until(table, "taylor", 1.5), motion_until(table, "dop853", 1.5)) < 1e-8);
  CHECK_THROWS_WITH_AS(motion_until(pushed, "taylor", 1.5), doctest::Contains("varies continuously with t"), Error);
  const test::FinishedRun first = motion_until("cart_pendulum", "dop853", 0.5);
  run::Overrides overrides;
  overrides.solver = "taylor";
  CHECK_THROWS_WITH_AS(pipeline::rerun(first.simulation, overrides, false),
                       doctest::Contains("compiled without its Taylor series"), Error);
}

TEST_CASE(
    "solvers: ggl ends where dop853 with projection does, constraints at rounding and nothing projected; it "
    "reports why it refuses a model") {
  // among them a loop of bodies, constraints on velocities, and one that moves
  for (const char* model : {"S5_double_pendulum_cartesian", "iftomm_pendulum", "four_bar_spatial_pins", "knife_edge",
                            "P7_moving_sphere_pfaffian", "car_axis"}) {
    const std::string of_model = model;
    CAPTURE(of_model);
    const test::FinishedRun reference = motion_until(model, "dop853", 1);
    run::Overrides overrides;
    overrides.solver = "ggl";
    overrides.rtol = 1e-10;
    overrides.atol = 1e-12;
    overrides.t_end = 1;
    const run::RunResult found = pipeline::rerun(reference.simulation, overrides, false);
    CHECK(found.outcome == eom::Outcome::done);
    CHECK(found.reason.keeps_constraints);
    CHECK(found.projection_position == 0);
    CHECK(found.projection_velocity == 0);
    CHECK(found.constraint_drift < 1e-13);
    for (const auto& [name, value] : found.final) {
      const auto& shown = name;
      CAPTURE(shown);
      if (name.ends_with("_dot")) CHECK(std::abs(value - reference.final(name)) < 1e-7);
    }
  }
  const std::pair<const char*, const char*> refused[] = {{"S5_double_pendulum", "no constraints with multipliers"},
                                                         {"bouncing_ball", "contacts"}};
  for (const auto& [model, why] : refused) {
    const std::string of_model = model;
    CAPTURE(of_model);
    try {
      motion_until(model, "ggl", 1);
      FAIL("it is to be refused");
    } catch (const Error& error) {
      CHECK(std::string(error.what()).find(why) != std::string::npos);
      CHECK(std::string(error.what()).find("take radau5") != std::string::npos);
    }
  }
}

TEST_CASE("solvers: fixed implicit steps where components stay at rounding level, or start at 0") {
  for (const auto& [model, t_end] : {std::pair{"n_four_bar_2", 0.5}, std::pair{"iftomm_pendulum", 2.0}}) {
    const test::FinishedRun reference = motion_until(model, "dop853", t_end);
    for (const char* solver : {"midpoint", "radau5", "radau", "ggl"}) {
      const std::string of_model = model;
      CAPTURE(of_model);
      CAPTURE(std::string(solver));
      run::Overrides overrides;
      overrides.solver = solver;
      overrides.step = 1e-3;
      overrides.t_end = t_end;
      const run::RunResult found = pipeline::rerun(reference.simulation, overrides, false);
      CHECK(found.outcome == eom::Outcome::done);
      for (const auto& [name, value] : found.final) {
        const auto& shown = name;
        CAPTURE(shown);
        if (name.ends_with("_dot"))
          CHECK(std::abs(value - reference.final(name)) < (std::string(solver) == "midpoint" ? 1e-3 : 1e-8));
      }
    }
  }
}
