// SPDX-License-Identifier: GPL-3.0-or-later
// Friction in the equations, and the friction law that closes them, against d'Alembert's principle, Newton's law and a
// count of solutions.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "friction/compiled.hpp"
#include "friction/rough_models.hpp"
#include "program/build.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;

namespace {

constexpr double rounding = 1e-12;  // some hundred operations in binary64

void check_formulations(const std::string& text) {
  const model::Model model = model::read_model_text(text, "rough");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  verify::Subjects subjects;
  subjects.systems = verify::all_formulations(m);
  // Compares the program in CLN, in every mode, with Newton's iteration on the law.
  program::Program program = program::build_program(subjects.systems, {});
  const program::Function& rhs = program.functions[0];
  subjects.programs.push_back(
      {"program", [&](const verify::Real& t, const std::vector<verify::Real>& x, const std::vector<verify::Real>& p,
                      const std::vector<verify::Real>& u, const std::vector<int>& mode) {
         const auto values = program::interpret(rhs, program::Arguments<cln::cl_R>{t, x, p, u, {}, {}, mode}, 40);
         return values.results[0];
       }});
  const verify::Certificate certificate = verify::certify(m, subjects, {40, 4, 1});
  INFO(certificate.summary());
  CHECK(certificate.pass);
}

using Vector = std::array<double, 3>;
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

TEST_CASE("friction: the equations contain forces of any size, and the program satisfies the law in every mode") {
  for (const std::string* text :
       {&test::belt, &test::dry, &test::rough_line, &test::sphere, &test::helix, &test::dumbbell, &test::floor,
        &test::drop, &test::dome, &test::creeping, &test::hinge, &test::wires}) {
    check_formulations(*text);
  }
}

TEST_CASE("friction: on the helix the force is mu |N| against the motion, with N normal to the wire by Newton's law") {
  const double m = 1, r0 = 1.5, alpha = 0.4, mu = 0.2, g = 9.81;
  const test::RoughProgram rough(test::helix, {m, r0, alpha, 0.3, mu, g});
  for (const double rate : {1.3, -0.7}) {
    const double theta = 0.8, x[2] = {theta, rate}, c = std::cos(theta), s = std::sin(theta);
    double dx[2], values[5];
    rough.contacts(0, x, 0, values);
    CHECK(std::abs(values[0]) == doctest::Approx(std::abs(rate) * r0 * std::sqrt(1 + alpha * alpha)).epsilon(rounding));
    const int mode = values[0] > 0 ? 1 : 2;
    REQUIRE(rough.rhs(0, x, mode, dx) == 0);
    const Vector along{-s, c, alpha};
    Vector N, F;
    for (std::size_t k = 0; k < 3; ++k) {
      F[k] = rough.output("friction.wire." + std::to_string(k + 1), 0, x, mode);
      const double centripetal = k == 0 ? -c : k == 1 ? -s : 0;
      N[k] = m * r0 * (dx[1] * along[k] + rate * rate * centripetal) + (k == 2 ? m * g : 0) - F[k];
    }
    CHECK(dot(N, along) == doctest::Approx(0).epsilon(rounding).scale(m * g));
    CHECK(std::sqrt(dot(F, F)) == doctest::Approx(mu * std::sqrt(dot(N, N))).epsilon(rounding));
    CHECK(dot(F, along) * rate < 0);
  }
  // Sticking: friction balances gravity m g alpha / sqrt(1 + alpha^2) along the wire, (2.149).
  const double still[2] = {0.8, 0};
  double dx[2];
  REQUIRE(rough.rhs(0, still, 0, dx) == 0);
  CHECK(dx[1] == doctest::Approx(0).epsilon(rounding).scale(g));
  const double along_wire = rough.output("friction.wire.3", 0, still, 0) * std::sqrt(1 + alpha * alpha) / alpha;
  CHECK(along_wire == doctest::Approx(m * g * alpha / std::sqrt(1 + alpha * alpha)).epsilon(rounding));
}

TEST_CASE("friction: the dumbbell on a rough floor has Painleve configurations only beyond mu = 2 sqrt 2") {
  const double theta = std::atan(std::sqrt(2.0)), g = 9.81;
  for (const double mu : {2.8, 3.0}) {
    std::string curve = test::dumbbell;  // the same floor and a wall behind it, as one contact of two equations
    curve.replace(curve.find("[\"x\", \"y\"]"), 10, "[\"x\", \"y\", \"z\"]");
    curve.replace(curve.find("holonomic = \"y\""), 15, "holonomic = [\"y\", \"z\"]");
    const test::RoughProgram rail(curve, {1, 1, mu, g});
    const test::RoughProgram rough(test::dumbbell, {1, 1, mu, g});
    for (const double speed : {0.5, -0.5}) {
      for (const double spin : {0.0, 6.0}) {
        const double x[4] = {0, theta, speed, spin};
        // By hand: the floor's force N and friction -mu sgn |N| must keep y_ddot = 0:
        // N (2/3) + mu sgn |N| sqrt(2)/6 = m (g - w^2 sin/2) (m = L = 1, tan theta = sqrt 2).
        const double s = std::sin(theta), b = g - spin * spin * s / 2, sgn = speed > 0 ? 1 : -1;
        const double up = 2.0 / 3 + mu * sgn * std::sqrt(2.0) / 6, down = 2.0 / 3 - mu * sgn * std::sqrt(2.0) / 6;
        const int solutions = (b / up >= 0 ? 1 : 0) + (b / down <= 0 ? 1 : 0);
        for (const int sign : {0, 3}) {
          const int mode = sign + (speed > 0 ? 1 : 2);
          double dx[4], values[5];
          const int code = rough.rhs(0, x, mode, dx);
          rough.contacts(0, x, mode, values);
          CHECK(values[4] == doctest::Approx(1 - mu / (2 * std::sqrt(2.0))).epsilon(rounding));
          CHECK(code == (mu < 2 * std::sqrt(2.0) ? 0 : solutions == 0 ? 3 : 4));
          if (mu < 2 * std::sqrt(2.0)) CHECK(solutions == 1);
        }
        double dx[4];
        // The slip of the curve along its own tangent, which may be turned.
        double values[5];
        rail.contacts(0, x, 0, values);
        CHECK(rail.rhs(0, x, values[0] > 0 ? 1 : 2, dx) == (mu < 2 * std::sqrt(2.0) ? 0 : solutions == 0 ? 3 : 4));
      }
    }
  }
}

TEST_CASE("friction: invalid coefficients are refused with their location") {
  const auto message = [](const std::string& from, const std::string& to) {
    std::string text = test::belt;
    text.replace(text.find(from), from.size(), to);
    const model::Model model = model::read_model_text(text, "rough");
    try {
      mechanics::build_mechanics(model);
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("nothing");
  };
  CHECK(message("mu_d = 0.5", "mu_d = -0.5") == "a coefficient of friction of 'belt' is negative");
  CHECK(message("mu_d = 0.5", "mu_d = 1.5") ==
        "the static coefficient of friction of 'belt' is less than the dynamic one");
  CHECK(message("mu_d = 0.5", "mu_d = \"log(-mu_s)\"") ==
        "a coefficient of friction of 'belt' has no value: log of a number that is not positive");
}
