// SPDX-License-Identifier: GPL-3.0-or-later
// The emitted Jacobian is the derivative of the emitted function, also at states that violate constraints.
#include <doctest/doctest.h>

#include "program/interpret.hpp"
#include "support/simulation.hpp"
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

}  // namespace

TEST_CASE(
    "in Euler parameters the Jacobian is that of the right-hand side in every direction, off the unit sphere too") {
  for (const char* name : {"R1_free_body_euler_parameters", "R2_ball_in_flight", "R17_follower_force", "heavy_top"}) {
    CAPTURE(name);
    const auto derived = pipeline::derive_model(test::model_at(model_path(name)), pipeline::ApproachChoice::automatic);
    program::Request request;
    request.with = {"jac", "jac_p"};
    const program::Program program = pipeline::make_program(*derived, request);
    const auto base = random_arguments(*derived, program);
    const std::size_t n = base.x.size();
    const auto jac = program::interpret(program.functions[1], base, digits).results[0];
    const auto jac_p = program::interpret(program.functions[2], base, digits).results[0];
    const cln::cl_R step = cln::expt(cln::cl_RA(10), -12);
    const auto furthest = [&](const std::vector<cln::cl_R>& columns, std::size_t j, auto&& pick) {
      auto above = base, below = base;
      pick(above) = pick(above) + step;
      pick(below) = pick(below) - step;
      const auto right = program::interpret(program.functions[0], above, digits).results[0],
                 left = program::interpret(program.functions[0], below, digits).results[0];
      double most = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const cln::cl_R slope = (right[i] - left[i]) / (2 * step);
        most = std::max(most, cln::double_approx(cln::abs(columns[j * n + i] - slope) / (1 + cln::abs(slope))));
      }
      return most;
    };
    for (std::size_t j = 0; j < n; ++j)
      CHECK(furthest(jac, j, [j](auto& a) -> cln::cl_R& { return a.x[j]; }) < as_good_as_exact);
    for (std::size_t j = 0; j < base.p.size(); ++j)
      CHECK(furthest(jac_p, j, [j](auto& a) -> cln::cl_R& { return a.p[j]; }) < as_good_as_exact);
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
