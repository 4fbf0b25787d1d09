// SPDX-License-Identifier: GPL-3.0-or-later
// Velocity constraints from the command line: output of check, inconsistent starts, kinds in emitted code.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

namespace {

std::string skate(const std::string& scene) {
  return R"toml(format = 1
[coordinates]
x = {}
y = {}
theta = {}
[energy]
kinetic = "x_dot^2 + y_dot^2 + theta_dot^2"
[[constraint]]
name = "edge"
velocity = "x_dot*sin(theta) - y_dot*cos(theta)"
[scene.default]
t = [0, 0.2]
)toml" + scene;
}

}  // namespace

TEST_CASE("check reports the kind of a constraint, its integrability with the reason, and its integral") {
  const Folder folder;
  const Json constraints = document(folder, {"check", "P12_pfaffian_set"})["constraints"];
  REQUIRE(constraints.size() == 3);
  for (const Json& c : constraints) {
    CHECK(c["kind"] == "velocity");
    CHECK(c["redundant"] == false);
    CHECK_FALSE(c["reason"].get<std::string>().empty());
  }
  CHECK(constraints[0]["integrable"] == "yes");
  CHECK(constraints[0]["integral"] == "1/2 (x1^2 + y1^2 + 2 h0 sin(w t)/w) = constant");
  CHECK(constraints[0]["integral_of"] == Json{"first"});
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
    CHECK(constraints[k]["integrable"] == "no");
    CHECK(constraints[k]["integral"].is_null());
  }
  const ChildResult readable = expect(0, folder, {"check", "P12_pfaffian_set"});
  CHECK(contains(readable.out, "integrable: no (Frobenius' condition fails"));
}

TEST_CASE("derive shows the constraint, the verdict and the integral") {
  const Folder folder;
  const Json shown = document(folder, {"derive", "P12_pfaffian_set", "--show", "constraints"})["constraints"];
  const auto has = [&](const char* role, const char* text) {
    return std::any_of(shown.begin(), shown.end(),
                       [&](const Json& item) { return item["role"] == role && item["text"] == text; });
  };
  CHECK(has("binds velocities, integrable", "x1 x1_dot + y1 y1_dot + h = 0"));
  CHECK(has("its integral", "d/dt(1/2 (x1^2 + y1^2 + 2 h0 sin(w t)/w)) = 0"));
  CHECK(has("binds velocities, not integrable", "y2_dot + (z2/l0) x2_dot = 0"));
}

TEST_CASE("a start that violates a velocity constraint is refused, unless a velocity may be adjusted") {
  const Folder folder;
  folder.write("skate.toml", skate("initial = { theta = 0.5, x_dot = 1, y_dot = 1 }\n"));
  const ChildResult refused = expect(2, folder, {"run", "skate.toml"});
  CHECK(contains(refused.err, "the start breaks constraint 'edge': it is off by "));
  CHECK(contains(refused.err, "solve = [one of \"x_dot\", \"y_dot\"]"));
  folder.write("skate.toml", skate("initial = { theta = 0.5, x_dot = 1, y_dot = 1 }\nsolve = [\"y_dot\"]\n"));
  const Json run = document(folder, {"run", "skate.toml"});
  CHECK(run["final"]["y_dot"].get<double>() == doctest::Approx(std::tan(0.5)).epsilon(1e-12));
  folder.write("skate.toml", skate("initial = { theta = 0.5, theta_dot = 1 }\n"));  // at rest along the blade
  CHECK(document(folder, {"run", "skate.toml"})["final"]["x"] == 0.0);
}

TEST_CASE("emitted code states which of its constraints are on velocities") {
  const Folder folder;
  folder.write("skate.toml", skate(""));
  expect(0, folder, {"emit", "skate.toml", "-o", "out", "--with", "constraints,mass"});
  CHECK(contains(folder.read("out/skate.c"), "\\\"constraint_kinds\\\":[\\\"velocity\\\"]"));
}
