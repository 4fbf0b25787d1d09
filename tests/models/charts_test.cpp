// SPDX-License-Identifier: GPL-3.0-or-later
// Runs through singularities of angles: against Euler parameters, straight lines, Jacobi's solution and conserved
// quantities.
#include <doctest/doctest.h>

#include <cmath>

#include "support/attitude.hpp"
#include "support/free_body.hpp"
#include "support/run_text.hpp"

using namespace eomgen;

namespace {

constexpr std::array<double, 3> J_body{1, 1.3, 2.2}, H{0.949, 0, 1.1616};  // and the start: w2 = 0

std::size_t exchanges(const test::FinishedRun& run, const std::string& whose = "B") {
  std::size_t count = 0;
  for (const run::RunEvent& event : run.simulation.result.events)
    count += event.kind == "chart" && event.name == whose ? 1 : 0;
  return count;
}

/// Outputs e_k . E_j of the body, "c11" to "c33".
std::string cosines(std::string& names) {
  std::string text;
  for (char k = '1'; k <= '3'; ++k) {
    for (char j = '1'; j <= '3'; ++j) {
      text += std::string("c") + k + j + " = \"dot(B.e" + k + ", E" + j + ")\"\n";
      names += std::string("\"c") + k + j + "\", ";
    }
  }
  return text;
}

const std::string omegas = "\"B.omega1\", \"B.omega2\", \"B.omega3\"";

test::FinishedRun thousand_turns(const rotations::Rotation& r, const std::string& solver) {
  // All axes of this body come near directions at the angle of (1, 1, 1) from E1, E2, E3 to H.
  const Eigen::Vector3d of_body = Eigen::Vector3d(H[0], H[1], H[2]).normalized(),
                        of_space = Eigen::Vector3d(1, 1, 1).normalized();
  const Eigen::AngleAxisd between(std::acos(of_body.dot(of_space)), of_body.cross(of_space).normalized());
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.3, of_space).toRotationMatrix() * between.toRotationMatrix();
  const test::Attitude written = *test::attitude_in(r, axes.transpose());
  std::string names;
  const std::string definitions = cosines(names);
  const auto adjust = [&solver](pipeline::SimulationRequest& request) {
    request.estimate = false;
    request.overrides.rtol = request.overrides.atol = 1e-13;
    request.overrides.solver = solver;
  };
  return test::run_text(
      "charts_" + r.name,
      "[[body]]\nname = \"B\"\nmass = 1\ninertia = { principal = [1, 1.3, 2.2] }\nrotation = " + written.rotation +
          "\n[definitions]\n" + definitions + "[scene.default]\nt = [0, 6200]\ninitial = { " + written.start +
          ", \"B.omega\" = [0.949, 0, 0.528] }\noutputs = [" + names + omegas + "]\n",
      adjust);
}

/// Energy and |H| of the rows, relative to the start; the largest difference of w from Jacobi's.
struct Drifts {
  double energy = 0, momentum = 0, omega = 0, turns = 0;
};
Drifts drifts_of(const test::Rows& rows) {
  Drifts worst;
  double energy0 = 0, momentum0 = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double momentum = 0, square = 0;
    const std::array<double, 3> closed = test::free_body(J_body, 0.949, 0.528, rows.t[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = rows.at(i, "B.omega" + std::to_string(k + 1));
      square += w * w;
      momentum += J_body[k] * J_body[k] * w * w;
      worst.omega = std::max(worst.omega, std::abs(w - closed[k]));
    }
    momentum = std::sqrt(momentum);
    if (i > 0) worst.turns += std::sqrt(square) * (rows.t[i] - rows.t[i - 1]) / (2 * M_PI);
    const double energy = rows.at(i, "energy");
    if (i == 0) energy0 = energy, momentum0 = momentum;
    worst.energy = std::max(worst.energy, std::abs(energy / energy0 - 1));
    worst.momentum = std::max(worst.momentum, std::abs(momentum / momentum0 - 1));
  }
  return worst;
}

}  // namespace

TEST_CASE(
    "charts: a thousand turns of a free body, in twelve sets of Euler angles with exchanges and in Euler parameters") {
  const test::FinishedRun reference =
      thousand_turns(*rotations::find("euler_parameters"),
                     "tsit5");  // dop853 takes 13 times longer steps here, and is 4e-7 off
  CHECK(exchanges(reference) == 0);
  std::size_t sets = 0;
  for (const rotations::Rotation& r : rotations::registry()) {
    if (r.family != "euler") continue;
    INFO(r.name);
    ++sets;
    const test::FinishedRun run = thousand_turns(r, "dop853");
    REQUIRE(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(exchanges(run) > 100);  // it came near where the set fails again and again
    const Drifts found = drifts_of(run.rows);
    CHECK(found.turns > 1000);
    CHECK(found.energy < 1e-9);
    CHECK(found.momentum < 1e-9);
    CHECK(found.omega < 1e-7);
    CHECK(run.drift("energy") < 1e-9);
    double worst = 0;
    REQUIRE(run.rows.size() == reference.rows.size());
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      for (std::size_t c = 0; c < 9; ++c) {
        const std::string name = "c" + std::to_string(c / 3 + 1) + std::to_string(c % 3 + 1);
        worst = std::max(worst, std::abs(run.rows.at(i, name) - reference.rows.at(i, name)));
      }
    }
    CHECK(worst < 1e-7);
  }
  CHECK(sets == 12);
}

TEST_CASE("charts: a rotation exactly through the singularity of the angles is continuous except there") {
  for (const char* set : {"313", "321"}) {
    INFO(set);
    const bool symmetric = set[2] == '3';
    const double start = symmetric ? 1 : M_PI / 2 - 1;  // falling to 0, or rising to pi/2
    const double rate = symmetric ? -1 : 1;
    char numbers[100];
    std::snprintf(numbers, sizeof numbers, "a = 0.3, b = %.17g, c = -0.4, b_dot = %g", start, rate);
    const test::FinishedRun run = test::run_text(
        std::string("charts_through_") + set,
        std::string("[[body]]\nname = \"B\"\nmass = 1\ninertia = { principal = [2, 2, 2] }\nrotation = { euler = \"") +
            set +
            "\", angles = [\"a\", \"b\", \"c\"] }\n[scene.default]\nt = [0, 2]\nrtol = 1e-12\natol = 1e-13\nevery = "
            "0.25\ninitial = { " +
            numbers + " }\n");
    REQUIRE(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(exchanges(run) == 2);
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      const double t = run.rows.t[i];
      if (t == 1) continue;               // there the angles have no values
      const double s = t < 1 ? 0 : M_PI;  // beyond it the same attitude with a positive sine or cosine
      CHECK(run.rows.at(i, "b") ==
            doctest::Approx(symmetric ? std::abs(1 - t) : M_PI / 2 - std::abs(1 - t)).epsilon(1e-11));
      CHECK(std::abs(std::remainder(run.rows.at(i, "a") - 0.3 - s, 2 * M_PI)) < 1e-10);
      CHECK(std::abs(std::remainder(run.rows.at(i, "c") + 0.4 - s, 2 * M_PI)) < 1e-10);
      CHECK(run.rows.at(i, "energy") == doctest::Approx(1).epsilon(1e-12));
    }
  }
}

TEST_CASE("charts: a start at a singularity continues in the second chart; without charts it fails") {
  const std::string text =
      "[[body]]\nname = \"B\"\nmass = 1\ninertia = { principal = [1, 2, 2.5] }\nrotation = { euler = \"313\", angles = "
      "[\"a\", \"b\", \"c\"] }\n"
      "[scene.default]\nt = [0, 3]\nrtol = 1e-12\natol = 1e-13\ninitial = { a = 0.2, b_dot = 0.7, a_dot = 0.4, c_dot = "
      "0.3 }\noutputs = [" +
      omegas + "]\n";
  const test::FinishedRun run = test::run_text("charts_start", text);
  REQUIRE(run.simulation.result.outcome == eom::Outcome::done);
  REQUIRE(exchanges(run) >= 2);
  CHECK(run.simulation.result.events.front().t == 0);
  CHECK(run.rows.at(0, "B.omega3") == doctest::Approx(0.7).epsilon(1e-14));  // a_dot + c_dot
  CHECK(run.drift("energy") < 1e-11);
  CHECK(run.simulation.result.error_estimate.back().second < 1e-10);
  CHECK_THROWS_WITH_AS(
      test::run_text("charts_start", text, [](pipeline::SimulationRequest& request) { request.charts = false; }),
      doctest::Contains("the start is a singular configuration"), Error);
}

TEST_CASE("charts: a particle in spherical coordinates moves straight past the pole and through it") {
  for (const double miss : {0.0, 1e-6, 0.1}) {
    INFO(miss);
    // From (1, miss, 1) along -E1.
    const double R = std::sqrt(2 + miss * miss), s = std::hypot(1.0, miss);
    char numbers[300];
    std::snprintf(numbers, sizeof numbers,
                  "R = %.17g, phi = %.17g, theta = %.17g, R_dot = %.17g, phi_dot = %.17g, theta_dot = %.17g", R,
                  std::atan2(s, 1), std::atan2(miss, 1), -1 / R, -1 / (R * R * s), miss / (s * s));
    const test::FinishedRun run = test::run_text(
        "charts_line",
        std::string("[[particle]]\nname = \"P\"\nmass = 2\nposition = { spherical = [\"R\", \"phi\", \"theta\"] }\n"
                    "[scene.default]\nt = [0, 2.5]\nrtol = 1e-12\natol = 1e-13\ninitial = { ") +
            numbers + " }\noutputs = [\"P.position1\", \"P.position2\", \"P.position3\"]\n");
    REQUIRE(run.simulation.result.outcome == eom::Outcome::done);
    CHECK(exchanges(run, "P") == 2);
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      CHECK(std::abs(run.rows.at(i, "P.position1") - (1 - run.rows.t[i])) < 1e-10);
      CHECK(std::abs(run.rows.at(i, "P.position2") - miss) < 1e-10);
      CHECK(std::abs(run.rows.at(i, "P.position3") - 1) < 1e-10);
    }
    CHECK(run.final("phi") == doctest::Approx(std::atan2(std::hypot(1.5, miss), 1)).epsilon(1e-10));
    CHECK(std::abs(std::remainder(run.final("theta") - std::atan2(miss, -1.5), 2 * M_PI)) < 1e-9);
    if (miss > 0) CHECK(std::abs(run.final("theta") - std::atan2(miss, -1.5)) < 1e-9);  // no turn is missed
    CHECK(run.drift("energy") < 1e-11);
  }
}

TEST_CASE("charts: a pendulum on a sphere swings exactly through its lowest point, a pole of its coordinates") {
  const test::FinishedRun run =
      test::run_text("charts_pendulum",
                     "[parameters]\ng = 9.81\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { spherical = [\"R\", "
                     "\"phi\", \"theta\"] }\n"
                     "[[force]]\ngravity = \"-g*E3\"\n[[constraint]]\nname = \"rod\"\nholonomic = \"R - "
                     "1\"\n[scene.default]\nt = [0, 5]\nrtol = 1e-12\natol = 1e-13\n"
                     "initial = { phi = \"pi - 1\", theta = 0.4 }\noutputs = [\"P.position3\", \"reaction.rod\"]\n");
  REQUIRE(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(exchanges(run, "P") >= 8);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const test::Swing swing = test::pendulum_from_rest(1, std::sqrt(9.81), run.rows.t[i]);
    CHECK(std::abs(run.rows.at(i, "P.position3") + std::cos(swing.angle)) < 1e-9);
    CHECK(std::abs(run.rows.at(i, "reaction.rod") + 9.81 * std::cos(swing.angle) + swing.rate * swing.rate) <
          1e-8);  // inwards
  }
  CHECK(run.drift("energy") < 1e-10);
}

TEST_CASE("charts: the multipliers of a joint are the same in both charts, and those of Euler parameters") {
  const auto model = [](const std::string& rotation, const std::string& start) {
    return "[parameters]\ng = 9.81\n[[body]]\nname = \"B\"\nmass = 2\ninertia = { principal = [0.3, 0.5, 0.2] "
           "}\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\n"
           "rotation = " +
           rotation +
           "\n[[force]]\ngravity = \"-g*E3\"\n[[constraint]]\nname = \"joint\"\nholonomic = \"B - B.e3\"\n"
           "[scene.default]\nt = [0, 4]\nevery = 0.008\nrtol = 1e-12\natol = 1e-13\ninitial = { " +
           start + " }\noutputs = [\"reaction.joint\", " + omegas + "]\n";
  };
  const std::string placed = "y = \"-sin(2.2)\", z = \"cos(2.2)\"";  // x3 axis turned about E1
  const test::Attitude angles{"{ euler = \"313\", angles = [\"a\", \"b\", \"c\"] }",
                              "b = 2.2, \"B.omega\" = [0.4, 0.1, 3], " + placed};
  char start[300];
  std::snprintf(start, sizeof start, "e0 = %.17g, e1 = %.17g, \"B.omega\" = [0.4, 0.1, 3], %s", std::cos(1.1),
                std::sin(1.1), placed.c_str());
  const test::FinishedRun euler = test::run_text("charts_joint", model(angles.rotation, angles.start));
  const test::FinishedRun parameters = test::run_text(
      "charts_joint_parameters", model("{ euler_parameters = [\"e0\", \"e1\", \"e2\", \"e3\"] }", start));
  REQUIRE(euler.simulation.result.outcome == eom::Outcome::done);
  CHECK(exchanges(euler) >= 2);
  for (std::size_t i = 0; i < euler.rows.size(); ++i) {
    for (const char* name : {"x", "y", "z", "B.omega1", "B.omega2", "B.omega3", "reaction.joint.1", "reaction.joint.2",
                             "reaction.joint.3"}) {
      CHECK(std::abs(euler.rows.at(i, name) - parameters.rows.at(i, name)) < 1e-7);  // reactions up to 60 N
    }
  }
  CHECK(euler.drift("energy") < 1e-10);
  CHECK(euler.simulation.result.constraint_drift < 1e-12);
}

TEST_CASE(
    "charts: a satellite that tumbles on an orbit over the poles exchanges both, and keeps energy and moment of "
    "momentum") {
  std::string text = test::read_text(test::model_path("R7_satellite"));
  text = text.substr(0, text.find("[scene.default]"));
  text = text.substr(text.find("format = 1\n") + 11);
  const test::FinishedRun run = test::run_text(
      "charts_satellite",
      text +
          "[scene.default]\nt = [0, 20]\nrtol = 1e-12\natol = 1e-13\noutputs = [\"HO1\", \"HO2\", \"HO3\"]\n"
          "[scene.default.initial]\nR = 1\nphi = 1.2\nphi_dot = -1\ntheta_dot = 0.05\nn1 = 0.1\nn2 = "
          "0.2\n\"S.omega\" = [0.3, 0.9, 0.2]\n");
  REQUIRE(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(exchanges(run, "S") >= 2);
  CHECK(exchanges(run, "S.position") >= 6);
  CHECK(run.drift("energy") < 1e-10);
  for (const char* name : {"HO1", "HO2", "HO3"}) {
    for (std::size_t i = 0; i < run.rows.size(); ++i)
      CHECK(std::abs(run.rows.at(i, name) - run.rows.at(0, name)) < 1e-10);
  }
}

TEST_CASE("charts: if a constraint contains an angle, the run keeps its coordinates") {
  const test::FinishedRun run = test::run_model("R14_sliding_cylinder");
  CHECK(exchanges(run, "rod") == 0);
  CHECK_FALSE(run.simulation.charts);
}
