// SPDX-License-Identifier: GPL-3.0-or-later
// Command inverse: table against closed forms, document, refusals.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

namespace {

constexpr double tolerance = 1e-8;  // a run of one second at the default rtol of 1e-9

// A pendulum whose angle `drive` prescribes; the rod is a separate constraint.
std::string driven(const std::string& drive) {
  return "format = 1\n[parameters]\nm = 2\nL = 0.5\ng = 9.81\n[functions]\ndrive = \"0.3*sin(2*t)\"\n"
         "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cylindrical = [\"r\", \"theta\"] }\n"
         "[[force]]\ngravity = \"g*E1\"\n[[constraint]]\nname = \"rod\"\nholonomic = \"r - L\"\n" +
         drive + "[scene.default]\nt = [0, 1]\nevery = 0.25\n";
}

const char* const motor = "[[constraint]]\nname = \"motor\"\nholonomic = \"theta - drive\"\n";

}  // namespace

TEST_CASE("inverse: the moment of a fully prescribed pendulum is m L^2 theta_ddot + m g L sin(theta)") {
  const Folder folder;
  folder.write("driven.toml", driven(motor));
  const Json found = document(folder, {"inverse", "driven.toml", "--constraint", "motor"});
  CHECK(found["file"] == "driven_inverse.csv");
  CHECK(found["outcome"] == "done");
  const Table table = read_table(folder.read("driven_inverse.csv"));
  CHECK(found["columns"].get<Words>() == table.columns);
  CHECK(table.columns == Words{"t", "r", "r_dot", "theta", "theta_dot", "force.theta", "P.force1", "P.force2",
                               "P.force3", "prescribed.power", "reaction.motor"});
  REQUIRE(table.rows.size() == 5);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double t = table.rows[i][0], theta = 0.3 * std::sin(2 * t);
    const double moment = 2 * 0.25 * (-1.2 * std::sin(2 * t)) + 2 * 9.81 * 0.5 * std::sin(theta);
    CHECK(table.at(i, "force.theta") == doctest::Approx(moment).epsilon(1e-13));
    CHECK(table.at(i, "P.force2") == doctest::Approx(moment / 0.5 * std::cos(theta)).epsilon(1e-13));
    CHECK(table.at(i, "prescribed.power") == doctest::Approx(moment * 0.6 * std::cos(2 * t)).epsilon(1e-13));
  }
  // By default the rod is included: then the force on P is the total force except gravity.
  expect(0, folder, {"inverse", "driven.toml", "--out", "all.csv", "--every", "0.5"});
  const Table all = read_table(folder.read("all.csv"));
  REQUIRE(all.rows.size() == 3);
  const double theta_ddot = -1.2 * std::sin(1.0), theta_dot = 0.6 * std::cos(1.0), theta = 0.3 * std::sin(1.0);
  const double radial = -2 * 0.5 * theta_dot * theta_dot, across = 2 * 0.5 * theta_ddot;
  CHECK(all.at(1, "P.force1") ==
        doctest::Approx(radial * std::cos(theta) - across * std::sin(theta) - 2 * 9.81).epsilon(1e-13));
  CHECK(all.at(1, "P.force2") == doctest::Approx(radial * std::sin(theta) + across * std::cos(theta)).epsilon(1e-13));
}

TEST_CASE("inverse: free coordinates move, and the forces are those along their motion") {
  const Folder folder;
  folder.write("free.toml", driven("") + "initial = { theta = 0.4 }\n");
  const Json found = document(folder, {"inverse", "free.toml", "--rtol", "1e-11", "--t-end", "2"});
  const Table table = read_table(folder.read(found["file"].get<std::string>()));
  REQUIRE(table.rows.size() == 9);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double theta = table.at(i, "theta"), rate = table.at(i, "theta_dot");
    CHECK(table.at(i, "force.r") ==
          doctest::Approx(-2 * 0.5 * rate * rate - 2 * 9.81 * std::cos(theta)).epsilon(1e-12));
    CHECK(rate * rate ==
          doctest::Approx(2 * 9.81 / 0.5 * (std::cos(theta) - std::cos(0.4))).epsilon(tolerance).scale(1));
  }
}

TEST_CASE("inverse: a prescribed motion may contain an integral without closed form") {
  const Folder folder;
  std::string text = driven(motor);  // theta = integral of exp(-t^2) = sqrt(pi)/2 erf(t)
  text.replace(text.find("0.3*sin(2*t)"), 12, "integral(exp(-t^2))");
  folder.write("erf.toml", text);
  expect(0, folder, {"inverse", "erf.toml", "--rtol", "1e-12", "--atol", "1e-14"});
  const Table table = read_table(folder.read("erf_inverse.csv"));
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double t = table.rows[i][0], theta = std::sqrt(std::acos(-1.0)) / 2 * std::erf(t);
    CHECK(table.at(i, "theta") == doctest::Approx(theta).epsilon(1e-11).scale(1));
    const double moment = 2 * 0.25 * (-2 * t * std::exp(-t * t)) + 2 * 9.81 * 0.5 * std::sin(theta);
    CHECK(table.at(i, "force.theta") == doctest::Approx(moment).epsilon(1e-11).scale(1));
  }
}

TEST_CASE("inverse: models without prescribed motion, unknown constraints and unwritable paths are reported") {
  const Folder folder;
  CHECK(contains(expect(2, folder, {"inverse", "P14_kepler_spherical"}).err,
                 "no constraint of this model prescribes a motion"));
  CHECK(contains(expect(2, folder, {"inverse", "P10_rocket", "--constraint", "radail"}).err, "did you mean 'radial'?"));
  CHECK(contains(expect(2, folder, {"inverse", "P10_rocket", "--out", "no/such/folder/a.csv"}).err, "no/such/folder"));
  CHECK(contains(expect(2, folder, {"inverse", "P10_rocket", "--set", "x"}).err, "sets nothing"));
  CHECK(contains(expect(2, folder, {"run", "P10_rocket"}).err, "eomgen inverse"));
  CHECK(folder.names().empty());
}

TEST_CASE("inverse: friction of a driven block counts beside free coordinates, and there is none at rest") {
  const Folder folder;
  const auto block = [](const std::string& pendulum, const std::string& law) {
    return "format = 1\n[parameters]\nM = 2\nm = 1\ng = 9.81\n[coordinates]\nth = \"rad\"\n[functions]\n"
           "f = \"0.5*sin(2*t)\"\n[[particle]]\nname = \"B\"\nmass = \"M\"\nposition = { cartesian = [\"x\", \"y\", "
           "\"z\"] }\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = " +
           pendulum +
           "\n[[force]]\ngravity = \"-g*E3\"\n[[constraint]]\nname = \"floor\"\nholonomic = \"z\"\nfriction = { " +
           law +
           " }\n[[constraint]]\nname = \"drive\"\nholonomic = \"x - f\"\n[[constraint]]\nname = \"rail\"\nholonomic = "
           "\"y\"\n[scene.default]\nt = [0, 2]\nevery = 0.25\ninitial = { th = 0.4 }\n";
  };
  const char* const coulomb = "static = 0.4, dynamic = 0.3";
  folder.write("beside.toml", block("[\"sin(th)\", 0, \"-cos(th)\"]", coulomb));
  const Json found = document(folder, {"inverse", "beside.toml"});
  CHECK(found["outcome"] == "done");
  const Table beside = read_table(folder.read("beside_inverse.csv"));
  REQUIRE(beside.rows.size() == 9);
  for (std::size_t i = 0; i < beside.rows.size(); ++i) {
    const double t = beside.rows[i][0], rub = 0.3 * 2 * 9.81 * (std::cos(2 * t) > 0 ? 1 : -1);
    CHECK(beside.at(i, "force.x") == doctest::Approx(2 * -2 * std::sin(2 * t) + rub).epsilon(1e-12));
  }
  // A pendulum that hangs from the block changes its normal force.
  const char* const hung = "[\"x + sin(th)\", \"y\", \"z - cos(th)\"]";
  folder.write("hung.toml", block(hung, coulomb));
  folder.write("smooth.toml", block(hung, "dynamic = 0.3, law = \"smooth\", width = 1e-9"));
  for (const char* name : {"hung", "smooth"}) expect(0, folder, {"inverse", std::string(name) + ".toml"});
  const Table of_block = read_table(folder.read("hung_inverse.csv")),
              smooth = read_table(folder.read("smooth_inverse.csv"));
  for (std::size_t i = 0; i < of_block.rows.size(); ++i)
    CHECK(of_block.at(i, "force.x") == doctest::Approx(smooth.at(i, "force.x")).epsilon(1e-7));
  // It starts at rest, where friction is not determined.
  std::string rest = block(hung, coulomb);
  rest.replace(rest.find("0.5*sin(2*t)"), 12, "0.5*t^2");
  folder.write("rest.toml", rest);
  CHECK(document(folder, {"inverse", "rest.toml"})["outcome"] == "done");
  const Table from_rest = read_table(folder.read("rest_inverse.csv"));
  const double s = std::sin(0.4), c = std::cos(0.4);  // the pendulum at rest: th_ddot = -(f'' cos + g sin)
  CHECK(from_rest.at(0, "force.x") == doctest::Approx(3 - c * (c + 9.81 * s)).epsilon(1e-12));
}
