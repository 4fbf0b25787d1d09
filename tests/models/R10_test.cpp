// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "conservation/conservative.hpp"
#include "models/displayed_model.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

FinishedRun top(const std::string& scene) {
  return run_model("R10_lagrange_top", [&](pipeline::SimulationRequest& request) {
    request.scene = scene;
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-12;
    request.overrides.outputs = {"top.omega3", "energy"};
  });
}

// Every scene has the moment G, which is 0 in most: no invariant is reported.
double spread(const FinishedRun& run, const std::string& name) {
  double least = run.rows.at(0, name), greatest = least;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    least = std::min(least, run.rows.at(i, name));
    greatest = std::max(greatest, run.rows.at(i, name));
  }
  return (greatest - least) / std::abs(greatest);
}

double momentum(const FinishedRun& run, std::size_t i) {
  const double c = std::cos(run.rows.at(i, "theta")), s = std::sin(run.rows.at(i, "theta"));
  const double across = run.parameter("Jt") + run.parameter("m") * std::pow(run.parameter("L"), 2);
  return across * s * s * run.rows.at(i, "psi_dot") + run.parameter("Ja") * c * run.rows.at(i, "top.omega3");
}

}  // namespace

TEST_CASE("R10: T is (7.111), U (7.112), and the moment along E3 has the components G, 0, G cos(theta)") {
  DisplayedModel r10("R10_lagrange_top");
  const reading::DisplayForm form = r10.form(system::Approach::two);
  const Sum n = r10("theta"), psi = r10("psi_dot"), theta = r10("theta_dot"), phi = r10("phi_dot");
  const Sum across = r10("Jt") + r10("m") * square(r10("L"));
  CHECK(same(form.kinetic,
             half(across * (square(theta) + square(psi * sin(n)))) + half(r10("Ja") * square(phi + psi * cos(n)))));
  CHECK(same(form.potential, r10("m") * r10("g") * r10("L") * cos(n) + half(r10("K") * square(r10("psi")))));
  CHECK(same(r10.equation(form, "psi").force, r10("G")));
  CHECK(same(r10.equation(form, "theta").force, Sum(0)));
  CHECK(same(r10.equation(form, "phi").force, r10("G") * cos(n)));
}

TEST_CASE("R10: the moment along E3 is not conservative, spring and weight are") {
  DisplayedModel r10("R10_lagrange_top");
  const std::vector<conservation::ForceClassification> found = conservation::classify_forces(r10.s.mechanics);
  REQUIRE(found.size() == 3);
  CHECK(found[0].conservative == conservation::ConservativeVerdict::yes);
  CHECK(found[1].conservative == conservation::ConservativeVerdict::yes);
  CHECK(found[2].conservative == conservation::ConservativeVerdict::no);
}

TEST_CASE("R10: released without precession it nutates between two roots of the cubic of its energy, with cusps") {
  const FinishedRun run = top("default");
  const double m = run.parameter("m"), g = run.parameter("g"), L = run.parameter("L"),
               u0 = std::cos(run.parameter("tilt"));
  const double across = run.parameter("Jt") + m * L * L, p = run.parameter("Ja") * run.parameter("spin");
  // p^2 (u0 - u) = 2 across m g L (1 - u^2), u = cos(theta)
  const double b = p * p / (2 * across * m * g * L), u1 = b / 2 - std::sqrt(b * b / 4 - b * u0 + 1);
  double least = 9, greatest = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    least = std::min(least, run.rows.at(i, "theta"));
    greatest = std::max(greatest, run.rows.at(i, "theta"));
    CHECK(run.rows.at(i, "top.omega3") == doctest::Approx(150).epsilon(1e-11));
    CHECK(run.rows.at(i, "psi_dot") > -1e-6);  // cusps: the precession stops and does not reverse
  }
  CHECK(least == doctest::Approx(run.parameter("tilt")).epsilon(1e-9));
  CHECK(greatest == doctest::Approx(std::acos(u1)).epsilon(1e-9));
  CHECK(run.simulation.result.events.size() > 20);
  CHECK(spread(run, "energy") < 1e-10);
  for (std::size_t i = 0; i < run.rows.size(); ++i)
    CHECK(momentum(run, i) == doctest::Approx(momentum(run, 0)).epsilon(1e-10));
}

TEST_CASE("R10: started with the slow rate of steady precession, its tilt is constant") {
  const FinishedRun run = top("steady");
  for (std::size_t i = 0; i < run.rows.size(); ++i) CHECK(std::abs(run.rows.at(i, "theta") - 0.6) < 1e-9);
  CHECK(run.final("psi") == doctest::Approx(5 * run.parameter("slow")).epsilon(1e-9));
}

TEST_CASE("R10: a torsional spring conserves energy but not the momentum of psi; a moment G E3 adds G t to it") {
  const FinishedRun spring = top("spring");
  CHECK(spread(spring, "energy") < 1e-10);
  CHECK(std::abs(momentum(spring, spring.rows.size() - 1) - momentum(spring, 0)) > 0.01);
  const FinishedRun moment = top("moment");
  for (std::size_t i = 0; i < moment.rows.size(); ++i) {
    CHECK(momentum(moment, i) == doctest::Approx(momentum(moment, 0) + 0.02 * moment.rows.t[i]).epsilon(1e-10));
  }
  CHECK(std::abs(moment.final("energy") - moment.rows.at(0, "energy")) > 0.1);
}
