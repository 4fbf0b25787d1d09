// SPDX-License-Identifier: GPL-3.0-or-later
// The functions `regressor` and `momentum` of the ABI.
#include "derive/inertias.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "derive/frames.hpp"
#include "model/model.hpp"
#include "program/build.hpp"
#include "program/interpret.hpp"
#include "program_certificate.hpp"

using namespace eomgen;

namespace {

constexpr const char* inertia_numbers = R"(format = 1
[parameters]
m = "2 kg"
L = "0.7 m"
b = "0.3 m"
A = "0.2 kg*m^2"
B = "0.3 kg*m^2"
C = "0.4 kg*m^2"
D = "0.05 kg*m^2"
w = "1.3 rad/s"
g = "9.81 m/s^2"
)";
const std::string gravity = "[[force]]\ngravity = \"-g*E2\"\n", scene = "[scene.default]\nt = [0, 1]\n";

std::string solid(const std::string& name, const std::string& position, const std::string& rotation,
                  const std::string& parent = "") {
  return "[[body]]\nname = \"" + name +
         "\"\nmass = \"m\"\ninertia = [[\"A\", \"D\", \"0\"], [\"D\", \"B\", \"-D\"], [\"0\", \"-D\", "
         "\"C\"]]\nposition "
         "= " +
         position + "\nrotation = " + rotation + "\n" + (parent.empty() ? "" : "relative_to = \"" + parent + "\"\n");
}
std::string particle(const std::string& name, const std::string& position) {
  return "[[particle]]\nname = \"" + name + "\"\nmass = \"m\"\nposition = " + position + "\n";
}
const std::string rod = solid("rod", "\"b*rod.e1\"", "{ axis = \"E3\", angle = \"q\" }"),
                  second = solid("arm", "\"L*rod.e1 + b*arm.e1\"", "{ axis = \"rod.e2\", angle = \"p\" }", "rod");

struct Functions {
  std::unique_ptr<mechanics::Mechanics> mechanics;
  std::vector<system::EquationSystem> systems;
  program::Program program;

  std::vector<std::vector<double>> at(const std::string& name, double t, std::vector<double> x,
                                      std::vector<double> v = {}) const {
    program::Arguments<double> arguments;
    arguments.t = t;
    arguments.x = std::move(x);
    arguments.v = std::move(v);
    for (const model::Parameter& p : mechanics->model->parameters)
      arguments.p.push_back(cln::double_approx(mechanics->model->arena[p.value].value));
    const auto found = std::find_if(program.functions.begin(), program.functions.end(),
                                    [&name](const program::Function& f) { return f.name == name; });
    REQUIRE(found != program.functions.end());
    return program::interpret(*found, arguments).results;
  }
};

using InertiaChange = std::function<void(symbolic::Dag&, system::Inertias&)>;

Functions functions_of(const std::string& text, const InertiaChange& change = nullptr) {
  Functions result;
  result.mechanics =
      std::make_unique<mechanics::Mechanics>(mechanics::build_mechanics(model::read_model_text(text, "inertias")));
  result.systems = verify::all_formulations(*result.mechanics);
  program::Request request;
  request.with = {"regressor", "momentum", "inverse"};
  request.frames = [&] { return derive::frames(*result.mechanics); };
  request.inertias = [&] {
    system::Inertias inertias = derive::inertias(*result.mechanics);
    if (change) change(*result.mechanics->dag, inertias);
    return inertias;
  };
  std::vector<system::EquationSystem> chosen{result.systems.front()};
  result.program = program::build_program(chosen, request);
  return result;
}

verify::Certificate certificate_of(const Functions& functions) {
  return test::certify_program(*functions.mechanics, functions.systems, functions.program,
                               {"rhs", "regressor", "momentum", "inverse"});
}

bool is_confirmed(const verify::Certificate& certificate, const std::string& what) {
  const auto row = std::find_if(certificate.comparisons.begin(), certificate.comparisons.end(),
                                [&](const verify::Comparison& c) { return c.a == what + " of program"; });
  REQUIRE(row != certificate.comparisons.end());
  return row->pass;
}

const std::string rolling_disk =
    std::string(inertia_numbers) +
    solid("disk", "{ cartesian = [\"x\", \"y\", \"z\"] }",
          "{ euler = \"313\", angles = [\"psi\", \"theta\", \"phi\"] }") +
    "[[constraint]]\nname = \"floor\"\nrolling = { body = \"disk\", at = \"-L*disk.e2''\", on = \"ground\" }\n" +
    gravity + "[scene.default]\nt = [0, 1]\ninitial = { theta = 1, phi_dot = 2 }\n";

}  // namespace

TEST_CASE("inertias: regressors and momenta of arms, driven bodies, quaternions and particles agree with the oracle") {
  const std::string head = inertia_numbers;
  const std::string driven =
      solid("crank", "\"L*cos(w*t)*E1 + L*sin(w*t)*E2\"", "{ euler = \"313\", angles = [\"psi\", \"w*t\", \"phi\"] }");
  const std::string four =
      solid("top", "{ cartesian = [\"x\", \"y\", \"z\"] }", "{ euler_parameters = [\"p0\", \"p1\", \"p2\", \"p3\"] }");
  const std::string prescribed = "[functions]\nd = \"L*sin(w*t)\"\n" +
                                 particle("cart", "{ cartesian = [\"x\", \"y\"] }") +
                                 "[[constraint]]\nname = \"drive\"\nholonomic = \"x - d\"\n" +
                                 solid("bob", "\"cart + b*bob.e1\"", "{ axis = \"E3\", angle = \"alpha\" }");
  const std::string two = particle("P", "{ spherical = [\"R\", \"phi\", \"theta\"] }") +
                          particle("Q", "{ cylindrical = [\"r\", \"psi\", \"z\"], from = \"P\" }");
  // A rail along E2 by a quarter turn, whose cosine is 0 but for rounding in the oracle.
  const std::string rail = "[[frame]]\nname = \"F\"\nrotation = { axis = \"E3\", angle = \"pi/2\" }\n" +
                           particle("P", "\"x*F.e1\"") + "[coordinates]\nx = \"m\"\n";
  for (const std::string& text :
       {head + rod + second + gravity + scene, head + driven + scene, head + four + gravity + scene,
        head + prescribed + gravity + scene, head + two + scene, head + rail + gravity + scene, rolling_disk}) {
    const Functions functions = functions_of(text);
    const verify::Certificate certificate = certificate_of(functions);
    INFO(certificate.summary());
    CHECK(certificate.pass);
    CHECK(is_confirmed(certificate, "regressor"));
    CHECK(is_confirmed(certificate, "momentum"));
  }
}

TEST_CASE("inertias: Y times the parameters is inverse dynamics") {
  const Functions functions = functions_of(std::string(inertia_numbers) + rod + second + gravity + scene);
  const std::vector<double> x{0.4, -0.7, 1.2, 2.1}, v{0.3, -1.9};
  const auto regressor = functions.at("regressor", 0, x, v);
  const std::vector<double> tau = functions.at("inverse", 0, x, v)[0];
  REQUIRE(regressor[1].size() == derive::inertial_parameter_names(*functions.mechanics->model).size());
  for (std::size_t i = 0; i < 2; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < regressor[1].size(); ++j) sum += regressor[0][i + 2 * j] * regressor[1][j];
    CHECK(sum == doctest::Approx(tau[i]).epsilon(1e-12));
  }
}

TEST_CASE("inertias: a pendulum has the columns of the textbook") {
  const Functions functions = functions_of(std::string(inertia_numbers) + rod + gravity + scene);
  const std::vector<std::string> names = derive::inertial_parameter_names(*functions.mechanics->model);
  CHECK(names == std::vector<std::string>{"rod.inertia11", "rod.inertia12", "rod.inertia13", "rod.inertia22",
                                          "rod.inertia23", "rod.inertia33", "rod.moment1", "rod.moment2", "rod.moment3",
                                          "rod.mass"});
  const double q = 0.4, a = -1.3, b = 0.3, g = 9.81;
  const auto regressor = functions.at("regressor", 0, {q, 1.7}, {a});
  const std::vector<double> row{
      0, 0, 0, 0, 0, a, 2 * b * a + g * std::cos(q), -g * std::sin(q), 0, b * b * a + b * g * std::cos(q)};
  for (std::size_t j = 0; j < row.size(); ++j) CHECK(regressor[0][j] == doctest::Approx(row[j]).epsilon(1e-13));
  const std::vector<double> values{0.2, 0.05, 0, 0.3, -0.05, 0.4, 0, 0, 0, 2};
  for (std::size_t j = 0; j < values.size(); ++j) CHECK(regressor[1][j] == doctest::Approx(values[j]).epsilon(1e-14));
}

TEST_CASE("inertias: the momentum of a body that nothing holds is that of its mass and spin") {
  const Functions functions =
      functions_of(std::string(inertia_numbers) +
                   solid("rod", "{ cartesian = [\"x\", \"y\"] }", "{ axis = \"E3\", angle = \"q\" }") + scene);
  const auto momentum = functions.at("momentum", 0, {0.3, -0.2, 0.9, 1.1, 0.7, 2});
  const double c = std::cos(0.9), s = std::sin(0.9);
  const std::vector<double> whole{s * 0.05 * 2, -c * 0.05 * 2, 0.4 * 2, 2 * 1.1, 2 * 0.7, 0}, centre{0.3, -0.2, 0};
  for (std::size_t i = 0; i < 6; ++i) CHECK(momentum[1][i] == doctest::Approx(whole[i]).epsilon(1e-13));
  for (std::size_t i = 0; i < 3; ++i) CHECK(momentum[2][i] == doctest::Approx(centre[i]).epsilon(1e-13));
  for (std::size_t c6 = 0; c6 < 6; ++c6)
    CHECK(momentum[0][c6] * 1.1 + momentum[0][6 + c6] * 0.7 + momentum[0][12 + c6] * 2 ==
          doctest::Approx(whole[c6]).epsilon(1e-13));
}

TEST_CASE("inertias: wrong masses, tensors, spins and gravity are found") {
  using symbolic::Ref;
  const auto scaled = [](symbolic::Dag& dag, Ref& r) { r = dag.mul(r, dag.constant(symbolic::Rational(1001) / 1000)); };
  const std::vector<std::pair<std::string, InertiaChange>> changes{
      {"regressor", [&](symbolic::Dag& dag, system::Inertias& all) { scaled(dag, all.of.back().mass); }},
      {"momentum", [&](symbolic::Dag& dag, system::Inertias& all) { scaled(dag, all.of.back().mass); }},
      {"regressor", [&](symbolic::Dag& dag, system::Inertias& all) { scaled(dag, all.of.back().body->tensor[1]); }},
      {"momentum", [&](symbolic::Dag& dag, system::Inertias& all) { scaled(dag, all.of.back().body->tensor[1]); }},
      {"regressor", [&](symbolic::Dag& dag, system::Inertias& all) { scaled(dag, all.of.back().body->spin[0]); }},
      {"regressor", [&](symbolic::Dag& dag, system::Inertias& all) { scaled(dag, all.of.back().body->bias[0]); }},
      {"momentum", [&](symbolic::Dag& dag, system::Inertias& all) { scaled(dag, all.of.back().body->spin[2]); }},
      {"regressor", [&](symbolic::Dag& dag, system::Inertias& all) { scaled(dag, all.gravity[1]); }}};
  for (std::size_t k = 0; k < changes.size(); ++k) {
    CAPTURE(k);
    const Functions functions =
        functions_of(std::string(inertia_numbers) + rod + second + gravity + scene, changes[k].second);
    CHECK_FALSE(is_confirmed(certificate_of(functions), changes[k].first));
  }
}

TEST_CASE("inertias: the regressor of an arm of seven joints takes few operations") {
  std::string text = inertia_numbers, base;
  for (int k = 1; k <= 7; ++k) {
    const std::string name = "b" + std::to_string(k), before = "b" + std::to_string(k - 1);
    text += solid(name, "\"" + base + "b*" + name + ".e1\"",
                  "{ axis = \"" + (k > 1 ? before + ".e" : std::string("E")) + (k % 2 == 1 ? "3" : "2") +
                      "\", angle = \"q" + std::to_string(k) + "\" }",
                  k > 1 ? before : "");
    text += "[[point]]\nname = \"J" + std::to_string(k) + "\"\nposition = \"" + base + "L*" + name + ".e1\"\n";
    base = "J" + std::to_string(k) + " + ";
  }
  const Functions functions = functions_of(text + gravity + scene);
  for (const program::Function& function : functions.program.functions) {
    MESSAGE(function.name << ": " << function.operations.flops());
    if (function.name == "regressor") CHECK(function.operations.flops() < 4000);
    if (function.name == "momentum") CHECK(function.operations.flops() < 2500);
  }
}
