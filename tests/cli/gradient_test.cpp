// SPDX-License-Identifier: GPL-3.0-or-later
// run --gradient: the adjoint equations against the variational ones (run --sensitivity), a closed form, and
// differences of runs; refusals.
#include <doctest/doctest.h>

#include <cmath>
#include <tuple>

#include "displaced_oscillator.hpp"
#include "program.hpp"

using namespace eomgen::test;

namespace {

Json gradients(const Folder& folder, Words words) { return document(folder, std::move(words))["gradients"]; }

/// Both kinds of derivatives of the states at the end, by `names`.
void compare(const Folder& folder, const std::string& model, const std::string& states, const std::string& names,
             double tolerance, const Words& further = {}) {
  CAPTURE(model);
  Words words{"run", model, "--gradient", states, "--by", names, "--sensitivity", names};
  words.insert(words.end(), further.begin(), further.end());
  const Json run = document(folder, words);
  const Json& adjoint = run["gradients"]["values"];
  const Json& forward = run["sensitivities"]["values"];
  REQUIRE(adjoint.size() > 0);
  for (const auto& [output, by] : adjoint.items()) {
    CHECK(run["gradients"]["outputs"][output].get<double>() ==
          doctest::Approx(run["final"][output].get<double>()).epsilon(1e-7));
    for (const auto& [name, value] : by.items()) {
      const std::string of = output, with = name;
      CAPTURE(of);
      CAPTURE(with);
      const double expected = forward[name][output].get<double>();
      CHECK(std::abs(value.get<double>() - expected) < tolerance * (1 + std::abs(expected)));
    }
  }
}

}  // namespace

TEST_CASE("gradient: that of an oscillator agrees with its closed form, within its estimate") {
  const Folder folder;
  folder.write("model.toml", displaced_oscillator);
  const Json found = gradients(folder, {"run", "model.toml", "--gradient", "x,energy", "--by", "k,m,A,x_dot"});
  const double m = 2, k = 8, A = 0.3, v = 0.1, t = 3, w = std::sqrt(k / m), c = std::cos(w * t), s = std::sin(w * t);
  const double by_w = -A * t * s + v * t * c / w - v * s / (w * w);  // of x = A cos wt + v/w sin wt
  for (const auto& [of, by, exact] :
       std::vector<std::tuple<const char*, const char*, double>>{{"x", "k", by_w / (2 * std::sqrt(k * m))},
                                                                 {"x", "m", -by_w * w / (2 * m)},
                                                                 {"x", "A", c},
                                                                 {"x", "x_dot", s / w},
                                                                 {"energy", "k", A * A / 2},
                                                                 {"energy", "m", v * v / 2},
                                                                 {"energy", "A", k * A},
                                                                 {"energy", "x_dot", m * v}}) {
    CAPTURE(of);
    CAPTURE(by);
    const double error = std::abs(found["values"][of][by].get<double>() - exact);
    CHECK(error < 1e-9);  // rtol 1e-11 over some 30 steps, there and back
    CHECK(error < 10 * found["error_estimate"][of][by].get<double>() + 1e-14);
  }
  // Without --by: the parameters that are numbers.
  const Json all = gradients(folder, {"run", "model.toml", "--gradient", "x"});
  CHECK(all["values"]["x"].size() == 3);
  CHECK(all["adjoint_evaluations"].get<int>() > 0);
}

// 1e-7: both kinds have the tolerances of the scenes, 1e-9, over up to a few hundred steps.
TEST_CASE("gradient: adjoint and variational equations agree on models with everything that interrupts a run") {
  const Folder folder;
  compare(folder, "S5_double_pendulum", "theta1,theta2_dot", "m1,m2,L1,theta1", 1e-6,
          {"--rtol", "1e-11", "--t-end", "3"});
  const std::string particle = "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", 0, 0]\n";
  const auto line = [&](const std::string& force, const std::string& scene) {
    folder.write("line.toml",
                 "format = 1\n[parameters]\nm = 2\nk = 8\ntau = 1.3\nw = 2\n"
                 "[coordinates]\nx = {}\n" +
                     particle + "[[force]]\non = \"P\"\nforce = \"(" + force +
                     ")*E1\"\n[scene.default]\nrtol = 1e-11\natol = 1e-12\n" + scene);
  };
  const std::string scene = "initial = { x = 0.3, x_dot = 0.2 }\nt = [\"-w/2\", 3]\n";
  line("-k*x + if(t < tau, 1, -2)", scene);  // a kink at a time, a start that moves
  compare(folder, "line.toml", "x,x_dot", "m,k,tau,w,x", 1e-7);
  line("-k*x - 3*sign(x - tau/10)", scene);  // a surface of the state, where the force jumps
  compare(folder, "line.toml", "x,x_dot", "m,k,tau,w,x", 1e-7);
  // Every output is in the mode of the end, whatever comes before it.
  const Json run = document(
      folder, {"run", "line.toml", "--gradient", "x,x_ddot", "--by", "k", "--output", "x_ddot", "--t-end", "0.1"});
  CHECK(run["gradients"]["outputs"]["x_ddot"].get<double>() ==
        doctest::Approx(run["final"]["x_ddot"].get<double>()).epsilon(1e-9));
}

TEST_CASE("gradient: inputs that depend on parameters, resets, ends by an event, impulses and samples") {
  const Folder folder;
  const std::string head = "format = 1\n[parameters]\nm = 2\nk = 8\ntau = 1.3\nA = 0.3\n";
  const std::string line =
      "[coordinates]\nx = {}\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", 0, 0]\n";
  const std::string tight = "rtol = 1e-11\natol = 1e-12\n";
  folder.write("input.toml", head + "[inputs]\nF = { unit = \"N\", default = 0 }\n" + line +
                                 "[[force]]\non = \"P\"\nforce = \"(F - k*x)*E1\"\n[scene.default]\n" + tight +
                                 "initial = { x = \"A\" }\nt = [0, 3]\ninputs = { F = \"k*sin(m*t + tau)\" }\n");
  compare(folder, "input.toml", "x,x_dot", "m,k,tau,A", 1e-7);
  folder.write("reset.toml", head + line +
                                 "[[force]]\non = \"P\"\nforce = \"-k*x*E1\"\n[[event]]\nname = \"kick\"\n"
                                 "when = \"x - A/2\"\ndirection = \"down\"\nset = { x_dot = \"0.5*x_dot + tau*x\" }\n"
                                 "[scene.default]\n" +
                                 tight + "initial = { x = \"A\" }\nt = [0, 2]\n");
  compare(folder, "reset.toml", "x,x_dot", "m,k,tau,A", 1e-7);
  folder.write("stop.toml", head + line +
                                "[[force]]\non = \"P\"\nforce = \"-k*x*E1\"\n[[event]]\nname = \"low\"\n"
                                "when = \"x + A/2\"\ndirection = \"down\"\naction = \"stop\"\n[scene.default]\n" +
                                tight + "initial = { x = \"A\" }\nt = [0, 2]\n");
  compare(folder, "stop.toml", "x_dot", "m,k,A", 1e-7);
  folder.write("support.toml",
               "format = 1\n[parameters]\nm = 1\ng = 9.81\ntau = 1\n[functions]\ns = \"0.1*abs(t - tau)\"\n"
               "[coordinates]\nth = {}\n[[particle]]\nname = \"P\"\nmass = \"m\"\n"
               "position = [\"s + sin(th)\", \"-cos(th)\", 0]\n[[force]]\ngravity = \"-g*E2\"\n[scene.default]\n"
               "initial = { th = 0.4 }\nt = [0, 4.3]\n" +
                   tight);
  compare(folder, "support.toml", "th,th_dot", "tau,g,th", 1e-6);
  compare(folder, "clock_escapement", "phi,phi_dot", "J,E,phi", 1e-5);  // 20 ticks at rtol 1e-9
  compare(folder, "sampled_cart_pole", "theta,theta_dot", "kp,theta", 1e-5);
}

TEST_CASE("gradient: stiff motions and fixed steps, and a motion that is integrated again from checkpoints") {
  const Folder folder;
  compare(folder, "P2_planar_pendulum", "theta,theta_dot", "L,theta", 1e-5, {"--solver", "radau5", "--rtol", "1e-10"});
  compare(folder, "P2_planar_pendulum", "theta,theta_dot", "L,theta", 1e-6, {"--solver", "rk4", "--step", "0.001"});
  // 1.2 million steps: more than a trajectory stores.
  compare(folder, "P2_planar_pendulum", "theta", "L,theta", 1e-6,
          {"--solver", "rk4", "--step", "1e-5", "--t-end", "12", "--no-error-estimate"});
}

TEST_CASE("gradient: friction that sticks and slips") {
  const Folder folder;
  compare(folder, "stick_slip_belt", "x,x_dot", "m,k,v,g", 1e-7);
}

// x'' = -4 x - s F with s = 1 or -1: a mass on a spring with a force that jumps.
TEST_CASE("gradient: a run that starts on the surface of a jump has the branch of its motion from the start on") {
  const Folder folder;
  const auto run = [&](const std::string& force, const std::string& start, const std::string& end) {
    folder.write("model.toml",
                 "format = 1\n[parameters]\nF = 0.8\n[coordinates]\nx = {}\ny = {}\n[energy]\n"
                 "kinetic = \"(x_dot^2 + y_dot^2)/2\"\n[[force]]\ngeneralized = { x = \"" +
                     force + "\", y = \"2 - F*sign(y_dot - x_dot/8)\" }\n[scene.default]\ninitial = { " + start +
                     " }\nt = [0, " + end + "]\nrtol = 1e-11\natol = 1e-12\n");
    return document(folder, {"run", "model.toml", "--gradient", "x", "--by", "F", "--sensitivity", "F"});
  };
  const auto near = [](const Json& found, double exact) {
    const Json &adjoint = found["gradients"], &forward = found["sensitivities"];
    constexpr double of_run = 1e-9;  // rtol 1e-11 over some 30 steps
    CHECK(std::abs(adjoint["values"]["x"]["F"].get<double>() - exact) < of_run);
    CHECK(std::abs(forward["values"]["F"]["x"].get<double>() - exact) < of_run);
    CHECK(adjoint["error_estimate"]["x"]["F"].get<double>() < of_run);
    CHECK(forward["error_estimate"]["F"]["x"].get<double>() < of_run);
  };
  // y leaves the surface of its friction with x: two surfaces at one state.
  const double by_force = std::sin(1) * std::sin(1) / 2;  // x = x(0) cos 2 t + .. + s F (cos 2 t - 1)/4
  near(run("-4*x - F*sign(x_dot)", "x = 1", "1"), by_force);
  near(run("-4*x - if(x_dot < 0, -F, F)", "x = 1", "1"), by_force);
  near(run("-4*x - F*sign(x)", "x_dot = 1", "1"), -by_force);
  near(run("-4*x - F*sign(x)", "x_dot = -1", "1"), by_force);
  near(run("-4*x - F*sign(sin(3*t))", "x = 1", "1"), -by_force);
  near(run("-4*x - F*if(t > 0, 1, -1)", "x = 1", "1"), -by_force);
  near(run("2 - 4*x - if(x > 0, F, 0)", "x = 0", "1"), -by_force);  // it leaves x = 0 by its acceleration alone
  // It turns at t = pi/2, x = -1 + F/2, on the same surface.
  near(run("-4*x - F*sign(x_dot)", "x = 1", "2"), 0.75 * std::cos(4 - std::acos(-1)) - 0.25);
}

TEST_CASE("gradient: a reset that lands on the surface of a jump") {
  const Folder folder;
  folder.write("model.toml",
               "format = 1\n[parameters]\nk = 10\nF = 0.6\nc = 0.4\n[coordinates]\nx = {}\n[energy]\n"
               "kinetic = \"x_dot^2/2\"\npotential = \"k*x^2/2\"\n[[force]]\n"
               "generalized = { x = \"c*sin(t) - F*sign(x_dot)\" }\n[[event]]\nname = \"hit\"\nwhen = \"x + 0.2\"\n"
               "direction = \"down\"\nset = { x_dot = \"0\" }\n[scene.default]\ninitial = { x = 0.5 }\nt = [0, 1.2]\n"
               "rtol = 1e-11\natol = 1e-12\n");
  compare(folder, "model.toml", "x,x_dot", "k,F,c,x", 1e-8);
  CHECK(gradients(folder, {"run", "model.toml", "--gradient", "x", "--by", "F"})["error_estimate"]["x"]["F"] < 1e-8);
  // A larger force of friction holds the mass there.
  CHECK(contains(expect(2, folder, {"run", "model.toml", "--set", "F=2.5", "--gradient", "x"}).err, "slides along"));
}

TEST_CASE("gradient, sensitivity: a change that leads a start off the surface of a jump is refused, as at a bend") {
  const Folder folder;
  const auto model = [&](const std::string& force, const std::string& start) {
    folder.write("model.toml",
                 "format = 1\n[parameters]\nF = 0.8\nc = 0\n[coordinates]\nx = {}\n[energy]\nkinetic = "
                 "\"x_dot^2/2\"\n[[force]]\ngeneralized = { x = \"" +
                     force + "\" }\n[scene.default]\ninitial = { " + start + " }\nt = [0, 1]\n");
  };
  const auto refused = [&](const std::string& force, const std::string& start, const std::string& by) {
    CAPTURE(force);
    CAPTURE(by);
    model(force, start);
    for (const Words& words :
         {Words{"run", "model.toml", "--sensitivity", by}, Words{"run", "model.toml", "--gradient", "x", "--by", by}}) {
      const std::string error = expect(2, folder, words).err;
      CHECK(contains(error, "the state at t = 0 lies on a surface of "));
      CHECK(contains(error, "with " + by + ": its derivatives differ between the two sides"));
    }
  };
  refused("-4*x - F*sign(x)", "x_dot = 1", "x");  // a start at -h crosses x = 0, one at h does not
  refused("-4*x - if(x_dot < 0, -F, F)", "x = 1", "x_dot");
  refused("-4*x - F*sign(x_dot - c)", "x = 1", "c");
  refused("2 - 4*x - if(x > 0, F, 0)", "x = 0", "x_dot");  // it returns to x = 0 from a start downwards
  refused("-4*abs(x) - F*x_dot", "x = 0", "x");            // the motion stays where it bends
  const auto followed = [&](const std::string& force, const std::string& start, const std::string& by) {
    CAPTURE(force);
    CAPTURE(by);
    model(force, start);
    compare(folder, "model.toml", "x,x_dot", by, 1e-6, {"--rtol", "1e-11"});
  };
  followed("-4*x - F*sign(x)", "x_dot = 1", "x_dot,F");
  followed("-4*x - F*sign(x_dot - c)", "x = 1, x_dot = \"c\"", "x,c");  // the surface moves with the start
  followed("-4*max(x, 0) - F*min(x_dot, 0)", "x_dot = 1", "x,x_dot");   // both sides have the same derivatives
  followed("-4*x - F*abs(x_dot)*x_dot", "x = 0", "x,x_dot");
}

TEST_CASE("gradient: changes of the state that only other values make do not refuse a rest on a surface") {
  const Folder folder;
  folder.write("model.toml",
               "format = 1\n[parameters]\nk = 1\nF = 0.6\nc = 0.4\n[inputs]\nu = {}\n[coordinates]\nx = {}\n[energy]\n"
               "kinetic = \"x_dot^2/2\"\n[[force]]\ngeneralized = { x = \"u*if(x > 0, F, k) - c*x_dot\" }\n"
               "[scene.default]\ninitial = { x = 0 }\nt = [0, 2]\ninputs = { u = \"if(t < 1, 0, -1)\" }\n");
  compare(folder, "model.toml", "x,x_dot", "k,F,c", 1e-7, {"--rtol", "1e-11"});
  CHECK(contains(expect(2, folder, {"run", "model.toml", "--gradient", "x", "--by", "x"}).err,
                 "lies on a surface of if"));
}

TEST_CASE("gradient: refusals name the cause") {
  const Folder folder;
  folder.write("model.toml", displaced_oscillator);
  CHECK(contains(expect(2, folder, {"run", "model.toml", "--by", "k"}).err, "--gradient"));
  CHECK(contains(expect(2, folder, {"run", "model.toml", "--gradient", "nothing"}).err, "nothing"));
  CHECK(contains(expect(2, folder, {"run", "model.toml", "--gradient", "x", "--by", "nothing"}).err, "nothing"));
}

// A puck that falls with a speed v along a rough floor, and slides on after the impact: z_1 = 0 at T = sqrt(2 h/g), and
// Moreau's law takes mu (1 + e) g T of the slip.
TEST_CASE("gradient: through an impact with friction whose impulse is solved for, by the variational equations") {
  const Folder folder;
  folder.write("model.toml", R"toml(format = 1
[parameters]
m = 2
g = 9.81
h = 0.3
v = 3
e = 0.6
mu = 0.2
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "0", "z"] }
[[constraint]]
name = "floor"
holonomic = "z"
holds = "unilateral"
restitution = "e"
friction = { static = "mu", dynamic = "mu" }
[impacts]
law = "moreau"
[[force]]
gravity = "-g*E3"
[scene.default]
t = [0, 0.5]
initial = { x = 0, x_dot = "v", z = "h", z_dot = 0 }
rtol = 1e-11
atol = 1e-12
)toml");
  const Json found = gradients(folder, {"run", "model.toml", "--gradient", "x,z,x_dot,energy", "--by", "h,v,e,mu,m"});
  CHECK(found["equations"] == "variational");
  CHECK(found["adjoint_evaluations"] == 0);
  const double m = 2, g = 9.81, h = 0.3, v = 3, e = 0.6, mu = 0.2, T = std::sqrt(2 * h / g), rest = 0.5 - T,
               slip = v - mu * (1 + e) * g * T, by_T = 1 / (g * T);  // dT/dh
  for (const auto& [of, by, exact] : std::vector<std::tuple<const char*, const char*, double>>{
           {"x", "v", 0.5},
           {"x", "mu", -(1 + e) * g * T * rest},
           {"x", "e", -mu * g * T * rest},
           {"x", "h", by_T * (v - slip - mu * (1 + e) * g * rest)},
           {"z", "e", g * T * rest},
           {"z", "h", by_T * (e * g * rest - e * g * T + g * rest)},
           {"z", "mu", 0},
           {"x_dot", "mu", -(1 + e) * g * T},
           {"x_dot", "m", 0},
           {"energy", "m", slip * slip / 2 + e * e * g * h},
           {"energy", "v", m * slip},
           {"energy", "h", m * (-slip * mu * (1 + e) * g * by_T + e * e * g)}}) {
    CAPTURE(of);
    CAPTURE(by);
    const double error = std::abs(found["values"][of][by].get<double>() - exact);
    CHECK(error < 1e-7 * (1 + std::abs(exact)));  // derivatives across the impact are differences
    CHECK(error <= found["error_estimate"][of][by].get<double>() + 1e-8);
  }
  // In lasting contact, its force is an output.
  const Json rests = gradients(folder, {"run", "model.toml", "--set", "h=0", "--set", "v=5", "--gradient",
                                        "reaction.floor,x", "--by", "m,g,mu"})["values"];
  CHECK(rests["reaction.floor"]["m"].get<double>() == doctest::Approx(g).epsilon(1e-9));
  CHECK(rests["reaction.floor"]["g"].get<double>() == doctest::Approx(m).epsilon(1e-9));
  CHECK(rests["x"]["mu"].get<double>() == doctest::Approx(-g * 0.125).epsilon(1e-8));
}

// A puck slides along a rough table against a wall. It may leave the table, and does so for changes of its state alone
// along the normal.
TEST_CASE("gradient: through a contact that changes while another one is closed") {
  const Folder folder;
  folder.write(
      "model.toml",
      "format = 1\n[parameters]\nm = 2\ng = 9.81\nd = 1\nv = 3\ne = 0.5\nmu = 0.2\n[[particle]]\nname = "
      "\"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"0\", \"z\"] }\n[[constraint]]\nname = \"table\"\n"
      "holonomic = \"z\"\nholds = \"unilateral\"\nfriction = { static = \"mu\", dynamic = \"mu\" "
      "}\n[[constraint]]\nname = \"wall\"\n"
      "holonomic = \"d - x\"\nholds = \"unilateral\"\nrestitution = \"e\"\n[[force]]\ngravity = \"-g*E3\"\n"
      "[scene.default]\nt = [0, 0.6]\ninitial = { x = 0, x_dot = \"v\" }\nrtol = 1e-11\natol = 1e-12\n");
  compare(folder, "model.toml", "x,x_dot", "d,v,e,mu,g", 1e-8);
  const Json found = gradients(folder, {"run", "model.toml", "--gradient", "x", "--by", "d"});
  CHECK(found["equations"] == "variational");
  CHECK(contains(found["reason"].get<std::string>(), "a contact changes"));
  const double mu = 0.2, g = 9.81, v = 3, d = 1, e = 0.5, a = mu * g, w = std::sqrt(v * v - 2 * a * d);
  const Json by = gradients(folder, {"run", "model.toml", "--gradient", "x_dot", "--by", "e,d"})["values"]["x_dot"];
  // x_dot = -e w + a (t - T) with T = (v - w)/a
  CHECK(by["e"].get<double>() == doctest::Approx(-w).epsilon(1e-8));
  CHECK(by["d"].get<double>() == doctest::Approx((e - 1) * a / w).epsilon(1e-7));
}

TEST_CASE("gradient: quadratic drag from rest, where the speed has no slope") {
  const Folder folder;
  for (const std::string drag : {"norm(ddt(P))*ddt(P)", "dot(ddt(P), ddt(P))^0.75*ddt(P)"}) {
    CAPTURE(drag);
    folder.write("model.toml", std::string("format = 1\n[parameters]\nm = 2\nc = 0.3\n[coordinates]\nx = {}\ny = {}\n"
                                           "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", \"y\", 0]\n"
                                           "[[force]]\ngravity = \"-10*E2\"\n[[force]]\non = \"P\"\nforce = \"-c*") +
                                   drag + "\"\n[scene.default]\nt = [0, 2]\nrtol = 1e-10\natol = 1e-12\n");
    for (const std::string solver : {"dop853", "radau5"}) {
      CAPTURE(solver);
      compare(folder, "model.toml", "x,y,y_dot", "m,c,x_dot,y_dot", 1e-7, {"--solver", solver});
    }
  }
  folder.write("model.toml",
               "format = 1\n[parameters]\nm = 2\nc = 0.3\n[coordinates]\nx = {}\ny = {}\n[[particle]]\n"
               "name = \"P\"\nmass = \"m\"\nposition = [\"x\", \"y\", 0]\n[[force]]\ngravity = "
               "\"-10*E2\"\n[[force]]\ndrag = { on = \"P\", density = 2, area = \"c\", coefficient = 1 }\n"
               "[scene.default]\nt = [0, 2]\nrtol = 1e-10\natol = 1e-12\n");
  // y' = -V tanh(g t/V - atanh(y'(0)/V)) with V^2 = m g/c
  const double V = std::sqrt(2 * 10 / 0.3), s = 10 * 2 / V, slope = 1 / (std::cosh(s) * std::cosh(s));
  const Json by_y_dot = gradients(
      folder, {"run", "model.toml", "--gradient", "y,y_dot", "--by", "y_dot", "--solver", "radau5"})["values"];
  constexpr double of_run = 1e-8;  // rtol 1e-10 over some 40 steps of radau5
  CHECK(by_y_dot["y_dot"]["y_dot"].get<double>() == doctest::Approx(slope).epsilon(of_run));
  CHECK(by_y_dot["y"]["y_dot"].get<double>() == doctest::Approx(V / 10 * std::tanh(s)).epsilon(of_run));
}

// Beside the motion, changes of x alone leave the shell: the time of an event does not follow them.
TEST_CASE("gradient: a particle that slides in a rough shell and leaves it has the derivatives of its sensitivities") {
  const Folder folder;
  folder.write(
      "model.toml",
      "format = 1\n[parameters]\nm = 0.3\na = 0.35\ng = 9.81\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition "
      "= { cartesian = [\"x\", \"y\"] }\n[[force]]\ngravity = \"-g*E2\"\n[[constraint]]\nname = \"c\"\nholonomic "
      "= \"a - norm(P)\"\nholds = \"unilateral\"\nfriction = { static = 0.3, dynamic = 0.3 }\n"
      "[scene.default]\nt = [0, 0.8]\ninitial = { x = 0, y = \"-a\", x_dot = 3.4 }\n");
  const Json run = document(folder, {"run", "model.toml", "--gradient", "x,y", "--by", "a", "--sensitivity", "a"});
  for (const char* state : {"x", "y"}) {
    CAPTURE(std::string(state));
    const double expected = run["sensitivities"]["values"]["a"][state];
    CHECK(run["gradients"]["values"][state]["a"].get<double>() == doctest::Approx(expected).epsilon(1e-7));
  }
}
