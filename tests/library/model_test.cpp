// SPDX-License-Identifier: GPL-3.0-or-later
// Every function of the library on models with known results.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "library/example_definitions.hpp"

using namespace eomgen;

namespace {

double value(const Derivation& d, std::uint32_t index, const std::map<std::string, double>& at) {
  const Node& node = d.nodes.at(index);
  const auto arg = [&](std::size_t i) { return value(d, node.args.at(i), at); };
  if (node.op == "symbol") return at.at(node.text);
  if (node.op == "number") {
    const std::size_t slash = node.text.find('/');
    return slash == std::string::npos ? std::stod(node.text)
                                      : std::stod(node.text) / std::stod(node.text.substr(slash + 1));
  }
  if (node.op == "+") return arg(0) + arg(1);
  if (node.op == "-") return arg(0) - arg(1);
  if (node.op == "*") return arg(0) * arg(1);
  if (node.op == "/") return arg(0) / arg(1);
  if (node.op == "neg") return -arg(0);
  if (node.op == "^") return std::pow(arg(0), node.arity == 1 ? std::stod(node.text) : arg(1));
  if (node.op == "sin") return std::sin(arg(0));
  if (node.op == "cos") return std::cos(arg(0));
  FAIL("unexpected ", node.op);
  return 0;
}

}  // namespace

TEST_CASE("library: the spherical pendulum: examination, equations, compiled form") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  const Examination found = model.examine();
  CHECK(found.degrees_of_freedom == 2);
  CHECK(found.eliminated == std::vector<std::string>{"r"});
  REQUIRE(found.coordinate_units.size() == 3);
  CHECK(found.coordinate_units[1].unit == "rad");
  REQUIRE(found.parameters.size() == 3);
  CHECK(found.parameters[0].name == "m");
  CHECK(found.parameters[0].unit == "kg");
  CHECK(found.parameters[0].value == "1");
  CHECK(model.text() == test::pendulum().text());
  REQUIRE(found.constraints.size() == 1);
  CHECK(found.constraints[0].kind == "holonomic");
  CHECK(std::any_of(found.conserved.begin(), found.conserved.end(), [](const auto& c) { return c.name == "energy"; }));

  const Equations equations = model.equations({.approach = Approach::one});
  CHECK(equations.approach == "I");
  CHECK(equations.latex().find("\\dot{\\theta}") != std::string::npos);
  CHECK(equations.text("reactions").find("lambda") != std::string::npos);

  const std::string article = model.latex_document();
  CHECK(article.starts_with("\\documentclass"));
  CHECK(article.find("\\dot{\\theta}") != std::string::npos);

  const Derivation d = model.derivation();
  CHECK(d.coordinates == std::vector<std::string>{"phi", "theta"});
  REQUIRE(d.M.size() == 4);
  const double m = 1.5, L = 0.7, g = 9.81, phi = 0.4, theta_dot = 1.3;
  const std::map<std::string, double> at{
      {"m", m}, {"L", L}, {"g", g}, {"phi", phi}, {"theta", 2}, {"phi_dot", 0.3}, {"theta_dot", theta_dot}, {"t", 0}};
  CHECK(value(d, d.M[0], at) == doctest::Approx(m * L * L).epsilon(1e-14));
  CHECK(value(d, d.M[3], at) == doctest::Approx(m * L * L * std::sin(phi) * std::sin(phi)).epsilon(1e-14));
  // m L^2 phi'' = m L^2 sin cos theta'^2 + m g L sin, with phi from the vertical
  CHECK(value(d, d.f[0], at) ==
        doctest::Approx(m * L * L * std::sin(phi) * std::cos(phi) * theta_dot * theta_dot + m * g * L * std::sin(phi))
            .epsilon(1e-13));
}

TEST_CASE("library: verification, code generation and run, with stored rows and with a callback") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  const Certificate certificate = model.verify({.points = 3, .compile = false});
  CHECK(certificate.pass);
  CHECK(certificate.points == 3);
  CHECK(certificate.comparisons.size() > 3);

  const Sources sources = model.emit({.target = "c", .extra_functions = {"jac"}});
  CHECK(std::any_of(sources.files.begin(), sources.files.end(), [](const SourceFile& f) {
    return f.name == "pendulum.c" && f.text.find("pendulum_jac(") != std::string::npos;
  }));
  CHECK(sources.single_precision_error == 0);
  CHECK_THROWS_AS(model.emit({.target = "fortran77"}), Error);
  const Sources single = model.emit({.target = "c", .real_type = "float"});
  CHECK(single.files.front().text.find("double ") == std::string::npos);
  CHECK(single.single_precision_error > 0);
  CHECK(single.single_precision_error < 1e-5);
  CHECK_THROWS_AS(model.emit({.real_type = "half"}), Error);

  const Motion motion = model.run({.every = 0.5});
  CHECK(motion.outcome == "done");
  CHECK(motion.is_complete());
  CHECK(motion.times == std::vector<double>{0, 0.5, 1, 1.5, 2});
  REQUIRE(motion.columns.size() == 7);
  CHECK(motion.columns.back() == "energy");
  CHECK(motion.rows.back()[2] == motion.final_value("phi"));
  CHECK_THROWS_AS((void)motion.final_value("no such"), std::out_of_range);
  for (const Invariant& i : motion.invariants) CHECK(i.max_relative_drift < 1e-8);
  CHECK(motion.error_estimate.back().second < 1e-6);

  std::size_t rows = 0;
  const Motion other =
      model.run({.parameters = {{"g", 0}}, .every = 0.5, .row = [&rows](double, std::span<const double> values) {
                   rows += values.size() / 7;
                 }});
  CHECK(rows == 5);
  CHECK(other.rows.empty());
  // Without gravity: a great circle at the initial speed.
  const double speed = 2 * 2 * std::sin(1.0);
  CHECK(other.final_value("energy") == doctest::Approx(speed * speed / 2).epsilon(1e-9));
  CHECK_THROWS_AS(model.run({.solver = "euler1768"}), Error);
  CHECK_THROWS_AS(model.run({.parameters = {{"g", NAN}}}), Error);
}

TEST_CASE("library: linearisation, steady motions, inverse dynamics, benchmark, stress test") {
  Definition d("Pendulum");
  d.set("coordinates", "q", Value::table({}));
  d.set("energy", "kinetic", "1/2*q_dot^2").set("energy", "potential", "-4*cos(q)");
  d.set("scene.default", "t", Value::list({0, 1}));
  d.set("scene.default", "initial", Value::table({{"q", 0}}));
  const Model model = Model::from(d, "pendulum");
  const Linearisation l = model.linearise();
  CHECK(l.kind == "equilibrium");
  CHECK(l.A == std::vector<double>{0, 1, -4, 0});
  CHECK(l.outputs.empty());
  const Linearisation with_outputs = model.linearise({.parameters = {{"q_dot", 3}}, .outputs = {"q_dot", "kinetic"}});
  CHECK(with_outputs.C == std::vector<double>{0, 1, 0, 3});
  CHECK(with_outputs.output_values == std::vector<double>{3, 4.5});
  REQUIRE(l.eigenvalues.size() == 2);
  CHECK(std::abs(l.eigenvalues[0].imag()) == doctest::Approx(2).epsilon(1e-14));
  const SteadyMotions steady = model.steady_motions({.starts = 40});
  const auto stable = [](const SteadyMotion& s) { return s.stability == "stable"; };
  CHECK(std::count_if(steady.motions.begin(), steady.motions.end(), stable) >= 1);
  CHECK(std::any_of(steady.motions.begin(), steady.motions.end(),
                    [](const auto& s) { return s.stability == "unstable"; }));

  const Benchmark measured = model.benchmark({.solvers = {"dop853", "rk4"}, .max_seconds = 2});
  CHECK(measured.conclusive);
  CHECK(measured.reference_digits >= 20);
  const StressTest stressed = model.stress_test({.solvers = {"dop853"}, .quick = true});
  CHECK_FALSE(stressed.rows.empty());
  CHECK(stressed.undetected == 0);
  CHECK(stressed.pass + stressed.reported == stressed.rows.size());

  Definition driven("Driven");
  driven.set("coordinates", "x", Value::table({})).set("energy", "kinetic", "3/2*x_dot^2");
  driven.add("constraint", {{"name", "drive"}, {"holonomic", "x - sin(t)"}});
  driven.set("scene.default", "t", Value::list({0, 2}));
  const InverseDynamics forces = Model::from(driven, "driven").inverse_dynamics({.every = 1.0});
  CHECK(forces.outcome == "done");
  CHECK(std::find(forces.forces.begin(), forces.forces.end(), "reaction.drive") != forces.forces.end());
  const auto place = std::find(forces.columns.begin(), forces.columns.end(), "reaction.drive") - forces.columns.begin();
  REQUIRE(forces.rows.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(forces.rows[i][static_cast<std::size_t>(place)] ==
          doctest::Approx(-3 * std::sin(forces.times[i])).epsilon(1e-12));
}

TEST_CASE("library: the names of targets and solvers") {
  const auto has = [](const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  CHECK(has(targets(), "cpp"));
  CHECK(has(targets(), "javascript"));
  CHECK(has(solvers(), "auto"));
  CHECK(has(solvers(), "dop853"));
}
