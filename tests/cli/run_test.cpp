// SPDX-License-Identifier: GPL-3.0-or-later
// Options of run: each has its effect and no other.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "program.hpp"
#include "support/elliptic.hpp"
#include "support/particles.hpp"

using namespace eomgen::test;

namespace {

double angle(const Json& run) { return run["final"]["theta"].get<double>(); }

}  // namespace

TEST_CASE("--set changes the motion according to the closed form, with the same code") {
  const Folder folder;
  document(folder, {"run", "P2_planar_pendulum", "--tier", "compiled"});
  for (const double L : {0.5, 1.0, 2.5}) {
    const Json run = document(folder, {"run", "P2_planar_pendulum", "--tier", "compiled", "--set",
                                       "L=" + std::to_string(L), "--rtol", "1e-12"});
    CHECK(run["compiled"] == "from the cache");
    CHECK(angle(run) == doctest::Approx(pendulum_from_rest(1.0, std::sqrt(9.81 / L), 10).angle).epsilon(1e-9));
    CHECK(run["final"]["r"] == L);
  }
}

TEST_CASE("--set takes exact decimals, and the last of two values") {
  const Folder folder;
  const auto length = [&](const std::string& value) {
    return document(folder, {"run", "P2_planar_pendulum", "--set", "L=3", "--set", "L=" + value, "--t-end",
                             "0.1"})["final"]["r"]
        .get<double>();
  };
  CHECK(length("0.1") == 0.1);
  CHECK(length("1e-1") == 0.1);
  CHECK(length("+2.5E+0") == 2.5);
  CHECK(length("0.30000000000000004") == 0.30000000000000004);
}

TEST_CASE("--set takes units of the dimension that the model states") {
  const Folder folder;
  const auto start = [&](const std::string& value) {
    return angle(document(folder, {"run", "P2_planar_pendulum", "--set", value, "--t-end", "0"}));
  };
  CHECK(start("theta=30deg") == doctest::Approx(std::numbers::pi / 6).epsilon(1e-15));
  CHECK(start("theta=-1e1 deg") == doctest::Approx(-std::numbers::pi / 18).epsilon(1e-15));
  const Json run = document(folder, {"run", "P2_planar_pendulum", "--set", "L=50cm", "--t-end", "0.1"});
  CHECK(run["final"]["r"] == 0.5);
  CHECK(contains(expect(2, folder, {"run", "P2_planar_pendulum", "--set", "L=2kg"}).err,
                 "'L' is set in kg, and the model has it in m"));
  CHECK(contains(expect(2, folder, {"run", "P2_planar_pendulum", "--set", "L=2furlong"}).err,
                 "ends with 'furlong', which is no unit"));
}

TEST_CASE("--set without a unit warns where the model states another unit than SI") {
  const Folder folder;
  folder.write("ramp.toml", R"toml(format = 1
[parameters]
alpha = "30 deg"
L = "1 m"
[[particle]]
name = "P"
mass = 1
position = ["s*cos(alpha)", "-s*sin(alpha)", 0]
[coordinates]
s = {}
[[force]]
gravity = "-9.81[m/s^2]*E2"
)toml");
  const ChildResult bare = expect(0, folder, {"run", "ramp.toml", "--set", "alpha=45", "--set", "L=2"});
  CHECK(contains(bare.err, "the model states alpha in deg, and --set takes 45 as rad"));
  CHECK(contains(bare.err, "write --set alpha=45deg"));
  CHECK_FALSE(contains(bare.err, "states L"));
  CHECK_FALSE(contains(expect(0, folder, {"run", "ramp.toml", "--set", "alpha=45deg"}).err, "takes 45"));
}

TEST_CASE("--t-end, --rtol, --scene") {
  const Folder folder;
  const Json half = document(folder, {"run", "P2_planar_pendulum", "--t-end", "0.5"});
  CHECK(half["t"] == 0.5);
  const Json coarse = document(folder, {"run", "P2_planar_pendulum", "--rtol", "1e-3"});
  CHECK(coarse["solver"] == "dopri5");
  CHECK(coarse["rhs_evaluations"].get<int>() <
        document(folder, {"run", "P2_planar_pendulum", "--rtol", "1e-11"})["rhs_evaluations"].get<int>());
  folder.write(
      "two.toml",
      pendulum_text("[scene.default]\nt = [0, 1]\ninitial = { x = 1, y = 0, x_dot = 0 }\n"
                    "[scene.long_rod]\nt = [0, 2]\nparameters = { L = 2 }\ninitial = { x = 0, y = -2, y_dot = 0 }\n"));
  CHECK(document(folder, {"run", "two.toml", "--tier", "compiled"})["t"] == 1.0);
  const Json other = document(folder, {"run", "two.toml", "--tier", "compiled", "--scene", "long_rod"});
  CHECK(other["scene"] == "long_rod");
  CHECK(other["t"] == 2.0);
  CHECK(other["final"]["y"].get<double>() == doctest::Approx(-2));
  CHECK(other["compiled"] == "from the cache");  // all scenes use the same code
}

TEST_CASE("--max-steps ends a run with a remedy") {
  const Folder folder;
  const Json reply = document(folder, {"run", "P2_planar_pendulum", "--max-steps", "20"}, 3);
  CHECK(reply["outcome"] == "max_steps");
  CHECK(reply["steps"].get<int>() + reply["rejected"].get<int>() == 20);
  CHECK(contains(reply["detail"].get<std::string>(), "--max-steps"));
  expect(2, folder, {"run", "P2_planar_pendulum", "--max-steps", "0"});
}

TEST_CASE("all listed solvers run and agree") {
  const Folder folder;
  const double expected = pendulum_from_rest(1.0, std::sqrt(9.81), 10).angle;
  const Json listed = document(folder, {"list"});
  for (const Json& solver : listed["solvers"]) {
    const std::string name = solver["name"].get<std::string>();
    if (solver["constrained"].get<bool>()) continue;  // this model has no constraint for it
    CAPTURE(name);
    Words words{"run", "P2_planar_pendulum", "--solver", name};
    const bool adaptive = solver["adaptive"].get<bool>();
    if (!adaptive) words.insert(words.end(), {"--step", "0.001"});
    const Json run = document(folder, words);
    CHECK(run["solver"] == name);
    CHECK(run["solver_reason"].get<std::string>().starts_with("as asked for"));
    const double bound = solver["order"] == 2 ? 1e-4 : 1e-6;  // steps of 1e-3 over ten seconds: 10 times their square
    CHECK(std::abs(angle(run) - expected) < bound);
    CHECK(run["error_estimate"]["theta"].get<double>() < bound);
    if (!adaptive) CHECK(run["steps"] == 10000);
  }
}

TEST_CASE("a step without a solver selects rk4; a step with an adaptive solver keeps it") {
  const Folder folder;
  const Json run = document(folder, {"run", "P2_planar_pendulum", "--step", "0.01"});
  CHECK(run["solver"] == "rk4");
  CHECK(run["steps"] == 1000);
  CHECK(document(folder, {"run", "P2_planar_pendulum", "--step", "0.01", "--solver", "dop853"})["steps"] == 1000);
}

TEST_CASE("--seed does not change a run; verify uses other points") {
  const Folder folder;
  const Json one = document(folder, {"run", "S5_double_pendulum", "--seed", "1"});
  CHECK(one["final"] == document(folder, {"run", "S5_double_pendulum", "--seed", "1"})["final"]);
  CHECK(one["final"] == document(folder, {"run", "S5_double_pendulum", "--seed", "2"})["final"]);
  const auto formulations = [&](const char* seed) {
    return document(folder,
                    {"verify", "S5_double_pendulum", "--points", "3", "--no-compile", "--seed", seed})["formulations"];
  };
  CHECK(formulations("7") == formulations("7"));
  CHECK(formulations("7") != formulations("8"));
}

TEST_CASE("--approach: I and II are the same motion") {
  const Folder folder;
  for (const char* model : {"P7_moving_sphere", "P2_planar_pendulum"}) {
    const Json one = document(folder, {"run", model, "--approach", "I"});
    const Json two = document(folder, {"run", model, "--approach", "II"});
    CHECK(one["approach"] == "I");
    CHECK(two["approach"] == "II");
    for (const auto& [name, value] : one["final"].items()) {
      const auto& shown = name;
      CAPTURE(shown);
      CHECK(std::abs(value.get<double>() - two["final"][name].get<double>()) < 1e-6);
    }
  }
}

TEST_CASE("the error estimate bounds the error against a much tighter run, within its factor") {
  const Folder folder;
  const double exact = pendulum_from_rest(1.0, std::sqrt(9.81), 10).angle;
  for (const char* rtol : {"1e-5", "1e-8"}) {
    const Json run = document(folder, {"run", "P2_planar_pendulum", "--rtol", rtol, "--atol", rtol});
    const double error = std::abs(angle(run) - exact), estimate = run["error_estimate"]["theta"].get<double>();
    CHECK(estimate > error / 10);
    CHECK(estimate < error * 10);
  }
}

TEST_CASE("--estimate full compares with tighter runs, however many steps they need") {
  const Folder folder;
  // On its smooth solution, where rounding of the spring's force exceeds the tighter tolerances.
  folder.write("spring.toml",
               "format = 1\n[parameters]\nm = \"1 kg\"\nk = \"1e8 N/m\"\nl = \"1 m\"\ng = \"9.81 "
               "m/s^2\"\n[coordinates]\nr = \"m\"\n"
               "th = \"rad\"\n[energy]\nkinetic = \"m/2*(r_dot^2 + r^2*th_dot^2)\"\n"
               "potential = \"k/2*(r - l)^2 - m*g*r*cos(th)\"\n[scene.default]\nt = [0, 0.1]\n"
               "initial = { th = 1, r = \"l + m*g/k*cos(1)\" }\nrtol = 1e-12\natol = 1e-12\n");
  const Json bounded = document(folder, {"run", "spring.toml"}),
             full = document(folder, {"run", "spring.toml", "--estimate", "full"});
  CHECK(bounded["error_estimate_by_looser_run"] == true);
  CHECK(full["error_estimate_by_looser_run"] == false);
  CHECK(bounded["final"] == full["final"]);
  CHECK(bounded["error_estimate_rhs_evaluations"].get<double>() < 4 * bounded["rhs_evaluations"].get<double>());
  CHECK(full["error_estimate_rhs_evaluations"] > bounded["error_estimate_rhs_evaluations"]);
  CHECK(contains(expect(0, folder, {"run", "spring.toml"}).out, "by a run at ten times the tolerances"));
  CHECK(contains(expect(2, folder, {"run", "spring.toml", "--estimate", "ful"}).err, "did you mean 'full'"));
  for (const Words& words : {Words{"run", "spring.toml", "--no-error-estimate"},
                             Words{"sweep", "spring.toml", "--grid", "m=1:2:2", "--ensemble"}}) {
    Words both = words;
    both.insert(both.end(), {"--estimate", "full"});
    CHECK(contains(expect(2, folder, both).err, "the estimate 'full' asks for an error estimate"));
  }
}

TEST_CASE("run: the constraint force on a particle is mass times acceleration minus the applied forces") {
  const Folder folder;
  const double m = 2, g = 9.81;
  for (const char* constraint : {"holonomic = \"y - x^2\"", "velocity = \"y_dot - x*x_dot\""}) {
    CAPTURE(constraint);
    folder.write("wire.toml", "format = 1\n[parameters]\nm = 2\ng = 9.81\n" + particle_in_plane +
                                  "[[constraint]]\nname = \"wire\"\n" + constraint +
                                  "\n[scene.default]\ninitial = { x = 1, x_dot = 2 }\noutputs = [\"all\"]\n");
    const Json found = document(folder, {"run", "wire.toml", "--t-end", "0"})["final"];
    const auto value = [&found](const char* name) { return found[name].get<double>(); };
    CHECK(value("P.constraint_force1") == doctest::Approx(m * value("x_ddot")));
    CHECK(value("P.constraint_force2") == doctest::Approx(m * (value("y_ddot") + g)));
  }
  // Two particles on rods: the second one has coordinates of its own, and hangs on the first.
  const Json rods =
      document(folder, {"run", "S5_double_pendulum", "--t-end", "0", "--output", "P2.constraint_force,reaction.rod2"});
  const double tension = rods["final"]["reaction.rod2"];
  CHECK(rods["final"]["P2.constraint_force1"].get<double>() == doctest::Approx(tension * std::cos(0.4)));
  CHECK(rods["final"]["P2.constraint_force2"].get<double>() == doctest::Approx(tension * std::sin(0.4)));
  CHECK(rods["final"]["P2.constraint_force3"] == 0);
  // The same coordinates move both particles, so that the motion does not tell how they share the force.
  folder.write("shared.toml",
               "format = 1\n[coordinates]\nx = {}\ny = {}\n[[particle]]\nname = \"A\"\nmass = 1\nposition = [\"x\", "
               "\"y\", 0]\n[[particle]]\nname = \"B\"\nmass = 1\nposition = [\"-x\", \"y\", 1]\n[[constraint]]\nname = "
               "\"wire\"\nholonomic = \"y - x^2\"\n");
  CHECK(contains(expect(2, folder, {"run", "shared.toml", "--output", "A.constraint_force"}).err,
                 "there is no output 'A.constraint_force'"));
}
