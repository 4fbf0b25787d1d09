// SPDX-License-Identifier: GPL-3.0-or-later
// The function `frames` of the ABI: poses, Jacobians and bias accelerations of bodies, particles and points.
#include "derive/frames.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "model/model.hpp"
#include "program/build.hpp"
#include "program/interpret.hpp"
#include "program_certificate.hpp"

using namespace eomgen;

namespace {

constexpr const char* frame_numbers = R"(format = 1
[parameters]
m = "2 kg"
L = "0.7 m"
b = "0.3 m"
A = "0.2 kg*m^2"
B = "0.3 kg*m^2"
C = "0.4 kg*m^2"
w = "1.3 rad/s"
)";
constexpr const char* scene = "[scene.default]\nt = [0, 1]\n";

std::string link(const std::string& name, const std::string& position, const std::string& rotation,
                 const std::string& parent = "") {
  return "[[body]]\nname = \"" + name +
         "\"\nmass = \"m\"\ninertia = { principal = [\"A\", \"B\", \"C\"] }\nposition = " + position +
         "\nrotation = " + rotation + "\n" + (parent.empty() ? "" : "relative_to = \"" + parent + "\"\n");
}
std::string point(const std::string& name, const std::string& position) {
  return "[[point]]\nname = \"" + name + "\"\nposition = \"" + position + "\"\n";
}

/// A serial arm: axes in turn along e3 and e2 of the link before, a point at each joint.
std::string arm(std::size_t n) {
  std::string text = frame_numbers, base;
  for (std::size_t k = 1; k <= n; ++k) {
    const std::string name = "b" + std::to_string(k), before = "b" + std::to_string(k - 1),
                      axis = k % 2 == 1 ? "3" : "2";
    text += link(name, "\"" + base + "b*" + name + ".e1\"",
                 "{ axis = \"" + (k > 1 ? before + ".e" : "E") + axis + "\", angle = \"q" + std::to_string(k) + "\" }",
                 k > 1 ? before : "");
    if (k < n) text += point("J" + std::to_string(k), base + "L*" + name + ".e1");
    base = "J" + std::to_string(k) + " + ";
  }
  return text + scene;
}

struct Frames {
  std::unique_ptr<mechanics::Mechanics> mechanics;
  std::vector<system::EquationSystem> systems;
  program::Program program;
  const model::Model& model() const { return *mechanics->model; }
  const program::Function& function() const {
    return *std::find_if(program.functions.begin(), program.functions.end(),
                         [](const program::Function& f) { return f.name == "frames"; });
  }
  /// pose, J, bias at a state.
  std::vector<std::vector<double>> at(double t, std::vector<double> x) const {
    program::Arguments<double> arguments;
    arguments.t = t;
    arguments.x = std::move(x);
    for (const model::Parameter& p : model().parameters)
      arguments.p.push_back(cln::double_approx(model().arena[p.value].value));
    return program::interpret(function(), arguments).results;
  }
};

Frames frames_of(const std::string& text, const std::function<void(symbolic::Dag&, system::Frame&)>& change = nullptr) {
  Frames result;
  result.mechanics =
      std::make_unique<mechanics::Mechanics>(mechanics::build_mechanics(model::read_model_text(text, "frames")));
  result.systems = verify::all_formulations(*result.mechanics);
  program::Request request;
  request.with = {"frames"};
  request.frames = [&] {
    std::vector<system::Frame> frames = derive::frames(*result.mechanics);
    if (change) change(*result.mechanics->dag, frames.back());
    return frames;
  };
  std::vector<system::EquationSystem> first{result.systems.front()};
  result.program = program::build_program(first, request);
  return result;
}

verify::Certificate certificate_of(const Frames& frames) {
  return test::certify_program(*frames.mechanics, frames.systems, frames.program, {"rhs", "frames"});
}

bool agrees(const verify::Certificate& certificate, const std::string& what) {
  const auto row =
      std::find_if(certificate.comparisons.begin(), certificate.comparisons.end(),
                   [&](const verify::Comparison& c) { return c.a == what + " of program" && !c.shares_code; });
  REQUIRE(row != certificate.comparisons.end());
  return row->pass;
}

void check_frames(const std::string& text) {
  Frames frames = frames_of(text);
  const verify::Certificate certificate = certificate_of(frames);
  INFO(certificate.summary());
  CHECK(certificate.pass);
  for (const char* what : {"poses of frames", "Jacobians of frames", "accelerations of frames"})
    CHECK(agrees(certificate, what));
}

const std::string disk =
    std::string(frame_numbers) +
    link("disk", "{ cartesian = [\"x\", \"y\", \"z\"] }",
         "{ euler = \"313\", angles = [\"psi\", \"theta\", \"phi\"] }") +
    "[[constraint]]\nname = \"floor\"\nrolling = { body = \"disk\", at = \"-L*disk.e2''\", on = \"ground\" }\n" +
    point("rim", "disk + L*disk.e1") + "[scene.default]\nt = [0, 1]\ninitial = { theta = 1, phi_dot = 2 }\n";

}  // namespace

TEST_CASE("frames: arms, driven bodies, quaternions, a rolling disk and particles agree with the oracle") {
  const std::string driven =
      frame_numbers +
      link("crank", "\"L*cos(w*t)*E1 + L*sin(w*t)*E2\"", "{ euler = \"313\", angles = [\"psi\", \"w*t\", \"phi\"] }") +
      point("tip", "crank + b*w*t*crank.e2 + b*crank.e3") + point("far", "2*tip - crank + L*E3") + scene;
  const std::string four =
      frame_numbers +
      link("top", "{ cartesian = [\"x\", \"y\", \"z\"] }", "{ euler_parameters = [\"p0\", \"p1\", \"p2\", \"p3\"] }") +
      point("mark", "top + b*top.e1 - L*top.e3") + scene;
  const std::string charts =
      std::string(frame_numbers) +
      "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { spherical = [\"R\", \"phi\", \"theta\"] }\n"
      "[[particle]]\nname = \"Q\"\nmass = \"m\"\nposition = { cylindrical = [\"r\", \"psi\", \"z\"], from = \"P\" }\n" +
      point("between", "(P + Q)/2 + b*unit(P - Q)") + point("across", "cross(P, Q)/L") + scene;
  const std::string prescribed =
      std::string(frame_numbers) +
      "[functions]\nd = \"L*sin(w*t)\"\n[[particle]]\nname = \"cart\"\nmass = \"m\"\nposition = { cartesian = [\"x\", "
      "\"y\"] }\n[[constraint]]\nname = \"drive\"\nholonomic = \"x - d\"\n" +
      link("bob", "\"cart + b*bob.e1\"", "{ axis = \"E3\", angle = \"alpha\" }") + scene;
  // Two bodies with the same axes: the point is fixed in one of them.
  const std::string slide = frame_numbers + link("rail", "\"0*E1\"", "{ axis = \"E3\", angle = \"q\" }") +
                            link("slide", "\"s*rail.e1\"", "{ fixed = true }", "rail") +
                            point("hook", "slide + b*slide.e2") + "[coordinates]\ns = \"m\"\n" + scene;
  for (const std::string& text : {arm(4), driven, four, charts, prescribed, disk, slide}) check_frames(text);
}

TEST_CASE("frames: a planar pendulum has the Jacobian and the bias of the textbook") {
  const Frames frames = frames_of(frame_numbers + link("rod", "\"b*rod.e1\"", "{ axis = \"E3\", angle = \"q\" }") +
                                  point("tip", "L*rod.e1") + scene);
  CHECK(derive::frame_names(frames.model()) == std::vector<std::string>{"rod", "tip"});
  const double q = 0.4, v = -1.7, c = std::cos(q), s = std::sin(q);
  const auto values = frames.at(0, {q, v});
  const std::vector<double> axes{c, s, 0, -s, c, 0, 0, 0, 1};
  for (std::size_t k = 0; k < 2; ++k) {
    const double r = k == 0 ? 0.3 : 0.7;
    const std::vector<double> position{r * c, r * s, 0}, J{-r * s, r * c, 0, 0, 0, 1},
        bias{-r * c * v * v, -r * s * v * v, 0, 0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) CHECK(values[0][12 * k + i] == doctest::Approx(position[i]).epsilon(1e-14));
    for (std::size_t i = 0; i < 9; ++i) CHECK(values[0][12 * k + 3 + i] == doctest::Approx(axes[i]).epsilon(1e-14));
    for (std::size_t i = 0; i < 6; ++i) {
      CHECK(values[1][6 * k + i] == doctest::Approx(J[i]).epsilon(1e-14));
      CHECK(values[2][6 * k + i] == doctest::Approx(bias[i]).epsilon(1e-14));
    }
  }
}

TEST_CASE("frames: points that a body carries have its axes, all others the fixed ones") {
  const std::string text = std::string(frame_numbers) + "[coordinates]\ns = \"m\"\n" +
                           link("rod", "\"b*rod.e1\"", "{ axis = \"E3\", angle = \"q\" }") +
                           link("slide", "\"s*rod.e1\"", "{ axis = \"rod.e3\", angle = \"a\" }", "rod") +
                           point("tip", "rod + L*rod.e1") + point("same", "tip") + point("moving", "rod + s*rod.e2") +
                           point("still", "L*E1") + point("beside", "slide + b*rod.e1") +
                           "[[point]]\nname = \"on\"\non = \"slide\"\nat = [\"b\", \"L\", \"0\"]\n" + scene;
  const Frames frames = frames_of(text);
  std::map<std::string, std::string> carrier;
  const std::vector<std::string> names = derive::frame_names(frames.model());
  const std::vector<system::Frame> all = derive::frames(*frames.mechanics);
  REQUIRE(all.size() == names.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    carrier[names[k]] = all[k].axes == 0 ? "" : frames.model().frames[all[k].axes].name;
  CHECK(carrier["rod"] == "rod");
  CHECK(carrier["tip"] == "rod");
  CHECK(carrier["same"] == "rod");
  CHECK(carrier["moving"] == "");
  CHECK(carrier["still"] == "");
  CHECK(carrier["beside"] == "");
  CHECK(carrier["on"] == "slide");
}

TEST_CASE("frames: wrong axes, velocities and biases are found") {
  using symbolic::Ref;
  using system::Frame;
  const std::map<std::string, std::function<Ref&(Frame&)>> parts{
      {"poses of frames", [](Frame& f) -> Ref& { return f.rotation[1]; }},
      {"Jacobians of frames", [](Frame& f) -> Ref& { return f.velocity[4]; }},
      {"accelerations of frames", [](Frame& f) -> Ref& { return f.bias[0]; }}};
  for (const auto& [what, part] : parts) {
    const auto& pick = part;
    Frames frames = frames_of(disk, [&pick](symbolic::Dag& dag, Frame& frame) {
      Ref& r = pick(frame);
      r = dag.mul(r, dag.constant(symbolic::Rational(1001) / 1000));
    });
    CHECK_FALSE(agrees(certificate_of(frames), what));
  }
}

TEST_CASE("frames: the Jacobians of an arm are cross products, not derivatives of rotation matrices") {
  const program::Operations operations = frames_of(arm(7)).function().operations;
  CHECK(operations.flops() < 900);
  CHECK(operations.trig == 14);
  CHECK(operations.div == 0);
}
