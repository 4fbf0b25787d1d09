// SPDX-License-Identifier: GPL-3.0-or-later
// Models with states of first order, against closed forms where the equations have one, and against equations by hand.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "linear_motion.hpp"
#include "tight_run.hpp"

using namespace eomgen;
using namespace eomgen::test;

// x'' = -f/m, f' = k (x' - f/c).
TEST_CASE("maxwell_element: x and f are those of the linear equations, and the damper takes f^2/c") {
  const test::FinishedRun run = run_tight("maxwell_element");
  check_sound(run);
  const double m = run.parameter("m"), k = run.parameter("k"), c = run.parameter("c");
  const Matrix A{{0, 1, 0}, {0, 0, -1 / m}, {0, k, -k / c}};
  const std::vector<double> start{0.1, 0, 0.1 * k};
  for (std::size_t i = 0; i < run.rows.size(); i += 25) {
    const std::vector<double> x = linear_motion(A, start, run.rows.t[i]);
    CHECK(run.rows.at(i, "x") == doctest::Approx(x[0]).epsilon(followed).scale(1));
    CHECK(run.rows.at(i, "f") == doctest::Approx(x[2]).epsilon(followed).scale(1));
    CHECK(run.rows.at(i, "power") == doctest::Approx(-x[2] * x[2] / c).epsilon(followed).scale(1));
    CHECK(run.rows.at(i, "energy") ==
          doctest::Approx(m * x[1] * x[1] / 2 + x[2] * x[2] / (2 * k)).epsilon(followed).scale(1));
  }
  CHECK(std::abs(run.final("f") - linear_motion(A, start, 3)[2]) < 100 * run.error("f") + 1e-12);
}

// y' = (x - y)/T behind x = X cos(w t): y = X (cos(w t) + w T sin(w t) - exp(-t/T))/(1 + w^2 T^2) from y = 0.
TEST_CASE("first_order_filter: the output has the amplitude and the lag of a low pass") {
  const test::FinishedRun run = run_tight("first_order_filter");
  check_sound(run);
  const double T = run.parameter("T"), w = std::sqrt(run.parameter("k") / run.parameter("m")), a = w * T;
  for (std::size_t i = 0; i < run.rows.size(); i += 25) {
    const double t = run.rows.t[i], y = 0.2 * (std::cos(w * t) + a * std::sin(w * t) - std::exp(-t / T)) / (1 + a * a);
    CHECK(run.rows.at(i, "y") == doctest::Approx(y).epsilon(followed).scale(1));
  }
}

// J w' = kt i - b w, L i' = u - R i - kt w.
TEST_CASE("dc_motor: speed and current are those of the linear equations, from rest and from a given current") {
  const std::optional<double> starts[] = {std::nullopt, 3.0};
  for (const std::optional<double>& current : starts) {
    const test::FinishedRun run = run_tight("dc_motor", [&](pipeline::SimulationRequest& request) {
      request.overrides.solver = "taylor";  // its rows are as accurate as its steps
      if (current) request.overrides.values["i"] = static_cast<long>(*current);
    });
    check_sound(run);
    const auto p = [&run](const char* name) { return run.parameter(name); };
    const double u = 12;
    const Matrix A{{-p("b") / p("J"), p("kt") / p("J")}, {-p("kt") / p("L"), -p("R") / p("L")}};
    const double steady = u / (p("R") * p("b") + p("kt") * p("kt"));
    const std::vector<double> rest{p("kt") * steady, p("b") * steady};
    const std::vector<double> start{-rest[0], current.value_or(0) - rest[1]};
    for (std::size_t i = 0; i < run.rows.size(); i += 25) {
      std::vector<double> x = linear_motion(A, start, run.rows.t[i]);
      x[0] += rest[0], x[1] += rest[1];
      CHECK(run.rows.at(i, "phi_dot") == doctest::Approx(x[0]).epsilon(followed).scale(1));
      CHECK(run.rows.at(i, "i") == doctest::Approx(x[1]).epsilon(followed).scale(1));
      // Electrical power less the losses; the moment of the motor cancels.
      CHECK(run.rows.at(i, "power") ==
            doctest::Approx(u * x[1] - p("R") * x[1] * x[1] - p("b") * x[0] * x[0]).epsilon(followed).scale(1));
    }
  }
}

// m x'' = kp (r - x) + ki I - kd x' - m g sin(slope), I' = r - x.
TEST_CASE("pid_cart: the motion is that of the linear equations, and the integrator takes the weight") {
  const test::FinishedRun run = run_tight("pid_cart");
  check_sound(run);
  const auto p = [&run](const char* name) { return run.parameter(name); };
  const double m = p("m"), weight = m * p("g") * std::sin(p("slope"));
  // Of x - r, x', I - weight/ki.
  const Matrix A{{0, 1, 0}, {-p("kp") / m, -p("kd") / m, p("ki") / m}, {-1, 0, 0}};
  const std::vector<double> start{-p("r"), 0, -weight / p("ki")};
  for (std::size_t i = 0; i < run.rows.size(); i += 25) {
    const std::vector<double> x = linear_motion(A, start, run.rows.t[i]);
    CHECK(run.rows.at(i, "x") == doctest::Approx(p("r") + x[0]).epsilon(followed).scale(1));
    CHECK(run.rows.at(i, "I") == doctest::Approx(weight / p("ki") + x[2]).epsilon(followed).scale(1));
  }
  CHECK(std::abs(run.final("error")) < 1e-2);
}

// w' = -M/J, C T' = M w - h T: T is linear in t, and an exponential.
TEST_CASE("brake_temperature: the temperature is that of heat at a falling rate, and energy leaves through the air") {
  const test::FinishedRun run = run_tight("brake_temperature");
  check_sound(run);
  const auto p = [&run](const char* name) { return run.parameter(name); };
  const double w0 = 200, fall = p("M") / p("J"), rate = p("h") / p("C"), q = p("M") / p("C");
  // T' = q (w0 - fall t) - rate T
  const double slope = -q * fall / rate, level = (q * w0 - slope) / rate;
  for (std::size_t i = 0; i < run.rows.size(); i += 25) {
    const double t = run.rows.t[i], T = level + slope * t + (15 - level) * std::exp(-rate * t);
    CHECK(run.rows.at(i, "T") == doctest::Approx(T).epsilon(followed).scale(1));
    CHECK(run.rows.at(i, "power") == doctest::Approx(-p("h") * T).epsilon(followed).scale(1));
  }
}

TEST_CASE("brake_temperature: without the air the energy of wheel and disk is conserved") {
  const test::FinishedRun run =
      run_tight("brake_temperature", [](pipeline::SimulationRequest& request) { request.overrides.values["h"] = 0; });
  CHECK(run.final("energy") == doctest::Approx(run.rows.at(0, "energy")).epsilon(followed));
  CHECK(run.rows.at(0, "energy") == doctest::Approx(0.5 * 200 * 200 / 2 + 400 * 15.0).epsilon(1e-12));
}

// On a path with x' of one sign and z of one sign, dz/dx = A - s z with s = beta sign(x') sign(z) + gamma, so that
// (z - A/s) exp(s x) is constant; at s = 0, z - A x.
TEST_CASE("bouc_wen: z follows the exponentials of hysteresis between reversals") {
  const test::FinishedRun run = run_tight("bouc_wen", [](pipeline::SimulationRequest& request) {
    request.overrides.max_step = 0.01;  // rows between longer steps are less accurate than the steps
  });
  check_sound(run);
  const auto p = [&run](const char* name) { return run.parameter(name); };
  std::size_t compared = 0, reversals = 0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    const auto at = [&](std::size_t row, const char* name) { return run.rows.at(row, name); };
    if (at(i, "x_dot") * at(i - 1, "x_dot") <= 0) ++reversals;
    if (at(i, "x_dot") * at(i - 1, "x_dot") <= 0 || at(i, "z") * at(i - 1, "z") <= 0) continue;
    const double forwards = at(i, "x_dot") > 0 ? 1 : -1, side = at(i, "z") > 0 ? 1 : -1;
    const double s = forwards * p("beta") + side * p("gamma"), dx = at(i, "x") - at(i - 1, "x");
    const double z = p("A") / s + (at(i - 1, "z") - p("A") / s) * std::exp(-s * dx);
    CHECK(at(i, "z") == doctest::Approx(z).epsilon(followed).scale(1e-2));
    ++compared;
  }
  CHECK(compared > 400);
  CHECK(reversals > 5);
}

// J_O b'' = r F - M g l sin(b) - c b', with the force by its factors, along the rows of the run.
TEST_CASE("hill_muscle: the activation rises exponentially, and the accelerations are those of the factors by hand") {
  const test::FinishedRun run = run_tight("hill_muscle", [](pipeline::SimulationRequest& request) {
    request.overrides.outputs = {"force", "b_ddot"};
  });
  check_sound(run);
  const auto p = [&run](const char* name) { return run.parameter(name); };
  for (std::size_t i = 0; i < run.rows.size(); i += 10) {
    const auto at = [&](const char* name) { return run.rows.at(i, name); };
    const double a = 0.2 - 0.15 * std::exp(-run.rows.t[i] / p("rise"));
    CHECK(at("a") == doctest::Approx(a).epsilon(followed));
    const double stretch = (p("l0") + p("r") * (1 - at("b"))) / p("l0") - 1, v = p("r") * at("b_dot") / p("vm");
    const double force = a * p("F0") * std::exp(-std::pow(stretch / p("width"), 2)) * (1 - v) / (1 + 4 * v);
    CHECK(at("force") == doctest::Approx(force).epsilon(followed));
    const double moment = p("r") * force - p("M") * p("g") * p("l") * std::sin(at("b")) - p("c") * at("b_dot");
    CHECK(at("b_ddot") == doctest::Approx(moment / (p("J") + p("M") * p("l") * p("l"))).epsilon(followed).scale(10));
  }
}

// The block sticks first: its bristles carry the pull of the spring, up to the static friction.
TEST_CASE("lugre_friction: it sticks up to the static friction and slips, again and again") {
  const test::FinishedRun run =
      test::run_model("lugre_friction", [](pipeline::SimulationRequest& request) { request.estimate = false; });
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.simulation.certificate.pass);
  CHECK(run.simulation.result.power_balance < 1e-5);
  const auto p = [&run](const char* name) { return run.parameter(name); };
  double most = 0;
  std::size_t slips = 0, sticks = 0;
  bool slides = false;
  for (std::size_t i = 1; i + 1 < run.rows.size(); ++i) {
    const auto at = [&](std::size_t row, const char* name) { return run.rows.at(row, name); };
    const double v = at(i, "x_dot"), friction = at(i, "friction_force");
    most = std::max(most, friction);
    const bool rests = std::max({std::abs(at(i - 1, "x_dot")), std::abs(v), std::abs(at(i + 1, "x_dot"))}) < 1e-4;
    if (rests) {
      ++sticks;
      CHECK(friction == doctest::Approx(p("k") * (p("v0") * run.rows.t[i] - at(i, "x"))).epsilon(2e-3));
    }
    if (v > 0.01 && !slides) ++slips;
    slides = v > 0.01;
  }
  CHECK(most > 0.95 * p("Fs"));
  CHECK(most < p("Fs") + p("s2") * 0.5);
  CHECK(slips == 2);
  CHECK(sticks > 100);
}
