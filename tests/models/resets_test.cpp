// SPDX-License-Identifier: GPL-3.0-or-later
// Models whose events and samples change the state, against closed forms, published values and equations by hand.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "tight_run.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

/// A model of two free coordinates x, y of a particle of 1 kg, and `more`.
test::FinishedRun run_text(const std::string& more, double rtol = tight) {
  const std::string path = (std::filesystem::temp_directory_path() / "eomgen_resets_test.toml").string();
  test::write_text(
      path,
      "format = 1\n[coordinates]\nx = {}\ny = {}\n[[particle]]\nname = \"A\"\nmass = 1\nposition = \"x*E1 + y*E2\"\n" +
          more);
  return test::run_model(
      path, [&](pipeline::SimulationRequest& request) { request.overrides.rtol = request.overrides.atol = rtol; });
}

std::vector<double> times_of(const test::FinishedRun& run, const std::string& name) {
  std::vector<double> times;
  for (const run::RunEvent& event : run.simulation.result.events) {
    if (event.name == name) times.push_back(event.t);
  }
  return times;
}

}  // namespace

// T' = (rise heater - T)/tau between the switches.
TEST_CASE("thermostat: the heater switches at the times of the exponentials between the two temperatures") {
  const test::FinishedRun run = run_tight("thermostat");
  check_sound(run);
  const auto p = [&run](const char* name) { return run.parameter(name); };
  const double low = p("T0") - p("band"), high = p("T0") + p("band"), rise = p("rise");
  const double heats = p("tau") * std::log((rise - low) / (rise - high)), cools = p("tau") * std::log(high / low);
  const std::vector<double> warm = times_of(run, "too_warm"), cold = times_of(run, "too_cold");
  REQUIRE(warm.size() > 10);
  CHECK(warm[0] == doctest::Approx(p("tau") * std::log((rise - 15) / (rise - high))).epsilon(followed));
  for (std::size_t k = 0; k + 1 < warm.size(); ++k) {
    CHECK(cold[k] - warm[k] == doctest::Approx(cools).epsilon(followed));
    CHECK(warm[k + 1] - cold[k] == doctest::Approx(heats).epsilon(followed));
  }
  CHECK(run.final("switches") == static_cast<double>(warm.size() + cold.size()));
}

// Between two ticks the wheel is a damped oscillator, and loses the part 1 - exp(-2 d) of phi_dot^2.
TEST_CASE("clock_escapement: ticks come at half periods, and the rate after a tick is that of the gait") {
  const test::FinishedRun run = run_tight("clock_escapement");
  check_sound(run);
  const auto p = [&run](const char* name) { return run.parameter(name); };
  const double J = p("J"), decay = p("c") / (2 * J), half = std::numbers::pi / std::sqrt(p("k") / J - decay * decay);
  const std::vector<double> ticks = times_of(run, "tick");
  REQUIRE(ticks.size() == 160);
  CHECK(run.final("teeth") == 160);
  CHECK((ticks.back() - ticks.front()) / 159 == doctest::Approx(half).epsilon(followed));
  // A pair of rows shows the state before and after each tick: the rate grows by what E gives.
  const double loss = std::exp(-2 * decay * half);
  double square = 0;
  std::size_t pairs = 0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    if (run.rows.t[i] != run.rows.t[i - 1]) continue;
    const double before = run.rows.at(i - 1, "phi_dot"), after = run.rows.at(i, "phi_dot");
    CHECK(after * after - before * before == doctest::Approx(2 * p("E") / J).epsilon(followed));
    if (pairs++ > 0) CHECK(before * before == doctest::Approx(square * loss).epsilon(followed));
    square = after * after;
  }
  CHECK(pairs == ticks.size());
  // The energy of all ticks is the impulse work.
  CHECK(run.simulation.result.contact_work == doctest::Approx(160 * p("E")).epsilon(followed));
}

TEST_CASE("rimless_wheel: after some steps it rolls at the rate of the closed form") {
  const test::FinishedRun run =
      run_tight("rimless_wheel", [](pipeline::SimulationRequest& request) { request.overrides.t_end = 40; });
  check_sound(run);
  const auto p = [&run](const char* name) { return run.parameter(name); };
  const double a = p("alpha"),
               rate = std::sqrt(4 * p("g") / p("L") * std::sin(a) * std::sin(p("gamma"))) / std::tan(2 * a);
  double last = 0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    if (run.rows.t[i] == run.rows.t[i - 1]) last = run.rows.at(i, "theta_dot");
  }
  CHECK(last == doctest::Approx(rate).epsilon(followed));
  CHECK(run.final("distance") == doctest::Approx(run.final("steps") * 2 * p("L") * std::sin(a)).epsilon(1e-13));
}

TEST_CASE("simplest_walker: the gait of period one is the published one") {
  const test::FinishedRun run = run_tight("simplest_walker");
  check_sound(run);
  constexpr double published = 1e-7;  // the start has ten digits, and the feet have a mass
  const std::vector<double> strikes = times_of(run, "heel_strike");
  REQUIRE(strikes.size() == 5);
  CHECK(strikes[0] == doctest::Approx(3.8824637528).epsilon(1e-9));
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    if (run.rows.t[i] != run.rows.t[i - 1]) continue;
    CHECK(run.rows.at(i, "theta") == doctest::Approx(0.2003109005).epsilon(published));
  }
}

// The same controller and the same equations by hand, with steps of 0.1 ms of the method of order 4.
TEST_CASE("sampled_cart_pole: the force is held between samples, as in a program by hand") {
  const test::FinishedRun run = run_tight("sampled_cart_pole", [](pipeline::SimulationRequest& request) {
    request.overrides.values["sigma"] = 0;
    request.overrides.t_end = 2;
  });
  check_sound(run);
  const auto p = [&run](const char* name) { return run.parameter(name); };
  const double M = p("M"), m = p("m"), L = p("L"), g = p("g"), Ts = p("Ts");
  double u = 0, reading = 0.1, place = 0;
  std::array<double, 4> x{0, 0.1, 0, 0};  // x, theta and their rates
  const auto slope = [&](const std::array<double, 4>& s) {
    const double c = std::cos(s[1]), d = std::sin(s[1]);
    // (M + m) x'' + m L c theta'' = u + m L d theta'^2;  c x'' + L theta'' = g d
    const double right = u + m * L * d * s[3] * s[3];
    const double a = (right - m * c * g * d) / (M + m - m * c * c);
    return std::array<double, 4>{s[2], s[3], a, (g * d - c * a) / L};
  };
  constexpr int parts = 100;
  for (int k = 0; k < 200; ++k) {
    u = p("kp") * x[1] + p("kd") * (x[1] - reading) / Ts + p("kx") * x[0] + p("kv") * (x[0] - place) / Ts;
    reading = x[1];
    place = x[0];
    const double h = Ts / parts;
    for (int i = 0; i < parts; ++i) {
      const auto moved = [&](const std::array<double, 4>& by, double part) {
        std::array<double, 4> s = x;
        for (std::size_t j = 0; j < 4; ++j) s[j] += part * h * by[j];
        return s;
      };
      const auto k1 = slope(x), k2 = slope(moved(k1, 0.5)), k3 = slope(moved(k2, 0.5)), k4 = slope(moved(k3, 1));
      for (std::size_t j = 0; j < 4; ++j) x[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
    }
  }
  CHECK(run.final("x") == doctest::Approx(x[0]).epsilon(followed).scale(1));
  CHECK(run.final("theta") == doctest::Approx(x[1]).epsilon(followed).scale(1));
  CHECK(run.final("u") == doctest::Approx(u).epsilon(followed).scale(1));
}

TEST_CASE("noise: the numbers of a seed have mean 0 and deviation 1, and are the same in every run") {
  const std::string noise =
      "[discrete]\nw = 0\nv = 0\nsum = 0\nsquares = 0\n[[sample]]\nevery = 0.001\nnoise = { w = { normal = 3 }, v = { "
      "uniform = 3 } }\nset = { sum = \"sum + w\", squares = \"squares + w^2 + 3*v^2\" }\n[scene.default]\nt = [0, 4]\n"
      "initial = { x = 0, y = 0 }\n";
  const test::FinishedRun one = run_text(noise), two = run_text(noise, 1e-6);
  // 4000 samples: within 4 deviations of the mean and of the mean square.
  CHECK(std::abs(one.final("sum")) < 4 * std::sqrt(4000.0));
  CHECK(std::abs(one.final("squares") - 8000) < 4 * std::sqrt(4000.0 * (2 + 0.8)));
  CHECK(one.final("sum") == two.final("sum"));
  CHECK(std::abs(one.final("v")) < 1);
}

TEST_CASE("events at the same time occur in declared order, and those that a reset causes with them") {
  const test::FinishedRun run = run_text(
      "[discrete]\nn = 0\nk = 0\nj = 0\n"
      "[[event]]\nname = \"first\"\nwhen = \"x - 1\"\ndirection = \"up\"\nset = { n = \"n + 1\", x_dot = \"-x_dot\" }\n"
      "[[event]]\nname = \"second\"\nwhen = \"y - 1\"\nset = { k = \"n\", y_dot = \"-0.5*y_dot\" }\n"
      "[[event]]\nname = \"third\"\nwhen = \"n - 0.5\"\nset = { j = \"j + 10\" }\n"
      "[[event]]\nname = \"noted\"\nwhen = \"x + y - 2\"\n"
      "[scene.default]\nt = [0, 3]\ninitial = { x = 0, y = 0, x_dot = 1, y_dot = 1 }\n");
  std::vector<std::string> names;
  for (const run::RunEvent& event : run.simulation.result.events) names.push_back(event.name);
  CHECK(names == std::vector<std::string>{"first", "second", "third", "noted"});
  CHECK(run.final("k") == 1);
  CHECK(run.final("j") == 10);
  CHECK(run.final("x") == doctest::Approx(-1).epsilon(1e-13));
  CHECK(run.final("y_dot") == doctest::Approx(-0.5).epsilon(1e-13));
}

// A particle at x = t. The functions are exactly zero at t = 1 and t = 1.5, where segments of the run end.
TEST_CASE("an event at the time of a sample, or of a jump of an input, occurs once") {
  const std::string events = R"([discrete]
n = 0
k = 0
[[event]]
name = "tick"
when = "t - 1"
set = { n = "n + 1" }
[[event]]
name = "later"
when = "t - 1.5"
[[event]]
name = "half"
when = "x - 1"
[[event]]
name = "touch"
when = "(t - 1)^2"
[[event]]
name = "falls"
when = "1 - t"
direction = "up"
)";
  const std::string sample = "[[sample]]\nevery = 0.5\nset = { k = \"k + 1\" }\n";
  const std::string table = "[inputs]\nF = {}\n[[force]]\ngeneralized = { y = \"F\" }\n",
                    values = "inputs = { F = { t = [0, 1, 1.5], value = [0, 2, 1] } }\n";
  for (const auto& [before, after] : {std::pair{sample, std::string()}, {table, values}}) {
    for (const std::string solver : {"dop853", "dopri5", "radau5", "rk4", "taylor"}) {
      CAPTURE(before);
      CAPTURE(solver);
      const std::string step = solver == "rk4" ? "step = 0.01\n" : "",
                        scene = "[scene.default]\nt = [0, 3]\ninitial = { x_dot = 1 }\nsolver = \"" + solver + "\"\n";
      const test::FinishedRun run = run_text(events + before + scene + step + after);
      CHECK(run.simulation.result.outcome == eom::Outcome::done);
      CHECK(run.final("n") == 1);
      CHECK(times_of(run, "tick") == std::vector<double>{1});
      CHECK(times_of(run, "later") == std::vector<double>{1.5});
      REQUIRE(times_of(run, "half").size() == 1);
      CHECK(times_of(run, "half")[0] == doctest::Approx(1).epsilon(followed));
      CHECK(times_of(run, "touch").empty());
      CHECK(times_of(run, "falls").empty());
    }
  }
}

// A mass of 1 kg with the force -100 max(0, x - 0.5) - 0.3 x. Between its touches of the bumper it is a harmonic
// oscillator, in it another one; x(4) follows from these pieces.
TEST_CASE("a reset at the place where a force begins leaves the force as it is") {
  for (const std::string force :
       {"-100*max(0, x - B) - 0.3*x", "-0.3*x - 100*(abs(x - B) + x - B)/2", "if(x > B, -100*(x - B), 0) - 0.3*x"}) {
    std::vector<double> ends;
    for (const bool counts : {false, true}) {
      for (const std::string solver : {"dop853", "dopri5", "radau5", "taylor"}) {
        CAPTURE(force);
        CAPTURE(counts);
        CAPTURE(solver);
        const std::string event = "[discrete]\nn = 0\n[[event]]\nname = \"touch\"\nwhen = \"x - B\"\n";
        const test::FinishedRun run =
            run_text("[parameters]\nB = 0.5\n[[force]]\ngeneralized = { x = \"" + force + "\" }\n" + event +
                         (counts ? "set = { n = \"n + 1\" }\n" : "") +
                         "[scene.default]\nt = [0, 4]\ninitial = { x_dot = 1 }\nsolver = \"" + solver + "\"\n",
                     1e-10);
        CHECK(run.simulation.result.outcome == eom::Outcome::done);
        CHECK(times_of(run, "touch").size() == 2);
        ends.push_back(run.final("x"));
      }
    }
    for (const double end : ends) CHECK(end == doctest::Approx(ends.front()).epsilon(1e-7));
    // In the bumper: x = (50 + a cos(w s) + b sin(w s))/w^2 with w^2 = 100.3.
    const double slow = std::sqrt(0.3), w = std::sqrt(100.3), meets = std::asin(0.5 * slow) / slow,
                 v = std::cos(slow * meets);
    const double a = 0.5 - 50 / (w * w), b = v / w, inside = 2 * std::atan2(b, a) / w;
    const double left = 4 - meets - inside;
    CHECK(ends.front() ==
          doctest::Approx(0.5 * std::cos(slow * left) - v / slow * std::sin(slow * left)).epsilon(1e-7));
  }
}

// Friction of 7 N by the sign of the rate, a spring of 100 N/m: each reversal takes 0.14 m, until the spring is too
// weak.
TEST_CASE("a count of reversals leaves dry friction as it is") {
  for (const std::string solver : {"dop853", "dopri5", "radau5"}) {
    for (const double rtol : {1e-6, 1e-9, 1e-11}) {
      CAPTURE(solver);
      CAPTURE(rtol);
      const test::FinishedRun run = run_text(
          "[discrete]\nn = 0\n[[event]]\nname = \"turn\"\nwhen = \"x_dot\"\nset = { n = \"n + 1\" }\n"
          "[[force]]\ngeneralized = { x = \"-100*x - 7*sign(x_dot)\" }\n"
          "[scene.default]\nt = [0, 3]\ninitial = { x = 1 }\nsolver = \"" +
              solver + "\"\n",
          rtol);
      CHECK(run.simulation.result.outcome == eom::Outcome::done);
      CHECK(run.final("n") == 7);
      CHECK(std::abs(run.final("x") + 1 - 7 * 0.14) < 1e3 * rtol);  // the seventh turn is on the other side
      CHECK(std::abs(run.final("x_dot")) < 1e-9);
    }
  }
}

TEST_CASE("an event whose function jumps is located at the jump, also over a value of zero") {
  const auto times = [](const std::string& when, const char* solver = "dop853") {
    const test::FinishedRun run =
        run_text("[inputs]\nF = {}\n[discrete]\nn = 0\n[[event]]\nname = \"a\"\nwhen = \"" + when +
                     "\"\nset = { n = \"n + 1\" }\n[scene.default]\nt = [0, 3]\ninitial = { x_dot = 1 }\nsolver = \"" +
                     solver + "\"\ninputs = { F = \"if(t < 1, 0, if(t < 2, 1, 3))\" }\n",
                 1e-9);
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    const std::vector<double> found = times_of(run, "a");
    CHECK(run.final("n") == 1);
    return found.empty() ? std::nan("") : found.front();
  };
  for (const char* solver : {"dop853", "dopri5", "radau5"}) {
    CHECK(std::abs(times("if(x > 0.7, 1, -1)", solver) - 0.7) < 1e-11);
    CHECK(std::abs(times("sign(x - 0.7)", solver) - 0.7) < 1e-11);
  }
  CHECK(std::abs(times("F - 1") - 2) < 1e-12);  // -1, then 0 for a second, then 2
}

TEST_CASE("velocities that a constraint forbids are made consistent by the impulse that M determines") {
  // A pendulum of length 1 in Cartesian coordinates: only the part of the blow along the circle is left.
  const test::FinishedRun run = run_text(
      "[[constraint]]\nname = \"rod\"\nholonomic = \"x^2 + y^2 - 1\"\n[discrete]\nblows = 0\n"
      "[[event]]\nname = \"blow\"\nwhen = \"t - 1\"\nset = { x_dot = \"x_dot + 3\", y_dot = \"y_dot + 4\", blows = "
      "\"blows + 1\" }\n[scene.default]\nt = [0, 2]\ninitial = { x = 0.6, y = 0.8, x_dot = 0, y_dot = 0 }\n");
  check_sound(run);
  // (3, 4) along the tangent (0.8, -0.6): 0; along (x, y) all of it is taken by the rod.
  CHECK(run.final("blows") == 1);
  CHECK(std::hypot(run.final("x_dot"), run.final("y_dot")) < followed);
  const test::FinishedRun across = run_text(
      "[[constraint]]\nname = \"rod\"\nholonomic = \"x^2 + y^2 - 1\"\n[[event]]\nname = \"blow\"\nwhen = \"t - "
      "1\"\nset "
      "= { x_dot = \"x_dot + 3\" }\n[scene.default]\nt = [0, 1.5]\ninitial = { x = 0.6, y = 0.8, x_dot = 0, y_dot = 0 "
      "}\n");
  CHECK(std::hypot(across.final("x_dot"), across.final("y_dot")) == doctest::Approx(3 * 0.8).epsilon(followed));
}

TEST_CASE("resets without a valid result end the run with their reason") {
  const auto ends = [](const std::string& more, eom::Outcome outcome, const std::string& words) {
    CAPTURE(words);
    const test::FinishedRun run = run_text(more);
    CHECK(run.simulation.result.outcome == outcome);
    CHECK(run.simulation.result.detail.find(words) != std::string::npos);
  };
  const std::string scene = "[scene.default]\nt = [0, 2]\ninitial = { x = 0.6, y = 0.8, x_dot = 0, y_dot = 0 }\n";
  ends(
      "[[constraint]]\nname = \"rod\"\nholonomic = \"x^2 + y^2 - 1\"\n[[event]]\nname = \"jump\"\nwhen = \"t - 1\"\n"
      "set = { x = \"x + 0.1\" }\n" +
          scene,
      eom::Outcome::jump_undetermined, "that violate the constraints (by a displacement of 0.047)");
  ends(
      "[discrete]\na = 0\n[[event]]\nname = \"start\"\nwhen = \"t - 1\"\nset = { a = 1 }\n"
      "[[event]]\nname = \"up\"\nwhen = \"a - 0.5\"\ndirection = \"up\"\nset = { a = 0 }\n"
      "[[event]]\nname = \"down\"\nwhen = \"a - 0.5\"\ndirection = \"down\"\nset = { a = 1 }\n" +
          scene,
      eom::Outcome::step_too_small, "up, down, up, down");
  ends("[[event]]\nname = \"root\"\nwhen = \"t - 1\"\nset = { x_dot = \"sqrt(x - 1)\" }\n" + scene,
       eom::Outcome::not_finite, "'root' sets is not finite");
}

// x = 1 - 5 t^2, and each bounce takes half of the velocity: they end at t = 3 sqrt(1/5), 40 of them above rounding.
TEST_CASE("bounces that become ever shorter end the run where they end, and do not fall through the floor") {
  for (const double direction : {1.0, -1.0}) {
    CAPTURE(direction);
    const std::string sign = direction > 0 ? "" : "-";
    const test::FinishedRun run = run_text(
        "[[force]]\ngravity = \"" + std::string(direction > 0 ? "-" : "") +
        "10*E1\"\n[[event]]\nname = \"bounce\"\nwhen = \"x\"\ndirection = \"" + (direction > 0 ? "down" : "up") +
        "\"\nset = { x_dot = \"-x_dot/2\" }\n[scene.default]\nt = [0, 5]\ninitial = { x = " + sign + "1 }\n");
    CHECK(run.simulation.result.outcome == eom::Outcome::step_too_small);
    CHECK(run.simulation.result.detail.find("events follow one another") != std::string::npos);
    CHECK(run.simulation.result.t == doctest::Approx(3 * std::sqrt(0.2)).epsilon(followed));
    CHECK(std::abs(run.final("x")) < 1e-12);
  }
}

// A fast rotor counts its turns at zeros of sin(x), which it passes without turning back. Steps of `taylor` hold many
// turns.
TEST_CASE("a reset at an event that the motion passes on does not end the run, however fast the event function is") {
  for (const char* solver : {"dop853", "taylor"}) {
    CAPTURE(solver);
    const test::FinishedRun run = run_text(
        "[discrete]\nturns = 0\n[[event]]\nname = \"turn\"\nwhen = \"sin(x)\"\ndirection = \"up\"\n"
        "set = { turns = \"turns + 1\" }\n[scene.default]\nt = [0, 4]\ninitial = { x = -0.5, x_dot = 1000 }\n"
        "solver = \"" +
        std::string(solver) + "\"\n");
    CHECK(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(run.final("turns") == std::floor(3999.5 / (2 * std::numbers::pi)) + 1);
  }
}

TEST_CASE("samples whose times cannot be told apart, or that are too many, are refused") {
  const auto refused = [](const std::string& keys, const std::string& scene, const char* words) {
    const std::string model =
        "[discrete]\na = 0\n[[sample]]\nset = { a = \"a + 1\" }\n" + keys + "[scene.default]\n" + scene;
    CHECK_THROWS_WITH_AS(run_text(model), doctest::Contains(words), Error);
  };
  refused("every = 1e-17\n", "t = [1, 1.00000000001]\n", "is not resolved at times of 1");
  refused("every = 0.1\noffset = 1e300\n", "t = [0, 1]\n", "is not resolved at times of 1e+300");
  refused("every = 1e-8\n", "t = [0, 1]\n", "more than 1e+07 times");
}
