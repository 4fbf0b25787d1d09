// SPDX-License-Identifier: GPL-3.0-or-later
// The emitted Jacobian is the derivative of the emitted function, also at states that violate constraints, and its cost
// grows with the number of its entries.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "derive/trees/tensions.hpp"
#include "program/abi_functions.hpp"
#include "program/from_dag.hpp"
#include "program/interpret.hpp"
#include "support/simulation.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

constexpr int digits = 50;
// A difference quotient with steps of 1e-12 in 50 digits is right to some 1e-24.
constexpr double as_good_as_exact = 1e-18;

program::Arguments<cln::cl_R> random_arguments(const pipeline::DerivedModel& derived, const program::Program& program) {
  const cln::float_format_t precision = cln::float_format(digits);
  const auto value = [&](std::uint32_t k) {
    return cln::cl_float(symbolic::sample({symbolic::SymbolKind::auxiliary, k, 0}, 1), precision);
  };
  program::Arguments<cln::cl_R> at;
  at.t = value(0);
  for (std::uint32_t i = 0; i < 2 * program.free.size(); ++i) at.x.push_back(value(i + 1));
  for (std::uint32_t i = 0; i < derived.model.parameters.size(); ++i) at.p.push_back(value(100 + i));
  return at;
}

/// d(rhs)/d(argument) by a central difference, against column j of a Jacobian matrix: the largest relative difference.
double furthest(const program::Program& program, const program::Arguments<cln::cl_R>& base,
                const std::vector<cln::cl_R>& columns, std::size_t j,
                const std::function<cln::cl_R&(program::Arguments<cln::cl_R>&)>& pick) {
  const cln::cl_R step = cln::expt(cln::cl_RA(10), -12);
  auto above = base, below = base;
  pick(above) = pick(above) + step;
  pick(below) = pick(below) - step;
  const auto right = program::interpret(program.functions[0], above, digits).results[0],
             left = program::interpret(program.functions[0], below, digits).results[0];
  double most = 0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    const cln::cl_R slope = (right[i] - left[i]) / (2 * step);
    most = std::max(most, cln::double_approx(cln::abs(columns[j * right.size() + i] - slope) / (1 + cln::abs(slope))));
  }
  return most;
}

/// Compares `jac` and `jac_p`, which have to be the functions 1 and 2, with differences of the function 0.
void check_derivatives(const pipeline::DerivedModel& derived, const program::Program& program) {
  const auto base = random_arguments(derived, program);
  const auto jac = program::interpret(program.functions[1], base, digits).results[0];
  const auto jac_p = program::interpret(program.functions[2], base, digits).results[0];
  for (std::size_t j = 0; j < base.x.size(); ++j)
    CHECK(furthest(program, base, jac, j, [j](auto& a) -> cln::cl_R& { return a.x[j]; }) < as_good_as_exact);
  for (std::size_t j = 0; j < base.p.size(); ++j)
    CHECK(furthest(program, base, jac_p, j, [j](auto& a) -> cln::cl_R& { return a.p[j]; }) < as_good_as_exact);
}

}  // namespace

TEST_CASE(
    "in Euler parameters the Jacobian is that of the right-hand side in every direction, off the unit sphere too") {
  for (const char* name : {"R1_free_body_euler_parameters", "R2_ball_in_flight", "R17_follower_force", "heavy_top"}) {
    CAPTURE(name);
    const auto derived = pipeline::derive_model(test::model_at(model_path(name)), pipeline::ApproachChoice::automatic);
    program::Request request;
    request.with = {"jac", "jac_p"};
    const program::Program program = pipeline::make_program(*derived, request);
    check_derivatives(*derived, program);
  }
}

namespace {

/// A serial arm of pin joints, axes in turn along e3 and e2, every mass, length and inertia a parameter.
std::string arm(int joints) {
  std::string text = "format = 1\n[parameters]\ng = \"9.81 m/s^2\"\n", bodies, base;
  for (int k = 1; k <= joints; ++k) {
    const std::string own = std::to_string(k), before = "b" + std::to_string(k - 1), axis = k % 2 == 1 ? "3" : "2";
    for (const char* length : {"L", "c"}) {
      if (k < joints || length[0] == 'c') text += length + own + " = \"0.3 m\"\n";
    }
    text += "m" + own + " = \"1.2 kg\"\n";
    for (const char* inertia : {"A", "B", "C"}) text += inertia + own + " = \"0.02 kg*m^2\"\n";
    bodies += "[[body]]\nname = \"b" + own + "\"\nmass = \"m" + own + "\"\ninertia = { principal = [\"A" + own +
              "\", \"B" + own + "\", \"C" + own + "\"] }\nposition = \"" + base + "c" + own + "*b" + own +
              ".e1\"\nrotation = { axis = \"" + (k > 1 ? before + ".e" : "E") + axis + "\", angle = \"q" + own +
              "\" }\n" + (k > 1 ? "relative_to = \"" + before + "\"\n" : "");
    if (k < joints)
      bodies += "[[point]]\nname = \"J" + own + "\"\nposition = \"" + base + "L" + own + "*b" + own + ".e1\"\n";
    base = "J" + own + " + ";
  }
  return text + bodies + "[[force]]\ngravity = \"-g*E3\"\n";
}

}  // namespace

TEST_CASE("the Jacobian of a serial arm grows with the number of its entries and needs one factorisation") {
  struct Size {
    int joints;
    std::size_t flops;
  };
  for (const Size& size : {Size{7, 4400}, Size{20, 34'000}}) {
    CAPTURE(size.joints);
    const auto model = std::make_shared<const model::Model>(model::read_model_text(arm(size.joints), "arm"));
    const auto derived = pipeline::derive_model(model, pipeline::ApproachChoice::automatic);
    program::Request request;
    request.with = {"jac"};
    const program::Function jac = pipeline::make_program(*derived, request).functions[1];
    REQUIRE(jac.name == "jac");
    CHECK(jac.operations.flops() <= size.flops);
    CHECK(jac.operations.div <= static_cast<std::size_t>(size.joints));
  }
}

namespace {

program::Program with_jacobians(const std::string& text, std::unique_ptr<pipeline::DerivedModel>& derived) {
  const auto model = std::make_shared<const model::Model>(model::read_model_text(text, "tree"));
  derived = pipeline::derive_model(model, pipeline::ApproachChoice::automatic);
  program::Request request;
  request.with = {"jac", "jac_p"};
  return pipeline::make_program(*derived, request);
}

std::string particle(const std::string& name, const std::string& position) {
  return "[[particle]]\nname = \"" + name + "\"\nmass = \"m" + name + "\"\nposition = \"" + position + "\"\n";
}

std::string drag(const std::string& on) {
  return "[[force]]\ndrag = { on = \"" + on + "\", density = \"rho\", area = 0.3, coefficient = 0.5 }\n";
}

/// A planar chain, every mass and length a parameter.
std::string own_chain(int links) {
  std::string numbers, masses, lengths;
  for (int k = 1; k <= links; ++k) {
    const std::string own = std::to_string(k);
    numbers += "m" + own + " = \"1.2 kg\"\nL" + own + " = \"0.3 m\"\n";
    masses += (k > 1 ? ", \"m" : "\"m") + own + "\"";
    lengths += (k > 1 ? ", \"L" : "\"L") + own + "\"";
  }
  return "format = 1\n[parameters]\ng = \"9.81 m/s^2\"\n" + numbers +
         "[[chain]]\nname = \"P\"\nn = " + std::to_string(links) + "\nmass = [" + masses + "]\nlength = [" + lengths +
         "]\n[[force]]\ngravity = \"-g*E2\"\n";
}

const std::string of_trees = R"toml(format = 1
[parameters]
g = 9.81
rho = 1.2
L = 0.7
k = 3
mA = 1
mB = 2
mC = 3
mD = 4
[[force]]
gravity = "-g*E3"
)toml";

std::string with_angles(const std::vector<std::string>& names) {
  std::string text = of_trees + "[coordinates]\n";
  for (const std::string& name : names) text += name + " = \"rad\"\n";
  return text;
}

struct Tree {
  const char* name;
  std::string text;
};

const Tree trees[] = {
    {"a chain with springs between its angles, dampers and drag",
     with_angles({"a", "b", "c"}) + particle("A", "L*sin(a)*E1 - L*cos(a)*E3") +
         particle("B", "A + 2*L*sin(b)*E1 - 2*L*cos(b)*E3") + particle("C", "B + L*sin(c)*E1 - L*cos(c)*E3") +
         drag("C") + drag("A") + "[[force]]\ngeneralized = { a = \"-k*(a - b)\", b = \"-k*(b - a) - k*b_dot\" }\n"},
    {"branches", with_angles({"a", "b", "c", "d"}) + particle("A", "L*sin(a)*E1 - L*cos(a)*E3") +
                     particle("B", "A + 2*L*sin(b)*E1 - 2*L*cos(b)*E3") +
                     particle("C", "A + L*sin(c)*E1 - 3*L*cos(c)*E3") + particle("D", "C + L*sin(d)*E1 - L*cos(d)*E3")},
    {"relative angles", with_angles({"a", "b", "c"}) + particle("A", "L*sin(a)*E1 - L*cos(a)*E3") +
                            particle("B", "A + 2*L*sin(a + b)*E1 - 2*L*cos(a + b)*E3") +
                            particle("C", "B + L*sin(a + b + c)*E1 - L*cos(a + b + c)*E3") + drag("C")},
    {"relative angles with springs", with_angles({"a", "b", "c"}) + particle("A", "L*sin(a)*E1 - L*cos(a)*E3") +
                                         particle("B", "A + 2*L*sin(a + b)*E1 - 2*L*cos(a + b)*E3") +
                                         particle("C", "B + L*sin(a + b + c)*E1 - L*cos(a + b + c)*E3") +
                                         "[[force]]\ngeneralized = { b = \"-k*b - k*b_dot\" }\n"},
    {"rods in space", with_angles({"a", "b", "u", "v"}) +
                          particle("A", "L*sin(a)*cos(u)*E1 + L*sin(a)*sin(u)*E2 - L*cos(a)*E3") +
                          particle("B", "A + L*sin(b)*cos(v)*E1 + L*sin(b)*sin(v)*E2 - L*cos(b)*E3") +
                          "[[force]]\ngeneralized = { a = \"-k*(a - b)\" }\n"},
};

system::EquationSystem with_tensions(pipeline::DerivedModel& derived) {
  const auto found = std::find_if(derived.candidates.begin(), derived.candidates.end(),
                                  [](const auto& system) { return system.formulation == "articulated"; });
  REQUIRE(found != derived.candidates.end());
  system::EquationSystem result = *found;
  result.solution->forces = derive::tree_tensions(derived.mechanics);
  REQUIRE(result.solution->forces.has_value());
  return result;
}

}  // namespace

TEST_CASE("Jacobians by the tensions of a tree of particles are those by the mass matrix, with forces too") {
  const auto value = [](const symbolic::Symbol& s) -> cln::cl_R { return symbolic::sample(s, 1); };
  for (const Tree& tree : trees) {
    INFO(std::string(tree.name));
    std::unique_ptr<pipeline::DerivedModel> derived;
    const program::Program program = with_jacobians(tree.text, derived);
    check_derivatives(*derived, program);
    const system::EquationSystem by_tensions = with_tensions(*derived);
    system::EquationSystem by_mass = by_tensions;
    by_mass.solution->forces.reset();
    program::AbiFunctions tensions(by_tensions, {}), mass(by_mass, {});
    const std::size_t parameters = derived->model.parameters.size();
    for (const auto& [left, right] :
         {std::pair{tensions.jac(), mass.jac()}, {tensions.jac_p(parameters), mass.jac_p(parameters)}}) {
      const auto got = symbolic::evaluate(*by_mass.dag, left.results[0].entries, value, digits),
                 wanted = symbolic::evaluate(*by_mass.dag, right.results[0].entries, value, digits);
      REQUIRE(got.size() == wanted.size());
      for (std::size_t i = 0; i < got.size(); ++i)
        CHECK(cln::abs(got[i] - wanted[i]) <= as_good_as_exact * (1 + cln::abs(wanted[i])));
    }
  }
}

TEST_CASE("the Jacobian of a chain grows with the number of its entries: two operations for each") {
  for (const int links : {6, 20, 40}) {
    CAPTURE(links);
    std::unique_ptr<pipeline::DerivedModel> derived;
    const program::Program program = with_jacobians(own_chain(links), derived);
    const auto entries = static_cast<std::size_t>(2 * links * links);
    CHECK(program.functions[1].operations.flops() <= 2 * entries + 60 * static_cast<std::size_t>(links));
    if (links == 6) check_derivatives(*derived, program);
  }
}

TEST_CASE("drag has the slope 0 at rest in the Jacobian by tensions, also in relative angles") {
  for (const std::size_t index : {std::size_t{0}, std::size_t{2}}) {
    INFO(std::string(trees[index].name));
    std::unique_ptr<pipeline::DerivedModel> derived;
    const program::Program program = with_jacobians(trees[index].text, derived);
    const system::EquationSystem by_tensions = with_tensions(*derived);
    const std::size_t n = by_tensions.free.size();
    const program::FunctionExpressions wanted = program::AbiFunctions(by_tensions, {}).jac();
    program::PolynomialGraph graph = program::from_dag(*by_tensions.dag, wanted, by_tensions.free);
    program::reduce_pivots(graph);
    const program::Function jac =
        program::schedule(program::flatten(graph, false), "jac",
                          {{"dfdx", wanted.results[0].entries.size()}, {"dfdt", wanted.results[1].entries.size()}});
    program::Arguments<double> at;
    const auto exact = random_arguments(*derived, program);
    for (std::size_t i = 0; i < 2 * n; ++i) at.x.push_back(i < n ? cln::double_approx(exact.x[i]) : 0);
    for (const cln::cl_R& value : exact.p) at.p.push_back(cln::double_approx(value));
    const std::vector<double> dfdx = program::interpret(jac, at).results[0];
    for (const double entry : dfdx) CHECK(std::isfinite(entry));
    // The second tree has no other damping.
    for (std::size_t j = n; j < 2 * n && index == 2; ++j) {
      for (std::size_t i = n; i < 2 * n; ++i) CHECK(dfdx[j * 2 * n + i] == 0);
    }
  }
}

TEST_CASE("a single particle has no tensions as unknowns: its mass cancels in the equations") {
  std::unique_ptr<pipeline::DerivedModel> derived;
  with_jacobians(with_angles({"a"}) + particle("A", "L*sin(a)*E1 - L*cos(a)*E3") + drag("A"), derived);
  CHECK_FALSE(derive::tree_tensions(derived->mechanics).has_value());
}

namespace {

/// The largest error of `jac` in binary64, relative to the largest entry of its column.
double error_in_binary64(const program::Function& jac, std::size_t states, std::size_t parameters) {
  constexpr std::uint64_t points = 20;
  double most = 0;
  for (std::uint64_t point = 0; point < points; ++point) {
    program::Arguments<double> at;
    program::Arguments<cln::cl_R> exactly;
    const auto put = [&](std::uint32_t k, double factor, std::vector<double>& values, std::vector<cln::cl_R>& exact) {
      values.push_back(factor * symbolic::sample_double({symbolic::SymbolKind::auxiliary, k, 0}, point));
      exact.push_back(cln::cl_float(cln::rational(cln::cl_DF(values.back())), cln::float_format(digits)));
    };
    for (std::uint32_t i = 0; i < states; ++i) put(i, 3, at.x, exactly.x);
    for (std::uint32_t i = 0; i < parameters; ++i) put(100 + i, 1, at.p, exactly.p);
    const std::vector<double> got = program::interpret(jac, at).results[0];
    const std::vector<cln::cl_R> wanted = program::interpret(jac, exactly, digits).results[0];
    for (std::size_t j = 0; j < states; ++j) {
      double largest = 0, error = 0;
      for (std::size_t i = j * states; i < (j + 1) * states; ++i) {
        largest = std::max(largest, std::abs(cln::double_approx(wanted[i])));
        error = std::max(error, std::abs(cln::double_approx(wanted[i] - cln::cl_DF(got[i]))));
      }
      most = std::max(most, error / largest);
    }
  }
  return most;
}

}  // namespace

TEST_CASE("the Jacobian by tensions keeps the digits of that by the mass matrix, and more") {
  std::unique_ptr<pipeline::DerivedModel> derived;
  const program::Program by_tensions = with_jacobians(own_chain(20), derived);
  program::Request request;
  request.with = {"jac"};
  const program::Program by_mass = program::build_program(derived->candidates, request);
  const std::size_t parameters = derived->model.parameters.size();
  const double tensions = error_in_binary64(by_tensions.functions[1], 40, parameters),
               mass = error_in_binary64(by_mass.functions[1], 40, parameters);
  CHECK(tensions < mass);
}
