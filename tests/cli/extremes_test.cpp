// SPDX-License-Identifier: GPL-3.0-or-later
// Time scales and values far from 1: series with a radius of convergence of 1e-80 s, periods of 1e-16 s, exponentials
// of exponentials, steps that shrink towards a singularity.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

namespace {

std::string diode(double voltage) {
  return "format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n[[state]]\nname = \"v\"\nrate = "
         "\"(12*sin(314*t) - v)/1e-4 - 1e-6*(exp(v/0.025) - 1)\"\n[[force]]\ngeneralized = { x = \"0.001*v - x\" }\n"
         "[scene.default]\nt = [0, 1e-3]\ninitial = { v = " +
         std::to_string(voltage) + " }\n";
}

std::string exponentials(const std::string& potential, double x) {
  return "format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = \"" + potential +
         "\"\n[scene.default]\ninitial = { x = " + std::to_string(x) + " }\n";
}

}  // namespace

TEST_CASE("verify: the series of fast exponentials satisfies the equations") {
  const Folder folder;
  for (const std::string& text :
       {diode(1), diode(5), diode(20), exponentials("exp(exp(x))", 3), exponentials("0.3*tanh((x - 3)/1e-9)", 1)}) {
    CAPTURE(text);
    folder.write("model.toml", text);
    expect(0, folder, {"verify", "model.toml", "--points", "3"});
  }
}

TEST_CASE("verify: exponentials of exponentials end at once") {
  const Folder folder;
  for (const double x : {1.0, 2.0, 3.0}) {
    folder.write("model.toml", exponentials("exp(exp(exp(exp(x))))", x));
    const std::string error = expect(1, folder, {"verify", "model.toml"}).err;
    CHECK(contains(error, "no states were found"));
  }
}

// A circle of radius r about a fixed centre: 10.25 revolutions end at (0, r).
TEST_CASE("run: the Taylor method follows a period of 1e-16 s, whose coefficients of high order overflow") {
  const Folder folder;
  folder.write("model.toml",
               "format = 1\n[parameters]\nGM = \"253.2638 m^3/s^2\"\nr = \"5.29e-11 m\"\n[[particle]]\nname = \"P\"\n"
               "mass = \"9.109e-31 kg\"\nposition = { cartesian = [\"x\", \"y\"] }\n[[force]]\ncentral_gravity = { GM "
               "= \"GM\" }\n[scene.default]\nt = [0, \"10.25*2*pi*sqrt(r^3/GM)\"]\ninitial = { x = \"r\", y = 0, y_dot "
               "= \"sqrt(GM/r)\" }\n");
  const Json run = document(folder, {"run", "model.toml", "--solver", "taylor", "--atol", "1e-22"});
  CHECK(run["outcome"] == "done");
  const double r = 5.29e-11;
  CHECK(std::abs(run["final"]["x"].get<double>()) < 1e-7 * r);
  CHECK(std::abs(run["final"]["y"].get<double>() - r) < 1e-7 * r);
}

// The foot of a ball that has rolled off a log, written as z = f(x), approaches the edge x = S, where f ends.
TEST_CASE("run: steps that become ever shorter end the run, with the time") {
  const Folder folder;
  folder.write(
      "model.toml",
      "format = 1\n[parameters]\nm = 1\nR = 0.1\nS = 0.5\n[[body]]\nname = \"B\"\nmass = \"m\"\ninertia = { "
      "sphere = \"R\" }\nposition = { cartesian = [\"x\", \"0\", \"z\"] }\nrotation = { axis = \"E2\", angle = "
      "\"q\" }\n[[force]]\ngravity = \"-9.81*E3\"\n[[contact]]\nname = \"c\"\nbody = \"B\"\nshape = { sphere = "
      "\"R\" }\non = { surface = \"sqrt(S^2 - x^2)\" }\n[scene.default]\nt = [0, 1.5]\ninitial = { x = "
      "\"(R + S)*sin(0.1)\", z = \"(R + S)*cos(0.1)\" }\n");
  const ChildResult result = expect(3, folder, {"run", "model.toml"});
  CHECK(contains(result.out, "step_too_small"));
  CHECK(contains(result.out, "ever shorter"));
}
