// SPDX-License-Identifier: GPL-3.0-or-later
// Published problems against the values of docs/benchmark-problems.md. The values come from hand-written equations in
// quadruple precision (bench/published_equations.cpp) and from the reference solution, with exact decimals as input;
// both agree in 23 digits or more.
#include <cln/dfloat.h>
#include <cln/real.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/bench.hpp"
#include "program/interpret.hpp"
#include "reference/consistent_start.hpp"
#include "support/elliptic.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

using StateValues = std::vector<std::pair<std::string, double>>;

test::FinishedRun motion(const std::string& model, const std::string& scene, const std::string& solver, double rtol) {
  return test::run_model(model, [&](pipeline::SimulationRequest& request) {
    request.scene = scene;
    request.overrides.solver = solver;
    request.overrides.rtol = rtol;
    request.overrides.atol = rtol;
    request.estimate = false;
  });
}

/// Largest difference from the values, relative to the largest of all coordinates, of all rates.
double error(const test::FinishedRun& run, const StateValues& values) {
  double worst[2] = {0, 0}, size[2] = {0, 0};
  for (const auto& [name, value] : values) {
    const int rate = name.ends_with("_dot") ? 1 : 0;
    worst[rate] = std::max(worst[rate], std::abs(run.final(name) - value));
    size[rate] = std::max(size[rate], std::abs(value));
  }
  return std::max(worst[0] / size[0], worst[1] / size[1]);
}

test::FinishedRun check(const std::string& model, const std::string& scene, const std::string& solver,
                        const StateValues& values, double tolerance) {
  CAPTURE(model);
  CAPTURE(scene);
  CAPTURE(solver);
  test::FinishedRun run = motion(model, scene, solver, 1e-13);
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(error(run, values) < tolerance);
  return run;
}

// Problem andrews of the Test Set for IVP Solvers, t = 0.03.
const StateValues andrews{{"beta", 15.81077119515370709711939},       {"theta", -15.75637105841183946972775},
                          {"gamma", 0.04082224011964580485828232},    {"phi", -0.5347301163420795937701850},
                          {"delta", 0.5244099658799540693716558},     {"Omega", 0.5347301163420795937701850},
                          {"epsilon", 1.048080741041937873068515},    {"beta_dot", 1139.920302259106064198097},
                          {"theta_dot", -1424.379295177540073196026}, {"gamma_dot", 11.03291191061859374532731},
                          {"phi_dot", 19.29337410503204083162756},    {"delta_dot", 0.5735699148295024538176879},
                          {"Omega_dot", -19.29337410503204083162756}, {"epsilon_dot", 0.3231791492491308749907483}};
const StateValues andrews_literature{
    {"beta", 15.81077119629904},       {"theta", -15.75637105984298},      {"gamma", 0.04082224013073101},
    {"phi", -0.5347301163226948},      {"delta", 0.5244099658805304},      {"Omega", 0.5347301163226948},
    {"epsilon", 1.048080741042263},    {"beta_dot", 1139.920302151208},    {"theta_dot", -1424.379294994111},
    {"gamma_dot", 11.03291221937134},  {"phi_dot", 19.29337464421385},     {"delta_dot", 0.5735699284790808},
    {"Omega_dot", -19.29337464421385}, {"epsilon_dot", 0.3231791658026955}};
// Problem caraxis of the same set, t = 3.
const StateValues car{{"xl", 0.04934557842752409213152679},      {"yl", 0.4969894602300081067629340},
                      {"xr", 1.041742524885426115194776},        {"yr", 0.3739110272653658193578977},
                      {"xl_dot", -0.07705836840359208428394056}, {"yl_dot", 0.007446866592068416491401753},
                      {"xr_dot", 0.01755681575354173662974062},  {"yr_dot", 0.7703410437796010631206428}};
const StateValues car_literature{{"xl", 0.04934557842755629},      {"yl", 0.4969894602303324},
                                 {"xr", 1.041742524885400},        {"yr", 0.3739110272652214},
                                 {"xl_dot", -0.07705836840321485}, {"yl_dot", 0.007446866596327776},
                                 {"xr_dot", 0.01755681574942899},  {"yr_dot", 0.7703410437794031}};

// The top with position and attitude as coordinates and the joint as three equations, as the literature poses it:
// index 3.
const char* pinned = R"toml(format = 1
[parameters]
m = 15
g = 9.81
J1 = 0.234375
J2 = 0.46875
[[body]]
name = "top"
mass = "m"
inertia = { principal = ["J1", "J2", "J1"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { euler_parameters = ["e0", "e1", "e2", "e3"] }
[[force]]
gravity = "-g*E3"
[[joint]]
name = "O"
type = "ball"
bodies = ["ground", "top"]
at = ["origin", "top - top.e2"]
[scene.default]
t = [0, 2]
initial = { x = 0, y = 1, z = 0, "top.omega" = [0, 150, -4.61538] }
outputs = ["top.omega2"]
)toml";

}  // namespace

TEST_CASE(
    "published: Kepler orbits of e = 0.9 and 0.99 are back at the perihelion after a period; DETEST D5 reaches its "
    "value") {
  const StateValues back{{"x", 0.1}, {"y", 0}, {"x_dot", 0}, {"y_dot", 4.358898943540673552236982}};
  const StateValues back99{{"x", 0.01}, {"y", 0}, {"x_dot", 0}, {"y_dot", 14.10673597966588442523216}};
  const StateValues detest{{"x", -1.295266250987574},
                           {"y", 0.4003938963792321},
                           {"x_dot", -0.6775390924707566},
                           {"y_dot", -0.1270838154278686}};
  for (const char* solver :
       {"dop853", "taylor"}) {  // at the perihelion an error in time is one of velocity, large as 1/(1 - e)^2
    check("kepler_eccentric", "default", solver, back, 1e-8);
    check("kepler_eccentric", "e99", solver, back99, 5e-6);
    check("kepler_eccentric", "detest_d5", solver, detest, 1e-9);
  }
}

TEST_CASE("published: the heavy top of the Lie-group literature, in Euler parameters about O and on a ball joint") {
  const StateValues e{{"e0", 0.1229471350415334671042516},     {"e1", -0.4910798925500270146990447},
                      {"e2", 0.3504300303436209618390203},     {"e3", -0.7879868875504856693241740},
                      {"e0_dot", -28.55931683497920995348961}, {"e1_dot", 58.08053732712041817400288},
                      {"e2_dot", 7.735086293981340390856202},  {"e3_dot", -37.21237517022154494696796}};
  check("heavy_top", "default", "taylor", e, 5e-10);  // 48 turns
  const std::string path = test::build_folder() + "/heavy_top_pinned.toml";
  test::write_text(path, pinned);
  const test::FinishedRun run = check(path, "default", "dop853", e, 5e-10);
  CHECK(run.simulation.derived->mechanics.active.size() == 4);
  CHECK(run.drift("energy") < 1e-11);
  CHECK(run.final("top.omega2") == doctest::Approx(150).epsilon(1e-11));
}

TEST_CASE("published: Andrews' squeezing mechanism, where the test set's digits end after ten of the angles") {
  const test::FinishedRun run = check("andrews_squeezer", "default", "dop853", andrews, 1e-11);
  CHECK(run.simulation.derived->mechanics.degrees_of_freedom() == 1);
  CHECK(run.simulation.derived->mechanics.active.size() == 6);
  CHECK(error(run, andrews_literature) < 5e-10);
  CHECK(error(run, andrews_literature) > 5e-11);  // the values above are nearer
  const StateValues multipliers{{"reaction.pin3.1", -199.1753333731910}, {"reaction.pin3.2", 29.75531228015052},
                                {"reaction.pin4.1", -23.06654119098399}, {"reaction.pin4.2", -31.45271365475927},
                                {"reaction.pin6.1", -22.64249232082739}, {"reaction.pin6.2", -11.61740700019673}};
  for (const auto& [name, value] : multipliers)
    CHECK(run.final(name) == doctest::Approx(value).epsilon(2e-6));  // as good as the literature's
}

TEST_CASE("published: the car axis") {
  const test::FinishedRun run = check("car_axis", "default", "dop853", car, 2e-10);
  CHECK(run.simulation.derived->mechanics.active.size() == 2);
  CHECK(error(run, car_literature) < 1e-10);
  // The test set's multipliers are eps^2 times these.
  CHECK(run.final("reaction.upright") * 1e-4 == doctest::Approx(-0.004736886750784630).epsilon(2e-7).scale(0));
  CHECK(run.final("reaction.chassis") * 1e-4 == doctest::Approx(-0.001104680411345730).epsilon(2e-7).scale(0));
}

TEST_CASE(
    "published: the stiff elastic pendulum on its smooth solution: radau5 and rodas to 1e-8 in fewer than 2000 steps") {
  const StateValues k4{{"s", 7.2540613167445481505278e-4},
                       {"theta", 0.91821441020506344195360},
                       {"s_dot", -2.6839916839492663749500e-3},
                       {"theta_dot", 1.1454141217483031969358}};
  check("elastic_pendulum_smooth", "k4", "taylor", k4, 1e-11);
  const StateValues k10{{"s", 7.20996328660383e-10},
                        {"theta", 0.9207938245963407927995921},
                        {"s_dot", -2.64346480206845e-9},
                        {"theta_dot", 1.128301874649872064922251}};
  for (const char* solver : {"radau5", "rodas"}) {
    CAPTURE(std::string(solver));
    const test::FinishedRun run = motion("elastic_pendulum_smooth", "default", solver, 1e-11);
    const std::size_t steps = run.simulation.result.statistics.steps;
    CHECK(steps < 2000);
    for (const auto& [name, value] : k10) CHECK(std::abs(run.final(name) - value) < 1e-8);
    // No spring's oscillation: of s and its rate digits are right that their size, beside that of theta, hides above.
    CHECK(run.final("s") == doctest::Approx(k10[0].second).epsilon(1e-8).scale(0));
    CHECK(run.final("s_dot") == doctest::Approx(k10[2].second).epsilon(1e-3).scale(0));
    // The values for k = 1e6, 1e8, 1e10 extrapolated in 1/k.
    const test::FinishedRun stiffer = motion("elastic_pendulum_smooth", "k12", solver, 1e-11);
    CHECK(stiffer.simulation.result.statistics.steps < 2000);
    CHECK(std::abs(stiffer.final("theta") - 0.92079382713038) < 1e-9);
    CHECK(std::abs(stiffer.final("theta_dot") - 1.12830185767316) < 1e-9);
  }
}

TEST_CASE("published: bench reports explicit solvers as inefficient for the stiff pendulum only") {
  const auto row = [](const char* solver, std::size_t steps) {
    bench::Row result;
    result.solver = solver;
    result.steps = steps;
    result.rtol = result.error = result.error_along = 1e-7;
    result.seconds = 1e-3;
    result.outcome = "done";
    return result;
  };
  const std::string stiff = bench::recommend_solvers({row("dop853", 40000), row("taylor", 69000), row("radau5", 128)});
  CHECK(stiff.ends_with(
      "The motion is stiff and explicit solvers are inefficient: stability requires at least 40000 steps of them "
      "(dop853), while radau5 takes 128."));
  CHECK(bench::recommend_solvers({row("dop853", 120), row("radau5", 128)}).find("stiff") == std::string::npos);
}

TEST_CASE("published: the IFToMM pendulum follows its closed form") {
  const StateValues end{{"x", -0.2750874625761168600543914},
                        {"y", -0.96141920509912506426513507},
                        {"x_dot", 4.1755981009517288364605195},
                        {"y_dot", -1.194749054560475271647513}};
  const test::FinishedRun run = check("iftomm_pendulum", "default", "dop853", end, 1e-11);
  const test::Swing swing = test::pendulum_from_rest(std::acos(-1.0) / 2, std::sqrt(9.81), 10);  // from the other side
  CHECK(run.final("x") == doctest::Approx(-std::sin(swing.angle)).epsilon(1e-10));
  CHECK(run.final("y") == doctest::Approx(-std::cos(swing.angle)).epsilon(1e-10));
  // 2 lambda (x, y) is the force of the rod, 3 m g cos(angle) from rest at the horizontal.
  CHECK(run.final("reaction.rod") * 2 == doctest::Approx(-3 * 9.81 * std::cos(swing.angle)).epsilon(1e-10));
}

// Peaucellier's cell: six rods, whose constraints lose two ranks at once where C and D meet. The expected values follow
// from the angle and the opening of the cell as coordinates, in which the motion is regular.
TEST_CASE("a Peaucellier cell passes its dead positions at every tolerance") {
  const std::string path = (std::filesystem::temp_directory_path() / "eomgen_peaucellier_test.toml").string();
  std::string text = R"toml(format = 1
[parameters]
a = "0.5 m"
b = "0.3 m"
c = "0.15 m"
g = "9.81 m/s^2"
[coordinates]
th = "rad"
[[particle]]
name = "B"
mass = "1 kg"
position = "(c + c*cos(th))*E1 + c*sin(th)*E2"
[[particle]]
name = "C"
mass = "1 kg"
position = { cartesian = ["xc", "yc"] }
[[particle]]
name = "D"
mass = "2 kg"
position = { cartesian = ["xd", "yd"] }
[[particle]]
name = "P"
mass = "3 kg"
position = { cartesian = ["xp", "yp"] }
[[force]]
gravity = "-g*E2"
[scene.default]
t = [0, 2]
initial = { th = "20 deg" }
guess = { xc = 0.4, yc = 0.3, xd = 0.4, yd = -0.1, xp = 0.7, yp = 0.2 }
)toml";
  for (const auto& [name, psi] : {std::pair{"oc", "norm(C) - a"},
                                  {"od", "norm(D) - a"},
                                  {"bc", "norm(C - B) - b"},
                                  {"bd", "norm(D - B) - b"},
                                  {"pc", "norm(P - C) - b"},
                                  {"pd", "norm(P - D) - b"}})
    text += std::string("[[constraint]]\nname = \"") + name + "\"\nholonomic = \"" + psi + "\"\n";
  test::write_text(path, text);
  const test::FinishedRun run =
      test::run_model(path, [](pipeline::SimulationRequest& request) { request.estimate = false; });
  for (const double tolerance : {1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
    CAPTURE(tolerance);
    run::Overrides overrides;
    overrides.solver = "dop853";
    overrides.rtol = overrides.atol = tolerance;
    const run::RunResult result = pipeline::rerun(run.simulation, overrides, false);
    REQUIRE(result.outcome == eom::Outcome::done);
    // Rounding over the distance from a dead position, which the steps keep, limits all of them to some 1e-7.
    constexpr double known = 2e-6;
    for (const auto& [name, value] : result.final) {
      if (name == "th") CHECK(std::abs(value + 0.882947929) < known);
      if (name == "th_dot") CHECK(std::abs(value - 7.04969543) < 10 * known);
    }
    REQUIRE(result.events.size() == 3);
    const std::array<double, 3> times{0.37857979, 1.10562902, 1.8627886};
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(result.events[k].t - times[k]) < 1e-4);
    CHECK(result.statistics.steps < 400);
  }
}

TEST_CASE(
    "published: the N-four-bar mechanism of two windows passes the flat place, where its loops lose their rank, ten "
    "times") {
  const test::FinishedRun run = test::run_model("n_four_bar_2");  // rk4, as the scene says
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.simulation.derived->mechanics.degrees_of_freedom() == 1);
  for (const char* name : {"a0", "a1", "a2"})
    CHECK(run.final(name) == doctest::Approx(-31.750597186986101817).epsilon(1e-10));
  CHECK(run.final("a0_dot") == doctest::Approx(-1.5066421808418294699).epsilon(1e-9));
  for (const char* name : {"b1", "b2"}) CHECK(std::abs(run.final(name)) < 1e-9);  // couplers stay level
  CHECK(run.drift("energy") < 1e-10);
}

TEST_CASE(
    "published: adaptive solvers pass the singular configurations of the N-four-bar mechanism too, and report them") {
  const test::FinishedRun run = test::run_model("n_four_bar_2", [](pipeline::SimulationRequest& request) {
    request.scene = "chosen";
    request.estimate = false;
    request.with = {"jac", "taylor"};
  });
  const auto again = [&](const char* solver, double tolerance, double step = 0, double t_end = 10) {
    run::Overrides overrides;
    overrides.solver = solver;
    overrides.rtol = overrides.atol = tolerance;
    if (step > 0) overrides.step = step;
    overrides.t_end = t_end;
    return pipeline::rerun(run.simulation, overrides, false);
  };
  const auto holds = [](const run::RunResult& result, double bound) {
    CAPTURE(result.solver);
    CAPTURE(result.detail);
    CHECK(result.outcome == eom::Outcome::done);
    for (const auto& [name, value] : result.final) {
      if (name == "a0" || name == "a1" || name == "a2") CHECK(std::abs(value + 31.750597186986101817) < bound);
      if (name == "b1" || name == "b2") CHECK(std::abs(value) < bound);
    }
    for (const run::Invariant& invariant : result.invariants) CHECK(invariant.max_relative_drift < bound);
    CHECK(result.constraint_drift < 1e-11);
  };
  for (const char* solver : {"dop853", "dopri5", "tsit5", "radau5", "radau", "rodas", "taylor", "auto"}) {
    const run::RunResult result = again(solver, 1e-9);
    holds(result, 1e-4);  // of errors of 3e-6 and less
    CHECK(!result.events.empty());
    for (const run::RunEvent& event : result.events) {
      CHECK(event.kind == "singular_configuration");
      CHECK(event.name.starts_with("window"));
    }
  }
  for (const char* solver : {"dop853", "tsit5", "taylor"}) holds(again(solver, 1e-12), 1e-6);
  // With fixed steps: a series ends at its smallest terms; iterations do not wait for digits of coordinates that stay
  // 0.
  const run::RunResult series = again("taylor", 1e-9, 1e-3);
  holds(series, 1e-4);
  CHECK(series.events.empty());
  for (const char* solver : {"midpoint", "radau5", "radau"}) {
    const run::RunResult before = again(solver, 1e-9, 1e-3, 0.6);
    CAPTURE(before.solver);
    CHECK(before.outcome == eom::Outcome::done);
    for (const run::Invariant& invariant : before.invariants) CHECK(invariant.max_relative_drift < 1e-6);
  }
}

TEST_CASE("published: the reference solution starts at a state that satisfies the constraints to all digits") {
  pipeline::SimulationRequest request;
  request.model = test::model_at(test::model_path("andrews_squeezer"));
  request.overrides.solver = "dop853";
  request.integrate = false;
  const pipeline::Simulation simulation = pipeline::simulate(request);
  const auto& functions = simulation.program.functions;
  const auto constraints = std::find_if(functions.begin(), functions.end(),
                                        [](const program::Function& f) { return f.name == "constraints"; });
  REQUIRE(constraints != functions.end());
  constexpr int digits = 40;
  std::vector<cln::cl_F> x;
  for (const auto& part : {simulation.scene.q, simulation.scene.qdot})
    for (const double value : part) x.push_back(cln::cl_float(cln::cl_DF(value), cln::float_format(digits)));
  const cln::cl_F t = cln::cl_float(0, cln::float_format(digits));
  const auto off = [&](const std::vector<cln::cl_F>& at) {
    program::Arguments<cln::cl_R> arguments;
    arguments.t = t;
    arguments.x.assign(at.begin(), at.end());
    for (const double p : simulation.scene.parameters) arguments.p.emplace_back(cln::cl_DF(p));
    double largest = 0;
    const auto results = program::interpret(*constraints, arguments, digits).results;
    for (const cln::cl_R& psi : results[0]) largest = std::max(largest, std::abs(cln::double_approx(psi)));
    return largest;
  };
  const std::vector<cln::cl_F> moved =
      reference::make_consistent(*constraints, 7, t, x, simulation.scene.parameters, digits);
  CHECK(off(x) > 1e-20);  // rounded
  CHECK(off(moved) < 1e-38);
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(std::abs(cln::double_approx(moved[i] - x[i])) < 1e-14);
}
