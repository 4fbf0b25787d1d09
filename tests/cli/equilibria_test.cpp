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

TEST_CASE("equilibria --trim: inputs that hold a pose, a steady motion, and a pose on constraints") {
  const Folder folder;
  folder.write("arm.toml",
               "format = 1\n[parameters]\nm = 2\nl = 0.5\ng = 9.81\n[inputs]\nM = { default = 7 }\nN = {}\nidle = { "
               "default = 4 }\n"
               "[coordinates]\ntheta = {}\nz = {}\n[energy]\nkinetic = \"m*l^2*theta_dot^2/2 + z_dot^2/2\"\n"
               "potential = \"-m*g*l*cos(theta)\"\n[[force]]\ngeneralized = { theta = \"M + 2*N - 3*theta_dot\" }\n"
               "[scene.default]\nt = [0, 1]\ninitial = { theta = 0.5 }\n");
  const double torque = 2 * 0.5 * 9.81 * std::sin(0.5);
  const Json one = document(folder, {"equilibria", "arm.toml", "--trim", "M"})["trim"];
  CHECK(one["inputs"]["M"].get<double>() == doctest::Approx(torque).epsilon(1e-15));
  CHECK(one["inputs"]["idle"] == 4.0);
  CHECK(one["unique"] == true);
  CHECK(one["residual"].get<double>() < 1e-15);
  // Rates belong to the state.
  const Json turning = document(folder, {"equilibria", "arm.toml", "--trim", "M", "--set", "theta_dot=2"})["trim"];
  CHECK(turning["inputs"]["M"].get<double>() == doctest::Approx(torque + 6).epsilon(1e-15));
  // M = 7 + d, N = 2 d: the smallest changes.
  const Json two = document(folder, {"equilibria", "arm.toml", "--trim", "M,N"})["trim"];
  CHECK(two["unique"] == false);
  CHECK(two["inputs"]["M"].get<double>() == doctest::Approx(7 + (torque - 7) / 5).epsilon(1e-14));
  CHECK(two["inputs"]["N"].get<double>() == doctest::Approx(2 * (torque - 7) / 5).epsilon(1e-14));
  const std::string text = expect(0, folder, {"equilibria", "arm.toml", "--trim", "M,N"}).out;
  CHECK(contains(text, "these are the smallest changes"));
  CHECK(contains(text, "as in the scene"));

  folder.write(
      "track.toml",
      "format = 1\n[parameters]\nm = \"2 kg\"\nL = \"0.5 m\"\ng = \"9.81 m/s^2\"\n[inputs]\nF = { unit = \"N\" }\n"
      "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\n"
      "[[force]]\ngravity = \"-g*E3\"\n[[force]]\non = \"P\"\nforce = \"F*E1\"\n"
      "[[constraint]]\nname = \"plane\"\nholonomic = \"y\"\n[[constraint]]\nname = \"rod\"\n"
      "holonomic = \"x^2 + z^2 - L^2\"\n[scene.default]\nt = [0, 1]\ninitial = { x = 0.3, z = -0.4 }\n");
  const Json track = document(folder, {"equilibria", "track.toml", "--trim", "F"})["trim"];
  CHECK(track["inputs"]["F"].get<double>() == doctest::Approx(2 * 9.81 * 0.75).epsilon(1e-14));
}

TEST_CASE("equilibria --trim: states that inputs cannot hold, unknown names and options without meaning are refused") {
  const Folder folder;
  const std::string error = expect(3, folder, {"equilibria", "cart_pendulum", "--trim", "F", "--set", "theta=0.4"}).err;
  CHECK(contains(error, "F cannot hold this state: "));
  CHECK(contains(error, "_dot"));
  CHECK(contains(expect(2, folder, {"equilibria", "cart_pendulum", "--trim", "G"}).err, "there is no input 'G'"));
  CHECK(contains(expect(2, folder, {"equilibria", "cart_pendulum", "--trim", "F,F"}).err, "'F' is named twice"));
  CHECK(contains(expect(2, folder, {"equilibria", "cart_pendulum", "--trim", "F", "--hold", "x=1"}).err, "exclude"));
  CHECK(contains(expect(2, folder, {"equilibria", "cart_pendulum", "--at", "1"}).err, "--trim"));
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

TEST_CASE("equilibria: the poles of spherical coordinates are searched in a second chart, at rest") {
  const Folder folder;
  const Words at_rest{"equilibria", "P1_spherical_pendulum", "--set", "theta_dot=0", "--set", "phi_dot=0"};
  const Json found = document(folder, at_rest);
  REQUIRE(found["second_charts"].size() == 1);
  const Json& poles = found["second_charts"][0];
  CHECK(poles["of"] == "P");
  CHECK(poles["where"] == "sin(phi) = 0");
  CHECK(poles["skipped"].is_null());
  REQUIRE(poles["points"].size() == 2);  // it hangs, and it stands
  std::size_t stable = 0, unstable = 0;
  for (const Json& point : poles["points"]) {
    stable += point["stable"] == true ? 1 : 0;
    unstable += point["stable"] == false ? 1 : 0;
    double fastest = 0;
    for (const Json& e : point["eigenvalues"])
      fastest = std::max(fastest, std::hypot(e["re"].get<double>(), e["im"].get<double>()));
    CHECK(fastest == doctest::Approx(std::sqrt(9.81)).epsilon(1e-12));
  }
  CHECK(stable == 1);
  CHECK(unstable == 1);
  const std::string text = expect(0, folder, at_rest).out;
  CHECK(contains(text, "the coordinates spherical about E3 of 'P' are singular where sin(phi) = 0: 2 found there"));
  // With momentum about the vertical no start at rest has the held values.
  const Json turning = document(folder, {"equilibria", "P1_spherical_pendulum", "--scene", "conical"});
  REQUIRE(turning["second_charts"].size() == 1);
  CHECK(contains(turning["second_charts"][0]["skipped"].get<std::string>(), "is held at"));
}

TEST_CASE("equilibria: contacts are open at the start and at the points") {
  const Folder folder;
  const auto ball = [](const std::string& floor, const std::string& start) {
    return "format = 1\n[parameters]\nm = \"1 kg\"\ng = \"10 m/s^2\"\nk = \"100 N/m\"\n[[particle]]\nname = \"P\"\n"
           "mass = \"m\"\nposition = \"x*E1\"\n[coordinates]\nx = \"m\"\n[[force]]\ngravity = \"-g*E1\"\n[energy]\n"
           "potential = \"k*x^2/2\"\n[[constraint]]\nname = \"floor\"\nholonomic = \"x " +
           floor +
           "\"\nholds = \"unilateral\"\nrestitution = 0.5\n[scene.default]\nt = [0, 1]\ninitial = { x = " + start +
           " }\n";
  };
  folder.write("low.toml", ball("+ 0.5[m]", "0.2"));
  const Json open = document(folder, {"equilibria", "low.toml"});
  REQUIRE(open["points"].size() == 1);
  CHECK(open["points"][0]["values"]["x"].get<double>() == doctest::Approx(-0.1));
  CHECK(open["open_contacts"] == Json::array({"floor"}));
  CHECK(open["in_contact"] == 0);
  folder.write("high.toml", ball("- 0.05[m]", "0.2"));
  const Json above = document(folder, {"equilibria", "high.toml"});
  CHECK(above["points"].empty());
  CHECK(above["in_contact"] == 1);
  folder.write("closed.toml", ball("- 0.05[m]", "0.05"));
  CHECK(contains(expect(2, folder, {"equilibria", "closed.toml"}).err, "a state at which all contacts are open"));
}

TEST_CASE("equilibria: time-dependent equations, contacts and invalid holds are refused with a remedy") {
  const Folder folder;
  CHECK(contains(expect(2, folder, {"equilibria", "P1_spherical_pendulum_varying"}).err, "eomgen linearize"));
  CHECK(contains(expect(2, folder, {"equilibria", "stick_slip_belt"}).err, "take a copy of the model"));
  CHECK(
      contains(expect(2, folder, {"equilibria", "R10_lagrange_top", "--hold", "thta=1"}).err, "did you mean 'theta'?"));
  CHECK(contains(expect(2, folder, {"equilibria", "R10_lagrange_top", "--hold", "psi=1"}).err, "it is ignorable"));
  CHECK(contains(expect(2, folder, {"equilibria", "S5_double_pendulum", "--hold", "reaction.rod1=1"}).err,
                 "constraint forces"));
  CHECK(contains(expect(2, folder, {"equilibria", "R10_lagrange_top", "--hold", "theta"}).err,
                 "write --hold NAME=VALUE"));
  CHECK(contains(expect(2, folder, {"equilibria", "R10_lagrange_top", "--starts", "0"}).err, "--starts"));
}
