// SPDX-License-Identifier: GPL-3.0-or-later
// Command stress: document, exit codes, and the quick variations of a few shipped models.
#include <doctest/doctest.h>

#include <cmath>
#include <tuple>

#include "program.hpp"

using namespace eomgen::test;

TEST_CASE("stress: no run of these shipped models fails undetected") {
  const Folder folder;
  for (const char* model :
       {"elastic_pendulum", "P2_planar_pendulum", "cart_pendulum", "R1_free_body_euler_parameters"}) {
    const std::string of_model = model;
    CAPTURE(of_model);
    const Json found =
        document(folder, {"stress", model, "--quick", "--steps", "5000", "--seconds", "1e6", "--t-end", "1"});
    CHECK(found["verdict"] == "pass");
    CHECK(found["undetected"] == 0);
    CHECK(found["pass"].get<int>() > 10);
    for (const Json& row : found["rows"]) CHECK_FALSE(row["verdict"] == "undetected");
    const Json& audit = found["denominator_audit"];
    CHECK(audit["states"].get<int>() > 20);
    CHECK(audit["digits_lost"]["value"].get<double>() >= 0);
    CHECK(audit["mass_condition"]["value"].get<double>() >= 1);
    if (std::string(model) != "elastic_pendulum") continue;
    // r'' = .. - k (r - L)/m, theta'' = (..)/r: no other terms; near r = 0 the mass matrix diag(m, m r^2) is
    // that of a point.
    CHECK(audit["denominators"].size() == 2);
    for (const Json& d : audit["denominators"]) CHECK(d["zero"] == d["expression"].get<std::string>() + " = 0");
    CHECK(audit["mass_condition"]["case"] == "r at 0 + 1e-09");
    CHECK(audit["mass_condition"]["value"].get<double>() == doctest::Approx(1e18));
    CHECK(audit["scaled_mass_condition"]["value"].get<double>() == doctest::Approx(1));
    CHECK(audit["digits_lost"]["value"].get<double>() > 3);  // a stiff spring that is barely stretched
  }
}

TEST_CASE("stress: a start near a coordinate singularity satisfies the constraints") {
  const Folder folder;
  const Json found = document(folder, {"stress", "R8_pendulum_body_joint", "--quick", "--steps", "1000", "--seconds",
                                       "1e6", "--solver", "dop853", "--solver", "auto", "--t-end", "0.5"});
  CHECK(found["undetected"] == 0);
  int near = 0;
  for (const Json& row : found["rows"])
    near += contains(row["case"].get<std::string>(), " at ") && row["verdict"] == "pass" ? 1 : 0;
  CHECK(near > 0);
  for (const Json& left : found["left_out"])
    CHECK_FALSE(contains(left["reason"].get<std::string>(), "constraints allow no start"));
}

TEST_CASE("stress: a constraint that is stated twice is refused, or recognised as one that follows from the first") {
  const Folder folder;
  for (const auto& [model, constraint, outcome] : {std::tuple{"R12_pinned_body", "pin", "accepted: "},
                                                   {"R12_pinned_body", "tilt", "refused: "},
                                                   {"R16_sphere_on_sphere", "contact", "accepted: "}}) {
    const std::string of_constraint = constraint;
    CAPTURE(of_constraint);
    const Json found = document(folder, {"stress", model, "--quick", "--steps", "1000", "--seconds", "1e6", "--solver",
                                         "dop853", "--t-end", "0.1"});
    CHECK(found["undetected"] == 0);
    int cases = 0;
    for (const Json& left : found["left_out"]) {
      if (left["case"] != "constraint " + of_constraint + " twice") continue;
      CHECK(left["reason"].get<std::string>().starts_with(outcome));
      ++cases;
    }
    CHECK(cases == 1);
  }
}

// A stiff spring through its centre: whatever the number of steps, the force turns within one of them, and some of
// these numbers agree by chance.
TEST_CASE("run: the estimate of fixed steps sees a force that turns within one of them") {
  const Folder folder;
  const auto end = [&](const char* solver, const char* how, const char* much) {
    return document(folder, {"run", "P13_saddle_field", "--set", "K=9e12", "--t-end", "5.15473e-06", "--solver", solver,
                             how, much});
  };
  const Json right = end("dop853", "--rtol", "1e-13");
  for (const char* step : {"1.030946e-08", "5.15473e-09", "2.577365e-09"}) {
    const Json fixed = end("midpoint", "--step", step);
    for (const char* state : {"x_dot", "y_dot", "z_dot"}) {
      CAPTURE(std::string(state));
      const double error = std::abs(fixed["final"][state].get<double>() - right["final"][state].get<double>());
      CHECK(fixed["error_estimate"][state].get<double>() >=
            error / 10);  // design: a reported error is within ten times the estimate
    }
    CHECK(contains(fixed.dump(), "a force turns within one step"));
  }
}

// Close to the pole, the rate follows from the momentum and an angle whose last digit is 4e-4 of its distance from the
// pole. Orders 2 and 6 agree and are equally wrong.
TEST_CASE("run: the estimate of variational solvers includes the loss of digits of rates near the pole") {
  const Folder folder;
  const Json found = document(folder, {"stress", "G1_spherical", "--steps", "1000", "--seconds", "1e6", "--solver",
                                       "variational2", "--solver", "variational6"});
  CHECK(found["undetected"] == 0);
}

// P5: slip starts almost at rest and grows. P6: it ends within the first step. R16: it lasts 2e-4 s before the contact
// opens.
TEST_CASE("stress: slow or short slip is detected with fixed steps, and in the reference solution") {
  const Folder folder;
  for (const auto& [model, solver] :
       {std::pair{"P5_rough_sphere", "rk4"}, {"P6_rough_circle", "midpoint"}, {"R16_disk_on_disk", "rodas"}}) {
    const std::string of_model = model;
    CAPTURE(of_model);
    const Json found = document(folder, {"stress", model, "--solver", solver, "--steps", "2000", "--seconds", "1e6"});
    CHECK(found["undetected"] == 0);
    CHECK(found["rows"].size() > 40);
  }
}

TEST_CASE("stress: invalid input is refused before any run") {
  const Folder folder;
  CHECK(contains(expect(2, folder, {"stress", "P2_planar_pendulum", "--solver", "dopri"}).err, "did you mean"));
  CHECK(contains(expect(2, folder, {"stress", "P2_planar_pendulum", "--set", "nothing=1"}).err, "nothing"));
}
