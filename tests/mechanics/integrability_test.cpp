// SPDX-License-Identifier: GPL-3.0-or-later
// Integrability of velocity constraints, alone or together; their integrals; redundant ones.
#include "mechanics/integrability.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <sstream>

#include "symbolic/evaluate.hpp"

using namespace eomgen;

namespace {

std::string text_of(const std::string& coordinates, const std::vector<std::string>& constraints) {
  std::string
      text =
          "format = 1\n[parameters]\nk = 0.5\nR = 0.3\nS = \"2*R\"\n[functions]\nf = \"k*sin(3*t)\"\n[coordinates]\n",
      kinetic;
  std::istringstream names(coordinates);
  for (std::string q; names >> q;) {
    text += q + " = {}\n";
    kinetic += (kinetic.empty() ? "" : " + ") + q + "_dot^2/2";
  }
  text += "[energy]\nkinetic = \"" + kinetic + "\"\n";
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    text += "[[constraint]]\nname = \"c" + std::to_string(i + 1) + "\"\n" + constraints[i] + "\n";
  }
  return text;
}

std::string velocity(const std::string& e) { return "velocity = \"" + e + "\""; }
std::string holonomic(const std::string& psi) { return "holonomic = \"" + psi + "\""; }

struct Found {
  Found(const std::string& coordinates, const std::vector<std::string>& constraints)
      : model(model::read_model_text(text_of(coordinates, constraints), "test.toml")),
        m(mechanics::build_mechanics(model)) {}

  std::string verdicts() const {
    std::string text;
    for (const mechanics::ConstraintClassification& c : m.classification)
      text += std::string(text.empty() ? "" : " ") + name(c.integrable);
    return text;
  }

  /// d psi/dt along admissible velocities, by central differences, at a few states: the worst of all integrals. Only
  /// the rows of the constraints come from mechanics.
  double worst_rate() const {
    double worst = 0;
    for (int point = 1; point <= 3; ++point) {
      const auto value = [&](const symbolic::Symbol& s) -> double {
        constexpr double parameters[] = {0.5, 0.3, 0.6};  // k, R, S = 2 R
        if (s.kind == symbolic::SymbolKind::parameter) return parameters[s.index];
        return s.kind == symbolic::SymbolKind::time
                   ? 0.4 * point
                   : 0.35 + 0.61 * std::fmod(0.37 * (s.index + 1) * point + 0.21 * static_cast<double>(s.kind), 1.0);
      };
      const auto n = static_cast<Eigen::Index>(m.q.size()), count = static_cast<Eigen::Index>(m.constraints.size());
      Eigen::MatrixXd A(count, n);
      Eigen::VectorXd b(count);
      std::map<symbolic::Symbol, symbolic::Ref> functions{
          {{symbolic::SymbolKind::function, 0, 0}, m.function_value[0]}};
      symbolic::Substitution written(*m.dag, functions);
      const auto number = [&](symbolic::Ref r) { return symbolic::evaluate(*m.dag, {written(r)}, value)[0]; };
      for (Eigen::Index k = 0; k < count; ++k) {
        const mechanics::Constraint& c = m.constraints[static_cast<std::size_t>(k)];
        for (Eigen::Index i = 0; i < n; ++i) A(k, i) = number(c.gradient[static_cast<std::size_t>(i)]);
        b(k) = number(c.rate);
      }
      const Eigen::VectorXd any = Eigen::VectorXd::LinSpaced(n, 0.3, 1.7);
      const Eigen::VectorXd v = any - A.completeOrthogonalDecomposition().solve(A * any + b);
      for (const mechanics::ConstraintIntegral& integral : m.integrals) {
        constexpr double h = 1e-5;  // central differences: 1e-10 of truncation and of rounding
        const auto at = [&](double step) {
          return symbolic::evaluate(*m.dag, {integral.psi}, [&](const symbolic::Symbol& s) {
            if (s.kind == symbolic::SymbolKind::time) return value(s) + step;
            return s.kind == symbolic::SymbolKind::coordinate ? value(s) + step * v(s.index) : value(s);
          })[0];
        };
        worst = std::max(worst, std::abs(at(h) - at(-h)) / (2 * h));
      }
    }
    return worst;
  }

  model::Model model;
  mechanics::Mechanics m;
};

std::string refusal(const std::string& coordinates, const std::vector<std::string>& constraints) {
  try {
    Found found(coordinates, constraints);
  } catch (const Error& error) {
    CHECK(error.where().line > 0);
    CHECK_FALSE(error.remedy().empty());
    return error.message();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("integrability: single constraints, with an integrating factor if needed, and their integrals") {
  for (const char* e : {"x_dot - k", "x*x_dot + y*y_dot + f", "y*z*x_dot + x*z*y_dot + x*y*z_dot", "x*y_dot - y*x_dot",
                        "y*x_dot + 2*x*y_dot", "x_dot + k*x", "cos(y)*x_dot*exp(z) - x*sin(y)*y_dot*exp(z)",
                        "x*x_dot + y*y_dot - k*sin(3*t)*exp(t)", "y_dot - x_dot*tan(x)", "x^2*y_dot - y*x_dot*(x+1)",
                        "(x^2+y^2)*z_dot + x*y_dot - y*x_dot", "x_dot*sin(x)^2 + z_dot*z^2*cos(z)",
                        "x*x_dot/sqrt(x^2+y^2) + y*y_dot/sqrt(x^2+y^2) - z_dot", "(S - 2*R)*y*x_dot + z*z_dot"}) {
    INFO(std::string(e));
    const Found found("x y z", {velocity(e)});
    CHECK(found.verdicts() == "yes");
    CHECK(found.m.integrals.size() == 1);
    CHECK(found.worst_rate() < 1e-8);
  }
}

TEST_CASE("integrability: constraints without an integral of the positions and t") {
  for (const char* e : {"y_dot + z*x_dot", "x*x_dot + z*y*y_dot + z*y*z_dot", "x_dot*sin(z) - y_dot*cos(z)",
                        "y^2*x_dot + x*y_dot - f", "x_dot*sqrt(x^2 + y^2) + x + y_dot*t"}) {
    INFO(std::string(e));
    const Found found("x y z", {velocity(e)});
    CHECK(found.verdicts() == "no");
    CHECK(found.m.integrals.empty());
  }
}

TEST_CASE("integrability: constraints that are integrable only together") {
  const Found pair("x y z", {velocity("y_dot - z*x_dot"), velocity("z_dot")});
  CHECK(pair.verdicts() == "yes yes");
  CHECK(pair.m.classification[0].reason == "not by itself, but together with 'c2'");
  CHECK(pair.m.integrals.size() == 2);
  CHECK(pair.worst_rate() < 1e-8);

  // Neither of the two is integrable without the rest.
  const Found both("x y z w", {velocity("x_dot + z*y_dot + z_dot*w"), velocity("z_dot*w + w_dot + z*y_dot")});
  CHECK(both.m.integrals.size() <= 2);
  CHECK(both.worst_rate() < 1e-8);

  const Found disk("x y phi psi", {velocity("x_dot - R*psi_dot*cos(phi)"), velocity("y_dot - R*psi_dot*sin(phi)"),
                                   velocity("phi_dot")});
  CHECK(disk.verdicts() == "yes yes yes");
  CHECK(disk.m.integrals.size() == 3);
  CHECK(disk.worst_rate() < 1e-8);

  // The same disk, free to turn.
  const Found turning("x y phi psi", {velocity("x_dot - R*psi_dot*cos(phi)"), velocity("y_dot - R*psi_dot*sin(phi)")});
  CHECK(turning.verdicts() == "no no");
  CHECK(turning.m.integrals.empty());
}

TEST_CASE("integrability: a combination is integrable although no single constraint is") {
  const Found found("x y z w", {velocity("x_dot + y*z_dot"), velocity("w_dot - y*z_dot")});
  CHECK(found.verdicts() == "no no");
  REQUIRE(found.m.integrals.size() == 1);
  CHECK(found.m.integrals[0].constraints == std::vector<std::uint32_t>{0, 1});
  CHECK(found.worst_rate() < 1e-8);
}

TEST_CASE("integrability: a coordinate fixed by a holonomic constraint makes others integrable") {
  const Found straight("x y phi psi", {holonomic("phi - k*t^2"), velocity("x_dot - R*psi_dot*cos(phi)"),
                                       velocity("phi_dot + y_dot - t")});
  CHECK(straight.verdicts() == "yes no yes");  // cos(phi(t)) psi_dot is no total derivative
  // On a sphere every constraint that stands still leaves curves.
  const Found sphere("x y z", {holonomic("x^2 + y^2 + z^2 - 1"), velocity("z*x_dot + x*y_dot")});
  CHECK(sphere.verdicts() == "yes yes");
  CHECK(Found("x y z", {velocity("z*x_dot + x*y_dot")}).verdicts() == "no");
}

TEST_CASE("integrability: a holonomic constraint's function is no integral of a velocity constraint") {
  const Found found("a b c", {holonomic("cos(a) + cos(b) - 1.5"), velocity("c_dot + cos(c)*a_dot + b_dot")});
  CHECK(found.verdicts() == "yes yes");  // on the remaining curve
  CHECK(found.m.integrals.empty());
}

TEST_CASE("integrability: a car reaches every configuration with any number of trailers") {
  for (const int trailers : {1, 5, 9}) {
    std::string coordinates = "x y s th0";
    std::vector<std::string> wheels{velocity("x_dot*sin(th0 + s) - y_dot*cos(th0 + s) - th0_dot*cos(s)"),
                                    velocity("x_dot*sin(th0) - y_dot*cos(th0)")};
    for (int k = 1; k <= trailers; ++k) {
      const std::string th = "th" + std::to_string(k);
      coordinates += " " + th;
      std::string e = "x_dot*sin(" + th + ") - y_dot*cos(" + th + ")";
      for (int j = 1; j <= k; ++j)
        e += " + R*th" + std::to_string(j) + "_dot*cos(th" + std::to_string(j) + " - " + th + ")";
      wheels.push_back(velocity(e));
    }
    const Found found(coordinates, wheels);
    CHECK(found.verdicts().find("yes") == std::string::npos);
    CHECK(found.verdicts().find("unknown") == std::string::npos);
    CHECK(found.m.integrals.empty());
    for (const mechanics::ConstraintClassification& c : found.m.classification)
      CHECK(c.reason.find("combination") == std::string::npos);
  }
}

TEST_CASE("integrability: a wheel that cannot turn stays on its line, and the trailer's angle follows from its place") {
  const Found found("x y th0 th1", {velocity("x_dot*sin(th0) - y_dot*cos(th0)"),
                                    velocity("x_dot*sin(th1) - y_dot*cos(th1) + R*th1_dot"), velocity("th0_dot")});
  // The trailer's curve is a tractrix: log tan((th1 - th0)/2) + s/R is constant, with the distance s along the line.
  CHECK(found.verdicts() == "yes yes yes");
  CHECK(found.m.integrals.size() == 2);
  CHECK(found.worst_rate() < 1e-8);
}

TEST_CASE("integrability: velocity constraints that leave one direction of (q, t) are integrable together") {
  const Found found("psi theta phi", {velocity("psi_dot*sin(theta)*sin(phi) + theta_dot*cos(phi) - 1"),
                                      velocity("psi_dot*sin(theta)*cos(phi) - theta_dot*sin(phi) - k*t"),
                                      velocity("psi_dot*cos(theta) + phi_dot - sin(t)")});
  CHECK(found.verdicts() == "yes yes yes");
  CHECK(found.m.integrals.empty());
}

TEST_CASE("redundancy: redundant and contradictory constraints are named") {
  const std::string c1 = velocity("x_dot + y*z_dot"), c2 = velocity("w_dot - y*z_dot + k");
  CHECK(refusal("x y z w", {c1, c2, velocity("2*x_dot + 2*y*z_dot")}) ==
        "constraint 'c3' follows from 'c1': c3 = 2 c1");
  CHECK(refusal("x y z w", {c1, c2, velocity("x_dot/2 + 3*y*z_dot/2 - w_dot - k")}) ==
        "constraint 'c3' follows from 'c1', 'c2': c3 = c1/2 - c2");
  CHECK(refusal("x y z w", {c1, c2, velocity("x_dot + w_dot")}) ==
        "constraint 'c3' contradicts 'c1', 'c2': its velocities are those of c1 + c2, the rest is not");
  CHECK(refusal("x y z w", {c1, c2, velocity("x*x_dot + x*y*z_dot + w_dot - y*z_dot + k")}) ==
        "constraint 'c3' follows from 'c1', 'c2', with coefficients that depend on the state");
  CHECK(refusal("x y z", {holonomic("x^2 + y^2 - 1"), velocity("x*x_dot + y*y_dot")}) ==
        "constraint 'c2' follows from 'c1': c2 = c1/2");
  CHECK(refusal("x y z", {velocity("x*x_dot + y*y_dot - 1"), holonomic("x^2 + y^2 - 1")}) ==
        "constraint 'c1' contradicts 'c2': its velocities are those of c2/2, the rest is not");
  CHECK(refusal("x y z", {holonomic("x - t"), velocity("x_dot - 1")}) ==
        "constraint 'c2' follows from the constraints that fix its coordinates");
  CHECK(refusal("x y z", {holonomic("x - t"), velocity("x_dot - 2")}) ==
        "constraint 'c2' contradicts the constraints that fix its coordinates");
  CHECK(refusal("x y z w", {c1, c2, velocity("2*x_dot + y*z_dot")}) == "accepted");
}
