// SPDX-License-Identifier: GPL-3.0-or-later
// Command equilibria: document, text and refusals. Its numbers are tested in tests/linear.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

TEST_CASE("equilibria: points with values, eigenvalues and stability, the same for the same seed") {
  const Folder folder;
  const Json found = document(folder, {"equilibria", "S5_double_pendulum"});
  REQUIRE(found["points"].size() == 4);
  CHECK(found["points"][0]["stable"] == true);
  CHECK(found["points"][3]["stable"] == false);
  CHECK(found["points"][0]["eigenvalues"].size() == 4);
  CHECK(found["points"][1]["values"]["theta2"].get<double>() == doctest::Approx(3.14159265358979));
  CHECK(document(folder, {"equilibria", "S5_double_pendulum"}) == found);
  CHECK(document(folder, {"equilibria", "S5_double_pendulum", "--seed", "7"})["points"].size() == 4);
  const std::string text = expect(0, folder, {"equilibria", "S5_double_pendulum"}).out;
  CHECK(contains(text, "4 equilibria and steady motions found"));
  CHECK(contains(text, "equilibrium, stable: the second variation of 'energy'"));
  CHECK(document(folder, {"equilibria", "R13_sleigh", "--scene", "straight"})["held"].size() == 2);
  CHECK(document(folder, {"equilibria", "R6_rolling_disk"})["points"][0]["stable"] == "unknown");
}

TEST_CASE("equilibria: zero coordinates are shown without sign, and a force that ends the search is named") {
  const Folder folder;
  const std::string text = expect(0, folder, {"equilibria", "S5_double_pendulum"}).out;
  CHECK(contains(text, "theta1                                          0\n"));
  const Json found = document(folder, {"equilibria", "S5_double_pendulum"});
  CHECK(found["points"][0]["values"]["theta1"] == 0.0);
  CHECK(!std::signbit(found["points"][0]["values"]["theta1_dot"].get<double>()));
  CHECK(found["points"][0]["off"] == 0.0);
  CHECK(found["refused"] == 0);
  folder.write("stick.toml",
               "format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = "
               "\"x^2/2\"\n[[force]]\nname = \"stick\"\n"
               "generalized = { x = \"-sign(x_dot)\" }\n[scene.default]\ninitial = { x = 1, x_dot = -0.0 }\n");
  const std::string why = expect(2, folder, {"equilibria", "stick.toml"}).err;
  CHECK(contains(why, "stick.toml:7:"));
  CHECK(contains(why, "'stick' has no slope"));
}

TEST_CASE("equilibria: without any equilibrium, the report states that no start led to one") {
  const Folder folder;
  folder.write("shafts.toml",
               "format = 1\n[coordinates]\na = {}\nb = {}\nc = {}\n[energy]\nkinetic = \"a_dot^2/2 + (a_dot + b_dot)^2 "
               "+ 3/2*(a_dot + b_dot + c_dot)^2\"\n"
               "[[force]]\ngeneralized = { a = \"2\" }\n");
  const Json found = document(folder, {"equilibria", "shafts.toml"});
  CHECK(found["points"].empty());
  CHECK(found["converged"] == 0);
}

TEST_CASE("equilibria: time-dependent equations, contacts and invalid holds are refused with a remedy") {
  const Folder folder;
  CHECK(contains(expect(2, folder, {"equilibria", "P1_spherical_pendulum_varying"}).err, "eomgen linearize"));
  CHECK(contains(expect(2, folder, {"equilibria", "bouncing_ball"}).err, "linearise a copy"));
  CHECK(
      contains(expect(2, folder, {"equilibria", "R10_lagrange_top", "--hold", "thta=1"}).err, "did you mean 'theta'?"));
  CHECK(contains(expect(2, folder, {"equilibria", "R10_lagrange_top", "--hold", "psi=1"}).err, "it is ignorable"));
  CHECK(contains(expect(2, folder, {"equilibria", "S5_double_pendulum", "--hold", "reaction.rod1=1"}).err,
                 "constraint forces"));
  CHECK(contains(expect(2, folder, {"equilibria", "R10_lagrange_top", "--hold", "theta"}).err,
                 "write --hold NAME=VALUE"));
  CHECK(contains(expect(2, folder, {"equilibria", "R10_lagrange_top", "--starts", "0"}).err, "--starts"));
}
