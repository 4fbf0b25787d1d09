// SPDX-License-Identifier: GPL-3.0-or-later
// run --sensitivity: against closed forms and differences of runs; refusals.
#include <doctest/doctest.h>

#include <cmath>
#include <tuple>

#include "displaced_oscillator.hpp"
#include "program.hpp"

using namespace eomgen::test;

namespace {

/// Derivative of the final state by a parameter, from four runs by a central difference of order 4.
double by_runs(const Folder& folder, const std::string& model, const std::string& parameter, double value,
               const std::string& state) {
  const double h = 3e-3 * value;
  const auto end = [&](double at) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", at);
    return document(folder, {"run", model, "--set", parameter + "=" + text, "--rtol", "1e-12", "--atol", "1e-13",
                             "--no-error-estimate", "--no-charts"})["final"][state]
        .get<double>();
  };
  return (8 * (end(value + h) - end(value - h)) - (end(value + 2 * h) - end(value - 2 * h))) / (12 * h);
}

constexpr double of_order_four = 1e-6;  // (3e-3)^4 times fifth derivatives of the order of 1000 to 10000

/// A particle of mass 2 on a line, x'' = -4 x + F/2 from x = 0.3, with lines of its own.
std::string line_text(const std::string& lines, const std::string& force, const std::string& scene) {
  return "format = 1\n[parameters]\nm = 2\nk = 8\n" + lines +
         "[coordinates]\nx = {}\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", 0, 0]\n"
         "[[force]]\non = \"P\"\nforce = \"(" +
         force + ")*E1\"\n[scene.default]\nrtol = 1e-11\natol = 1e-12\n" + scene;
}

/// A pendulum of length 1 on a support.
std::string support_text(const std::string& support) {
  return "format = 1\n[parameters]\nm = 1\ng = 9.81\ntau = 1\n[functions]\ns = \"" + support +
         "\"\n[coordinates]\nth = {}\n[[particle]]\nname = \"P\"\nmass = \"m\"\n"
         "position = [\"s + sin(th)\", \"-cos(th)\", 0]\n[[force]]\ngravity = \"-g*E2\"\n"
         "[scene.default]\ninitial = { th = 0.4 }\nt = [0, 4.3]\nrtol = 1e-11\natol = 1e-12\n";
}

/// Derivatives by one value: one per state.
Json derivatives(const Folder& folder, const std::string& by) {
  return document(folder, {"run", "model.toml", "--sensitivity", by})["sensitivities"]["values"][by];
}

}  // namespace

TEST_CASE("sensitivity: those of an oscillator agree with its closed form, within their estimates") {
  const Folder folder;
  folder.write("model.toml", displaced_oscillator);
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

TEST_CASE("sensitivity: derivatives that end where constraints lose rank are refused by the name of one") {
  const Folder folder;
  for (const std::vector<std::string>& wanted : {std::vector<std::string>{"--sensitivity", "L"},
                                                 std::vector<std::string>{"--gradient", "energy", "--by", "L"}}) {
    std::vector<std::string> arguments{"run", "n_four_bar_2"};
    arguments.insert(arguments.end(), wanted.begin(), wanted.end());
    CHECK(contains(expect(2, folder, arguments).err, "the constraint 'window"));
  }
  CHECK(document(folder, {"run", "n_four_bar_2", "--t-end", "1", "--sensitivity", "L"})["sensitivities"]["outcome"] ==
        "done");
}

TEST_CASE("sensitivity: everything that follows from a changed start or time changes with it") {
  const Folder folder;
  const double s = std::sin(6.0), c = std::cos(6.0);  // w t = 2 * 3
  folder.write("model.toml", line_text("", "-k*(x - 0.4*initial(x))", "initial = { x = 0.3 }\nt = [0, 3]\n"));
  // x = 0.4 x0 + 0.6 x0 cos(2 t)
  CHECK(derivatives(folder, "x")["x"].get<double>() == doctest::Approx(0.4 + 0.6 * c).epsilon(1e-9));
  folder.write("model.toml", line_text("", "-k*x", "initial = { x = 0.3, x_dot = \"x + 0.1\" }\nt = [0, 3]\n"));
  CHECK(derivatives(folder, "x")["x"].get<double>() == doctest::Approx(c + s / 2).epsilon(1e-9));
  CHECK(derivatives(folder, "x_dot")["x"].get<double>() == doctest::Approx(s / 2).epsilon(1e-9));
  folder.write("model.toml", line_text("w = 2\n", "-k*x", "initial = { x = 0.3 }\nt = [\"1 - w\", \"2 + w/2\"]\n"));
  // x = 0.3 cos(2 (1 + 3/2 w))
  CHECK(derivatives(folder, "w")["x"].get<double>() == doctest::Approx(-0.9 * std::sin(8.0)).epsilon(1e-9));
}

TEST_CASE("sensitivity: inputs that depend on the value") {
  const Folder folder;
  const std::string input = "tau = 1\n[inputs]\nF = { default = 0 }\n";
  const auto fed = [](const std::string& signal) {
    return "initial = { x = 0.3 }\nt = [0, 3]\ninputs = { F = " + signal + " }\n";
  };
  // Resonance: the force k sin(2 t), with m x'' = F - k x.
  folder.write("model.toml", line_text(input, "F - k*x", fed("\"k*sin(m*t)\"")));
  for (const auto& [parameter, value] : {std::pair<const char*, double>{"m", 2}, {"k", 8}}) {
    CAPTURE(value);
    CHECK(std::abs(derivatives(folder, parameter)["x"].get<double>() -
                   by_runs(folder, "model.toml", parameter, value, "x")) < of_order_four);
  }
  // A jump of F/m from 1/2 to -1 at tau adds 3/2 sin(2 (t - tau))/2.
  for (const char* signal : {"\"if(t < tau, 1, -2)\"", "{ t = [0, \"tau\"], value = [1, -2] }"}) {
    CAPTURE(signal);
    folder.write("model.toml", line_text(input, "F - k*x", fed(signal)));
    CHECK(derivatives(folder, "tau")["x"].get<double>() == doctest::Approx(0.75 * std::sin(4.0)).epsilon(1e-9));
  }
  // F/m = tau/2 and -tau, in x = F/k (1 - cos 2 t).
  folder.write("model.toml", line_text(input, "F - k*x", fed("{ t = [0, 1], value = [\"tau\", \"-2*tau\"] }")));
  CHECK(derivatives(folder, "tau")["x"].get<double>() ==
        doctest::Approx((1 - std::cos(6.0)) / 8 - 3 * (1 - std::cos(4.0)) / 8).epsilon(1e-9));
  // An input that enters the equations nonlinearly.
  folder.write("model.toml", line_text(input, "tanh(F*x) - k*x", fed("\"tau*(1 + t^2)\"")));
  CHECK(std::abs(derivatives(folder, "tau")["x"].get<double>() - by_runs(folder, "model.toml", "tau", 1, "x")) <
        of_order_four);
}

TEST_CASE("sensitivity: impulses of supports, and kinks whose time moves") {
  const Folder folder;
  folder.write("model.toml", support_text("0.3*abs(t - tau)"));
  for (const auto& [name, value, truth] :
       {std::tuple<const char*, double, double>{"th", 0.4, 0.812137}, {"tau", 1, -0.442380}, {"g", 9.81, 0}}) {
    CAPTURE(value);
    const double found = derivatives(folder, name)["th"].get<double>();
    if (truth != 0) CHECK(found == doctest::Approx(truth).epsilon(2e-6));
    CHECK(std::abs(found - by_runs(folder, "model.toml", name, value, "th")) < of_order_four);
  }
  folder.write("model.toml", support_text("0.1*abs(t - tau)"));
  CHECK(std::abs(derivatives(folder, "tau")["th"].get<double>() - by_runs(folder, "model.toml", "tau", 1, "th")) <
        of_order_four);
  // A support that bends without an impulse, and a force that jumps.
  folder.write("model.toml", support_text("0.3*abs(t - tau)^3 + if(t < 2*tau, t^2, 4*tau*t - 4*tau^2)/9"));
  CHECK(std::abs(derivatives(folder, "tau")["th"].get<double>() - by_runs(folder, "model.toml", "tau", 1, "th")) <
        of_order_four);
  folder.write("model.toml", R"toml(format = 1
[parameters]
m = 1
g = 9.81
L = 1
tau = 0.9
[functions]
s = "0.2*abs(t - tau) + 0.1*max(t, 2*tau)"
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y"] }
[[force]]
gravity = "-g*E2"
[[constraint]]
name = "rod"
holonomic = "(x - s)^2 + y^2 - L^2"
[scene.default]
initial = { x = "0.4*tau + L*sin(0.4)", y = "-L*cos(0.4)", x_dot = -0.2, y_dot = 0 }
t = [0, 2.2]
rtol = 1e-11
atol = 1e-12
)toml");
  const Words multipliers{"run", "model.toml", "--approach", "I", "--form", "multipliers", "--sensitivity", "L,tau"};
  const Json values = document(folder, multipliers)["sensitivities"]["values"];
  for (const auto& [parameter, value] : {std::pair<const char*, double>{"L", 1}, {"tau", 0.9}}) {
    const auto& shown = parameter;
    CAPTURE(shown);
    for (const char* state : {"x", "y_dot"})
      CHECK(std::abs(values[parameter][state].get<double>() - by_runs(folder, "model.toml", parameter, value, state)) <
            of_order_four);
  }
}

TEST_CASE("sensitivity: surfaces in the state, and events that end the run") {
  const Folder folder;
  // From x = 0 with velocity v, deceleration a up to x = c at the time T and with the velocity w, and b after it.
  const std::string text =
      line_text("v = 3\na = 1\nb = 2\nc = 1\n", "-m*if(x < c, a, b)", "initial = { x_dot = \"v\" }\nt = [0, 1]\n");
  folder.write("model.toml", text);
  const double v = 3, a = 1, b = 2, c = 1, w = std::sqrt(v * v - 2 * a * c), T = (v - w) / a;
  const double w_v = v / w, T_v = (1 - w_v) / a, w_c = -a / w, T_c = 1 / w;
  // x(1) = c + w (1 - T) - b (1 - T)^2/2
  CHECK(derivatives(folder, "v")["x"].get<double>() ==
        doctest::Approx(w_v * (1 - T) - w * T_v + b * (1 - T) * T_v).epsilon(1e-9));
  CHECK(derivatives(folder, "c")["x"].get<double>() ==
        doctest::Approx(1 + w_c * (1 - T) - w * T_c + b * (1 - T) * T_c).epsilon(1e-9));
  CHECK(derivatives(folder, "b")["x_dot"].get<double>() == doctest::Approx(-(1 - T)).epsilon(1e-9));
  folder.write("model.toml", text.substr(0, text.find("[scene")) +
                                 "[[event]]\nname = \"there\"\nwhen = \"x - c\"\naction = \"stop\"\n" +
                                 text.substr(text.find("[scene")));
  const Json stop = document(folder, {"run", "model.toml", "--sensitivity", "v,c,b"})["sensitivities"]["values"];
  CHECK(stop["v"]["t"].get<double>() == doctest::Approx(T_v).epsilon(1e-9));
  CHECK(stop["v"]["x"].get<double>() == doctest::Approx(0).epsilon(1e-9));
  CHECK(stop["v"]["x_dot"].get<double>() == doctest::Approx(w_v).epsilon(1e-9));
  CHECK(stop["c"]["x"].get<double>() == doctest::Approx(1).epsilon(1e-9));
  CHECK(stop["c"]["x_dot"].get<double>() == doctest::Approx(w_c).epsilon(1e-9));
  CHECK_FALSE(stop["b"].contains("t"));
}

TEST_CASE("sensitivity: a reset at an event changes them by the change of its time and of its values") {
  const Folder folder;
  // A ball from the height h, with one bounce: v = e sqrt(2 g h) at t1 = sqrt(2 h/g).
  folder.write("model.toml", R"toml(format = 1
[parameters]
g = 10
h = 1
e = 0.8
[coordinates]
z = {}
[discrete]
bounces = { initial = 0 }
[[particle]]
name = "P"
mass = 1
position = [0, 0, "z"]
[[force]]
gravity = "-g*E3"
[[event]]
name = "bounce"
when = "z"
direction = "down"
set = { z_dot = "-e*z_dot", bounces = "bounces + 1" }
[scene.default]
initial = { z = "h" }
t = [0, 1]
rtol = 1e-11
atol = 1e-12
)toml");
  const double g = 10, h = 1, e = 0.8, t1 = std::sqrt(2 * h / g), v = std::sqrt(2 * g * h), after = 1 - t1;
  const Json by_e = derivatives(folder, "e"), by_h = derivatives(folder, "h"), by_g = derivatives(folder, "g");
  CHECK(std::abs(by_e["z"].get<double>() - v * after) < 1e-8);
  CHECK(std::abs(by_e["z_dot"].get<double>() - v) < 1e-8);
  CHECK(std::abs(by_h["z_dot"].get<double>() - (e * g / v + g / v)) < 1e-8);
  CHECK(std::abs(by_h["z"].get<double>() - (e * g / v * after - (e * v - g * after) / v)) < 1e-8);
  // z = e v s - g s^2/2, s = 1 - t1, dv/dg = h/v, dt1/dg = -t1/(2 g).
  CHECK(std::abs(by_g["z"].get<double>() -
                 (e * h / v * after - after * after / 2 + (e * v - g * after) * t1 / (2 * g))) < 1e-8);
  CHECK(by_g["bounces"].get<double>() == 0);
}

namespace {

/// x'' = u/m, where samples set u from x and the times of the samples.
std::string sampled_text(const std::string& start, const std::string& more) {
  return "format = 1\n[parameters]\nm = 2\nTs = 0.25\nkp = 3\nstart = " + start +
         "\n[coordinates]\nx = {}\n[discrete]\nu = 0\nold = { initial = \"x\" }\n"
         "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", 0, 0]\n"
         "[[force]]\non = \"P\"\nforce = \"u*E1\"\n"
         "[[sample]]\nname = \"controller\"\nevery = \"Ts\"\noffset = \"start\"\n" +
         more;
}

}  // namespace

// One sample at t1 = start: x = 1 + 0.3 t before it, then u = -kp x1 + t1, x = x1 + 0.3 s + u s^2/(2 m), s = 2 - t1.
TEST_CASE("sensitivity: a sample changes them by its values and by the change of its time") {
  const Folder folder;
  folder.write("model.toml",
               sampled_text("0.5",
                            "set = { u = \"-kp*x + t\" }\n[scene.default]\n"
                            "initial = { x = 1, x_dot = 0.3 }\nt = [0, 2]\nrtol = 1e-11\natol = 1e-12\n") +
                   "parameters = { Ts = 10 }\n");
  const double m = 2, kp = 3, t1 = 0.5, v = 0.3, x1 = 1 + v * t1, u = -kp * x1 + t1, s = 2 - t1;
  const Json by_start = derivatives(folder, "start"), by_kp = derivatives(folder, "kp"),
             by_m = derivatives(folder, "m");
  const double du = -kp * v + 1;  // du/dt1
  CHECK(std::abs(by_start["x"].get<double>() - (du * s * s / (2 * m) - u * s / m)) < 1e-9);
  CHECK(std::abs(by_start["x_dot"].get<double>() - (du * s / m - u / m)) < 1e-9);
  CHECK(std::abs(by_start["u"].get<double>() - du) < 1e-9);
  CHECK(std::abs(by_kp["x"].get<double>() + x1 * s * s / (2 * m)) < 1e-9);
  CHECK(std::abs(by_m["x"].get<double>() + u * s * s / (2 * m * m)) < 1e-9);
  CHECK(derivatives(folder, "x_dot")["u"].get<double>() == doctest::Approx(-kp * t1).epsilon(1e-10));
}

TEST_CASE("sensitivity: samples from the start on, with events that they cause, agree with differences of runs") {
  const Folder folder;
  folder.write("model.toml", sampled_text("0",
                                          "set = { u = \"-kp*x - 0.7*(x - old)/Ts\", old = \"x\" }\n"
                                          "[[event]]\nname = \"limit\"\nwhen = \"u - 1\"\ndirection = \"up\"\n"
                                          "set = { u = \"1 + 0.1*u\" }\n"
                                          "[scene.default]\ninitial = { x = 1, x_dot = 0.3 }\nt = [0, 4.1]\n"
                                          "rtol = 1e-11\natol = 1e-12\n"));
  const Json run = document(folder, {"run", "model.toml"});
  const auto limits = [&] {
    int count = 0;
    for (const Json& event : run["events"]) count += event["name"] == "limit" ? 1 : 0;
    return count;
  };
  CHECK(limits() >= 1);
  for (const auto& [name, value] : std::vector<std::pair<std::string, double>>{{"kp", 3}, {"Ts", 0.25}, {"m", 2}}) {
    CAPTURE(name);
    const Json found = derivatives(folder, name);
    for (const char* state : {"x", "x_dot", "u", "old"}) {
      CAPTURE(state);
      const double expected = by_runs(folder, "model.toml", name, value, state);
      CHECK(std::abs(found[state].get<double>() - expected) < of_order_four * (1 + std::abs(expected)));
    }
  }
  const ChildResult refused = expect(2, folder, {"run", "model.toml", "--sensitivity", "start"});
  CHECK(contains(refused.err, "the samples, or the contacts at the start, change with start"));
}

TEST_CASE("sensitivity: resets with constraints, conditions and chains agree with differences of runs") {
  const Folder folder;
  // A pendulum in x, y that is struck where x = c; the second event follows from the state that the first one sets.
  folder.write("struck.toml", R"toml(format = 1
[parameters]
g = 9.81
L = 1.1
c = 0.2
k = 0.7
[[particle]]
name = "P"
mass = 1
position = { cartesian = ["x", "y"] }
[[constraint]]
name = "rod"
holonomic = "x^2 + y^2 - L^2"
[[state]]
name = "w"
rate = "x - w"
initial = 0.1
[[force]]
gravity = "-g*E2"
[[force]]
on = "P"
force = "-w*E1"
[[event]]
name = "strike"
when = "x - c"
direction = "down"
if = "w > 0"
set = { x_dot = "-k*x_dot", w = "w - 1" }
[[event]]
name = "follows"
when = "w + 1/2"
direction = "down"
set = { w = "w/2 + c*x_dot" }
[scene.default]
initial = { x = 0.8 }
guess = { y = -0.7 }
t = [0, 1.3]
rtol = 1e-11
atol = 1e-12
)toml");
  for (const auto& [name, value] : {std::pair{"g", 9.81}, {"c", 0.2}, {"k", 0.7}, {"L", 1.1}}) {
    CAPTURE(std::string(name));
    const Json found = document(folder, {"run", "struck.toml", "--sensitivity", name})["sensitivities"]["values"][name];
    for (const char* state : {"x", "x_dot", "y_dot", "w"}) {
      CAPTURE(std::string(state));
      const double expected = by_runs(folder, "struck.toml", name, value, state);
      CHECK(std::abs(found[state].get<double>() - expected) < of_order_four * (1 + std::abs(expected)));
    }
  }
}

TEST_CASE("sensitivity: values without derivative are refused with a remedy") {
  const Folder folder;
  folder.write("model.toml", displaced_oscillator);
  const auto refused = [&](const Words& words, const char* what) {
    const ChildResult result = expect(2, folder, words);
    CHECK(contains(result.err, what));
    CHECK(contains(result.err, "remedy: "));
  };
  refused({"run", "model.toml", "--sensitivity", "q"}, "there is no parameter or coordinate 'q'");
  // The sample at the end of the run, t = 6, is taken or not.
  refused({"run", "sampled_cart_pole", "--sensitivity", "Ts"}, "the samples, or the contacts at the start, change");
  // The run shortens its steps for a force that is narrow in the state, and the variational equations do not.
  folder.write("model.toml",
               line_text("w = 1e-3\n", "1000*exp(-((x - 3)/w)^2)", "initial = { x_dot = 1 }\nt = [0, 10]\n"));
  refused({"run", "model.toml", "--sensitivity", "w"}, "something on the way is not differentiated");
}

// The reset of a tick is a root of the velocity, and almost linear far from it. All slopes at the tick are across it,
// so that a rounding error is the change of its time.
TEST_CASE("sensitivity: slopes of a reset are those at the state where it happens") {
  const Folder folder;
  const Json found =
      document(folder, {"run", "clock_escapement", "--sensitivity", "phi", "--t-end", "1"})["sensitivities"]["values"];
  for (const char* state : {"phi", "phi_dot"}) {
    CAPTURE(state);
    const double h = 1e-4;
    const auto end = [&](double phi) {
      return document(folder, {"run", "clock_escapement", "--set", "phi=" + std::to_string(phi), "--t-end", "1",
                               "--rtol", "1e-12", "--atol", "1e-13"})["final"][state]
          .get<double>();
    };
    CHECK(std::abs(found["phi"][state].get<double>() - (end(0.5 + h) - end(0.5 - h)) / (2 * h)) < 1e-6);  // h^2
  }
}
