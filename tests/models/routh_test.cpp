// SPDX-License-Identifier: GPL-3.0-or-later
// Routh's reduction of shipped models against the oracle, against (2.172) and (2.173), and along a run.
#include "reading/routh.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "conservation/conserved.hpp"
#include "derive/formulations/lagrange.hpp"
#include "models/displayed_model.hpp"
#include "support/reference_integration.hpp"
#include "support/simulation.hpp"
#include "support/sum_values.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

reading::RouthForm reduced(mechanics::Mechanics& m) {
  system::EquationSystem s = derive::lagrange(m, system::Approach::two);
  return reading::routh_form(m, conservation::cyclic_coordinates(conservation::conserved_quantities(m, s)));
}

verify::Certificate certificate(mechanics::Mechanics& m, const std::vector<symbolic::Ref>& residuals) {
  verify::Subjects subjects;
  subjects.systems = verify::all_formulations(m);
  subjects.reading.push_back({"Routh's reduction", residuals});
  return verify::certify(m, subjects, {50, 5, 1, {}});
}

bool routh_agrees(const verify::Certificate& c) {
  for (const verify::Comparison& row : c.comparisons) {
    if (row.a == "Routh's reduction") return row.pass && row.digits_agreed >= 45;
  }
  throw std::logic_error("it was not compared");
}

}  // namespace

TEST_CASE("routh: of P9 with h is the single equation (2.172), with the energy (2.173)") {
  DisplayedModel p9("P9_paraboloid");
  const reading::RouthForm form = reduced(p9.s.mechanics);
  REQUIRE(form.cyclic.size() == 1);
  REQUIRE(form.equations.size() == 1);
  reading::AtomTable atom_table(p9.s.model);
  const Sum h = atom_table(reading::momentum_symbol(form.cyclic[0]));
  const Sum m = p9("m"), g = p9("g"), c = p9("c"), u = p9("u"), du = p9("u_dot"), ddu = p9("u_ddot");
  CHECK(same(form.momenta[0], m * square(c * u) * p9("theta_dot")));
  CHECK(same(form.rates[0], over(h, m * square(c * u))));
  const Sum single =
      m * (square(u) + square(c)) * ddu + m * u * square(du) - over(square(h), m * u * u * u * square(c)) + m * g * u;
  CHECK(same(form.equations[0].expanded - form.equations[0].force, single));
  REQUIRE(form.energy.has_value());
  CHECK(same(*form.energy, half(m) * (square(u) + square(c)) * square(du) + half(over(square(h), m * square(u * c))) +
                               half(m * g) * (square(u) - square(c))));
}

TEST_CASE("routh: the reduced equations vanish for the motion that the oracle alone gives") {
  for (const char* name : {"P9_paraboloid", "P1_spherical_pendulum", "P1_spherical_pendulum_varying",
                           "P14_kepler_spherical", "P14_kepler_parabolic", "S5_spherical_double_pendulum"}) {
    INFO(name);
    const model::Model model = model::read_model(model_path(name));
    mechanics::Mechanics m = mechanics::build_mechanics(model);
    const reading::RouthForm form = reduced(m);
    const std::vector<symbolic::Ref> residuals = reading::residuals_on_dag(form, m);
    if (form.cyclic.empty()) {
      CHECK(residuals.empty());
      continue;
    }
    REQUIRE(residuals.size() == m.free.size());
    CHECK(routh_agrees(certificate(m, residuals)));
  }
}

TEST_CASE("routh: a wrong sign in a reduced equation is noticed") {
  DisplayedModel p9("P9_paraboloid");
  reading::RouthForm form = reduced(p9.s.mechanics);
  form.equations[0].expanded += Sum(2) * p9("m") * p9("g") * p9("u");
  CHECK_FALSE(routh_agrees(certificate(p9.s.mechanics, reading::residuals_on_dag(form, p9.s.mechanics))));
}

TEST_CASE("routh: integrated by itself P9's single equation moves as the full system does") {
  constexpr double tolerance = 1e-9;  // both at rtol 1e-12 over 10 s
  const FinishedRun run = run_model("P9_paraboloid", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
  DisplayedModel p9("P9_paraboloid");
  const reading::RouthForm form = reduced(p9.s.mechanics);
  using symbolic::SymbolKind;
  const std::uint32_t u = form.equations[0].coordinate;
  Values at;
  for (std::uint32_t i = 0; i < p9.s.model.parameters.size(); ++i)
    at[{SymbolKind::parameter, i, 0}] = run.simulation.scene.parameters[i];
  const double c = run.parameter("c"), h = run.parameter("m") * c * c * 2;  // u = 1, theta_dot = 2 at the start
  at[reading::momentum_symbol(form.cyclic[0])] = h;
  const auto f = [&](double, const double* x, double* dx) {
    at[{SymbolKind::coordinate, u, 0}] = x[0];
    at[{SymbolKind::coordinate, u, 1}] = x[1];
    const auto residual = [&](double acceleration) {
      at[{SymbolKind::coordinate, u, 2}] = acceleration;
      return value_of(form.equations[0].expanded, at) - value_of(form.equations[0].force, at);
    };
    const double at_rest = residual(0);
    dx[0] = x[1];
    dx[1] = -at_rest / (residual(1) - at_rest);
    return 0;
  };
  const std::vector<double> end = test::integrate_reference(f, 0, {1, 0.4}, 10, 1e-12, 1e-13);
  CHECK(end[0] == doctest::Approx(run.final("u")).epsilon(tolerance));
  CHECK(end[1] == doctest::Approx(run.final("u_dot")).epsilon(tolerance).scale(1));
}
