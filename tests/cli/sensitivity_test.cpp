// SPDX-License-Identifier: GPL-3.0-or-later
// run --sensitivity: against closed forms and differences of runs; refusals.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

namespace {

const char* const oscillator = R"toml(format = 1
[parameters]
m = "2 kg"
k = "8 N/m"
A = "0.3 m"
[coordinates]
x = {}
[energy]
kinetic = "m*x_dot^2/2"
potential = "k*x^2/2"
[scene.default]
initial = { x = "A", x_dot = "0.1" }
t = [0, 3]
rtol = 1e-11
atol = 1e-12
)toml";

/// Derivative of the final state by a parameter, from four runs by a central difference of order 4.
double by_runs(const Folder& folder, const std::string& model, const std::string& parameter, double value,
               const std::string& state) {
  const double h = 1e-2 * value;
  const auto end = [&](double at) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", at);
    return document(folder, {"run", model, "--set", parameter + "=" + text, "--rtol", "1e-12", "--atol", "1e-13",
                             "--no-error-estimate", "--no-charts"})["final"][state]
        .get<double>();
  };
  return (8 * (end(value + h) - end(value - h)) - (end(value + 2 * h) - end(value - 2 * h))) / (12 * h);
}

constexpr double of_order_four = 1e-6;  // (1e-2)^4 times fifth derivatives of the order of 10 to 100

}  // namespace

TEST_CASE("sensitivity: those of an oscillator agree with its closed form, within their estimates") {
  const Folder folder;
  folder.write("model.toml", oscillator);
  const Json found = document(folder, {"run", "model.toml", "--sensitivity", "k,m,A,x,x_dot"})["sensitivities"];
  const double m = 2, k = 8, A = 0.3, v = 0.1, t = 3, w = std::sqrt(k / m), c = std::cos(w * t), s = std::sin(w * t);
  const double by_w = -A * t * s + v * t * c / w - v * s / (w * w);  // of x = A cos wt + v/w sin wt
  const auto near = [&](const char* of, const char* state, double exact) {
    CAPTURE(of);
    const double error = std::abs(found["values"][of][state].get<double>() - exact);
    CHECK(error < 1e-9);  // rtol 1e-11 over some 30 steps
    CHECK(error < 10 * found["error_estimate"][of][state].get<double>() + 1e-15);
  };
  near("k", "x", by_w * w / (2 * k));
  near("m", "x", -by_w * w / (2 * m));
  near("A", "x", c);  // through the initial state only
  near("x", "x", c);
  near("x", "x_dot", -w * s);
  near("x_dot", "x", s / w);
  near("x_dot", "x_dot", c);
}

TEST_CASE("sensitivity: dependent parameters are included, for implicit solvers and multipliers too") {
  const Folder folder;
  folder.write("model.toml", R"toml(format = 1
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
L = "2 m"
W = "m*g"
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y"] }
[[force]]
on = "P"
force = "-W*E2"
[[constraint]]
name = "rod"
holonomic = "x^2 + y^2 - L^2"
[scene.default]
initial = { x = "L*sin(1)", y = "-L*cos(1)", x_dot = "0", y_dot = "0" }
t = [0, 1]
)toml");
  for (const char* solver : {"dop853", "radau5"}) {
    CAPTURE(solver);
    const Json found =
        document(folder, {"run", "model.toml", "--approach", "I", "--form", "multipliers", "--solver", solver, "--rtol",
                          "1e-11", "--atol", "1e-12", "--sensitivity", "L,g"})["sensitivities"]["values"];
    for (const auto& [parameter, value] : {std::pair<const char*, double>{"L", 2}, {"g", 9.81}}) {
      const auto& shown = parameter;
      CAPTURE(shown);
      for (const char* state : {"x", "y_dot"})
        CHECK(std::abs(found[parameter][state].get<double>() - by_runs(folder, "model.toml", parameter, value, state)) <
              of_order_four);
    }
  }
  // W = m g with m = 1, and g occurs nowhere else: by W alone, or by g through W.
  const Json weight = document(folder, {"run", "model.toml", "--sensitivity", "W,g"})["sensitivities"]["values"];
  CHECK(weight["W"]["x"].get<double>() == doctest::Approx(weight["g"]["x"].get<double>()).epsilon(1e-8));
  CHECK(contains(
      expect(2, folder, {"run", "model.toml", "--approach", "I", "--form", "multipliers", "--sensitivity", "x"}).err,
      "constraints couple the initial values"));
  const Json chain = document(folder, {"run", "S5_double_pendulum", "--rtol", "1e-11", "--atol", "1e-12", "--t-end",
                                       "2", "--sensitivity", "L1"});
  CHECK(chain["sensitivities"]["outcome"] == "done");
}

TEST_CASE("sensitivity: values without derivative are refused with a remedy") {
  const Folder folder;
  folder.write("model.toml", oscillator);
  const auto refused = [&](const Words& words, const char* what) {
    const ChildResult result = expect(2, folder, words);
    CHECK(contains(result.err, what));
    CHECK(contains(result.err, "remedy: "));
  };
  refused({"run", "model.toml", "--sensitivity", "q"}, "there is no parameter or coordinate 'q'");
  refused({"run", "bouncing_ball", "--sensitivity", "g"}, "contacts and friction change the equations");
}
