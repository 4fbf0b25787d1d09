// SPDX-License-Identifier: GPL-3.0-or-later
// Use of emitted sources in other projects: compiled with all warnings as errors, called from C and C++.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

namespace {

const Words warnings{"-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror"};

void compile(const Folder& folder, Words words) {
  words.insert(words.end(), warnings.begin(), warnings.end());
  const ChildResult result = run_child({words, folder.path()});
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
}

/// Output of a program in `folder`, parsed as JSON.
Json printed(const Folder& folder, const std::string& program) {
  const ChildResult result = run_child({{folder / program}, folder.path()});
  REQUIRE(result.status == 0);
  CAPTURE(result.out);
  return Json::parse(result.out);
}

// States, self test, metadata, and the right-hand side at the defaults, as one JSON document.
std::string c_caller(const std::string& name) {
  std::string text = R"(#include <stdio.h>
#include "NAME.h"
int main(void)
{
  double x[64], p[64], dx[64];
  int status;
  NAME_defaults(x, p);
  status = NAME_rhs(0.0, x, p, NULL, 0, dx);
  printf("{\"abi\": %d, \"selftest\": %d, \"status\": %d, \"x\": [%.17g, %.17g], \"dx\": [%.17g, %.17g], \"info\": %s}\n",
         NAME_abi(), NAME_selftest(), status, x[0], x[1], dx[0], dx[1], NAME_info());
  return 0;
}
)";
  for (std::size_t at; (at = text.find("NAME")) != std::string::npos;) text.replace(at, 4, name);
  return text;
}

}  // namespace

TEST_CASE("C: every shipped model compiles as strict C11, passes its self test, and describes itself") {
  const Folder folder;
  for (const char* model :
       {"P2_planar_pendulum", "P7_moving_sphere", "P14_kepler_spherical", "S5_double_pendulum_cartesian",
        "S5_spherical_double_pendulum", "cart_pendulum", "bilinear_oscillator", "leaving_sphere"}) {
    const std::string name = model;
    CAPTURE(name);
    expect(0, folder,
           {"emit", name, "-o", ".", "--with", "jac,jac_p,mass,constraints,reactions,events", "--output", "energy"});
    folder.write("caller.c", c_caller(name));
    compile(folder, {"gcc", "-std=c11", "-o", "caller", "caller.c", name + ".c", "-lm"});
    const Json all = printed(folder, "caller");
    CHECK(all["abi"] == 2);
    CHECK(all["selftest"] == 0);
    CHECK(all["status"] == 0);
    for (const char* key : {"model", "content_hash", "states", "parameters", "inputs", "outputs", "modes", "units",
                            "defaults", "verdict"}) {
      CAPTURE(key);
      CHECK(all["info"].contains(key));
    }
    CHECK(all["info"]["model"] == name);
    CHECK(all["info"]["verdict"].get<std::string>().starts_with("pass"));
    CHECK(all["info"]["outputs"] == Json({"energy"}));
    // The right-hand side starts with the rates.
    const std::size_t half = all["info"]["states"].size() / 2;
    if (half == 1) CHECK(all["dx"][0] == all["x"][1]);
  }
}

TEST_CASE("C: the pendulum's acceleration is -g/L sin(theta)") {
  const Folder folder;
  expect(0, folder, {"emit", "P2_planar_pendulum", "-o", "."});
  folder.write("caller.c", c_caller("P2_planar_pendulum"));
  compile(folder, {"gcc", "-std=c11", "-o", "caller", "caller.c", "P2_planar_pendulum.c", "-lm"});
  const Json all = printed(folder, "caller");
  CHECK(all["info"]["states"] == Json({"theta", "theta_dot"}));
  CHECK(all["x"] == Json({1.0, 0.0}));
  CHECK(all["dx"][1].get<double>() == doctest::Approx(-9.81 * std::sin(1.0)).epsilon(1e-15));
}

TEST_CASE("C++: the header alone gives the same results, in float and double") {
  const Folder folder;
  expect(0, folder, {"emit", "P2_planar_pendulum", "-o", ".", "--with", "jac"});
  folder.write("caller.cpp", R"(#include <cmath>
#include <cstdio>

#include "P2_planar_pendulum.hpp"

template <typename Real>
double acceleration() {
  const Real x[] = {Real(0.5), Real(2)}, p[] = {Real(1), Real(9.81), Real(2)};
  Real dx[2];
  const int status = eom::P2_planar_pendulum::rhs<Real>(Real(0), x, p, nullptr, 0, dx);
  return status == 0 ? static_cast<double>(dx[1]) : 1e300;
}

int main() {
  const double expected = -9.81 / 2 * std::sin(0.5);
  std::printf("{\"double\": %.17g, \"float\": %.17g, \"expected\": %.17g}\n", acceleration<double>(), acceleration<float>(), expected);
}
)");
  compile(folder, {"g++", "-std=c++20", "-o", "caller", "caller.cpp"});
  const Json all = printed(folder, "caller");
  CHECK(all["double"].get<double>() == doctest::Approx(all["expected"].get<double>()).epsilon(1e-15));
  CHECK(all["float"].get<double>() == doctest::Approx(all["expected"].get<double>()).epsilon(1e-6));
}

TEST_CASE("C: an independent integration of the emitted right-hand side gives the rows of run") {
  const Folder folder;
  expect(0, folder, {"emit", "P7_moving_sphere", "-o", "."});
  // Classical Runge-Kutta method, from the defaults to t = 1.
  folder.write("caller.c", R"(#include <stdio.h>
#include "P7_moving_sphere.h"
static void f(double t, const double* x, const double* p, double* dx) { (void)P7_moving_sphere_rhs(t, x, p, NULL, 0, dx); }
int main(void)
{
  double x[4], p[8], k[4][4], y[4];
  const double h = 1e-3;
  P7_moving_sphere_defaults(x, p);
  for (int n = 0; n < 1000; ++n) {
    const double t = n * h;
    f(t, x, p, k[0]);
    for (int s = 1; s < 4; ++s) {
      const double c = s == 3 ? h : h / 2;
      for (int i = 0; i < 4; ++i) y[i] = x[i] + c * k[s - 1][i];
      f(t + c, y, p, k[s]);
    }
    for (int i = 0; i < 4; ++i) x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
  }
  printf("[%.17g, %.17g, %.17g, %.17g]\n", x[0], x[1], x[2], x[3]);
  return 0;
}
)");
  compile(folder, {"gcc", "-std=c11", "-O1", "-o", "caller", "caller.c", "P7_moving_sphere.c", "-lm"});
  const Json by_hand = printed(folder, "caller");
  const Json final = document(folder, {"run", "P7_moving_sphere", "--t-end", "1", "--rtol", "1e-12"})["final"];
  const Words names{"phi", "theta", "phi_dot", "theta_dot"};
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(by_hand[i].get<double>() == doctest::Approx(final[names[i]].get<double>()).epsilon(1e-9));
}

namespace {

/// A floating base with two legs whose links are in another order than their coordinates, and a second tree.
std::string two_trees() {
  std::string text = R"toml(format = 1
[parameters]
m = 2
g = 9.81
L = 0.7
A = 0.3
B = 0.4
C = 0.5
D = 0.1
[coordinates]
q9 = "rad"
z = "m"
x = "m"
[[force]]
gravity = "-g*E3"
[[force]]
generalized = { q4 = "-A*q4_dot", x = "-B*x" }
)toml";
  const auto body = [&text](const char* name, const char* position, const std::string& rotation, const char* parent) {
    text += std::string("[[body]]\nname = \"") + name +
            "\"\nmass = \"m\"\ninertia = [[\"A\", \"D\", 0], [\"D\", \"B\", 0], [0, 0, \"C\"]]\nposition = \"" +
            position + "\"\nrotation = { " + rotation + " }\n" +
            (*parent == 0 ? "" : "relative_to = \"" + std::string(parent) + "\"\n");
  };
  const auto pin = [](const char* axis, const char* angle) {
    return "axis = \"" + std::string(axis) + "\", angle = \"" + angle + "\"";
  };
  body("b1", "x*E1 + z*E3 + L*b1.e3", R"(euler = "321", angles = ["a", "b", "c"])", "");
  body("b2", "b1 + L*b1.e1 + L*b2.e1", pin("b1.e2", "q2"), "b1");
  body("b3", "b1 - L*b1.e1 + L*b3.e3", pin("b1.e1", "q3"), "b1");
  body("b4", "b2 + L*b2.e1 + L*b4.e1", pin("b2.e3", "q4"), "b2");
  body("b5", "b3 + L*b3.e1 + L*b5.e2", pin("b3.e2", "q5"), "b3");
  body("b6", "b3 - L*b3.e1 + L*b6.e1", pin("b3.e3", "q6"), "b3");
  body("b7", "b5 + L*b5.e1 + L*b7.e2", pin("b5.e1", "q7"), "b5");
  body("c1", "3*E1 + L*c1.e1", pin("E2", "q8"), "");
  body("c2", "c1 + L*c1.e1 + L*c2.e3", pin("c1.e1", "q9"), "c1");
  return text;
}

}  // namespace

TEST_CASE("C and C++: the Jacobian of large trees has loops, and is that of the straight-line code") {
  const Folder folder;
  folder.write("trees.toml", two_trees());
  document(folder, {"emit", "trees.toml", "-o", ".", "--with", "jac"});
  folder.write("caller.c", c_caller("trees"));
  compile(folder, {"gcc", "-std=c11", "-O1", "-o", "caller", "caller.c", "trees.c", "-lm"});
  const Json all = printed(folder, "caller");
  CHECK(all["info"]["operations"]["jac"]["loops"]["in_loops"] > 1000);
  CHECK(all["selftest"] == 0);
  folder.write("templates.cpp", "#include \"trees.hpp\"\nint main() { return eom::trees::selftest(); }\n");
  compile(folder, {"g++", "-std=c++20", "-O1", "-o", "templates", "templates.cpp"});
  CHECK(run_child({{folder / "templates"}, folder.path()}).status == 0);
}

TEST_CASE("--fix: a parameter becomes a number, and the array of parameters keeps its size") {
  const Folder folder;
  const Json fixed = document(folder, {"emit", "P7_moving_sphere", "-o", ".", "--fix", "m,g,D"});
  const Json open = document(folder, {"emit", "P7_moving_sphere", "-o", "open"});
  CHECK(fixed["operations"]["mul"].get<int>() <= open["operations"]["mul"].get<int>());
  folder.write("caller.c", c_caller("P7_moving_sphere"));
  compile(folder, {"gcc", "-std=c11", "-o", "caller", "caller.c", "P7_moving_sphere.c", "-lm"});
  const Json all = printed(folder, "caller");
  CHECK(all["selftest"] == 0);
  CHECK(all["info"]["parameters"].size() == 6);
}

TEST_CASE("--fix: the times of samples become numbers, or are refused where another parameter decides them too") {
  const Folder folder;
  folder.write("sampled.toml", R"toml(format = 1
[parameters]
T = 0.25
share = 0.5
[discrete]
n = 0
[coordinates]
x = {}
[[particle]]
name = "P"
mass = 1
position = "x*E1"
[[force]]
on = "P"
force = "(n - x)*E1"
[[sample]]
every = "T"
offset = "share*T"
set = { n = "n + 1" }
[scene.default]
t = [0, 1]
)toml");
  const auto emitted = [&](const Words& fix) {
    Words words{"emit", "sampled.toml", "-o", ".", "--target", "c", "--with", "run"};
    words.insert(words.end(), fix.begin(), fix.end());
    expect(0, folder, words);
    return std::pair{folder.read("sampled_run.hpp"), folder.read("sampled.c")};
  };
  const auto open = emitted({});
  CHECK(contains(open.first, "Op::parameter"));
  CHECK(contains(open.second, "every_formula"));
  const auto fixed = emitted({"--fix", "T,share"});
  CHECK_FALSE(contains(fixed.first, "Op::parameter"));
  CHECK_FALSE(contains(fixed.second, "every_formula"));
  CHECK_FALSE(contains(fixed.second, "offset_formula"));
  CHECK(contains(expect(2, folder, {"emit", "sampled.toml", "-o", ".", "--target", "c", "--fix", "T"}).err,
                 "depend on a parameter that is fixed and on another one"));
}

TEST_CASE("C: --output takes coordinates and rates too, in the requested order") {
  const Folder folder;
  expect(0, folder, {"emit", "cart_pendulum", "-o", ".", "--target", "c", "--output", "energy,theta_dot,x"});
  folder.write("caller.c", c_caller("cart_pendulum"));
  compile(folder, {"gcc", "-std=c11", "-o", "caller", "caller.c", "cart_pendulum.c", "-lm"});
  CHECK(printed(folder, "caller")["info"]["outputs"] == Json({"energy", "theta_dot", "x"}));
  expect(0, folder,
         {"emit", "P7_moving_sphere", "-o", ".", "--target", "c", "--output", "R"});  // follows from the sphere
  CHECK(contains(folder.read("P7_moving_sphere.h"), "P7_moving_sphere_outputs"));
}

TEST_CASE("C: Taylor series have no unused variable, for one state and for a batch, and numbers alone fill lanes") {
  const Folder folder;
  for (const std::string model : {"R6_rough_disk", "quarter_car"}) {  // branches; 2 pi t
    expect(0, folder, {"emit", model, "-o", ".", "--target", "batch", "--with", "taylor"});
    for (const std::string& file : {model + ".c", model + "_batch.c"})
      compile(folder, {"gcc", "-std=c11", "-fsyntax-only", file});
  }
}
