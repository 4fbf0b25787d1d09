// SPDX-License-Identifier: GPL-3.0-or-later
// Rocket with variable mass, Ex 2.6: thrust of a prescribed climb against its closed form from (2.163).
#include <doctest/doctest.h>

#include <cmath>

#include "analysis/prescribed_forces.hpp"
#include "derive/formulations.hpp"
#include "displayed_model.hpp"
#include "support/simulation.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;

namespace {

constexpr double ten_operations = 1e-14;  // about ten operations, with cancellation in the sum by at most a factor of 5
constexpr double of_a_run = 1e-9;         // relative, a minute at rtol 1e-12

struct Numbers {
  double m0 = 1000, burn = 8, alpha = 3.986e14, R0 = 6.378e6, a = 10, theta0 = 0.3, phi0 = 1.1;
  double m(double t) const { return m0 - burn * t; }
  double R(double t) const { return a * t * t + R0; }
  // d(m Rdot)/dt + alpha m/R^2
  double thrust(double t) const { return -burn * 2 * a * t + m(t) * 2 * a + alpha * m(t) / (R(t) * R(t)); }
};

}  // namespace

TEST_CASE("P10: the thrust is radial and equals d(m Rdot)/dt + alpha m/R^2 at all times") {
  const model::Model model = model::read_model(test::model_path("P10_rocket"));
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  CHECK(analysis::prescribing_constraints(m) == std::vector<std::string>{"radial", "meridian", "cone"});
  const Numbers n;
  const double e[] = {std::sin(n.phi0) * std::cos(n.theta0), std::sin(n.phi0) * std::sin(n.theta0), std::cos(n.phi0)};
  for (const derive::FormulationEntry& formulation : derive::formulations()) {
    std::optional<system::EquationSystem> derived = formulation.derive(m, system::Approach::one);
    if (!derived) continue;
    INFO(formulation.name);
    system::EquationSystem& s = *derived;
    const std::vector<std::string> names = analysis::add_prescribed_forces(m, s, analysis::prescribing_constraints(m));
    // No force acts along theta and phi: these generalised forces vanish identically and are omitted.
    CHECK(names == std::vector<std::string>{"force.R", "P.force1", "P.force2", "P.force3", "prescribed.power"});
    std::vector<symbolic::Ref> values;
    for (const std::string& name : names) {
      for (const system::Output& output : s.outputs) {
        if (output.name == name) values.push_back(output.value);
      }
    }
    for (const double t : {0.0, 7.5, 60.0, 110.0}) {
      const double parameters[] = {n.m0, n.burn, n.alpha, n.R0, n.a, n.theta0, n.phi0};
      const std::vector<double> value = symbolic::evaluate(*m.dag, values, [&](const symbolic::Symbol& symbol) {
        if (symbol.kind == symbolic::SymbolKind::time) return t;
        return symbol.kind == symbolic::SymbolKind::parameter ? parameters[symbol.index] : std::nan("");
      });
      const double K = n.thrust(t);
      CHECK(value[0] == doctest::Approx(K).epsilon(ten_operations));
      for (std::size_t k = 0; k < 3; ++k) CHECK(value[1 + k] == doctest::Approx(K * e[k]).epsilon(10 * ten_operations));
      CHECK(value[4] == doctest::Approx(K * 2 * n.a * t).epsilon(ten_operations));
    }
  }
}

TEST_CASE("P10: free to rotate, angular momentum follows from the side force, the radial thrust from the motion") {
  const test::FinishedRun run = test::run_model("P10_rocket_pitching", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-15;
    request.overrides.outputs = {"h", "mT_rate", "reaction.radial"};
  });
  const Numbers n;
  const double wind = 50, h0 = n.m0 * n.R0 * n.R0 * 1e-3;
  REQUIRE(run.rows.size() > 100);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i], m = n.m(t), R = n.R(t), Rdot = 2 * n.a * t;
    const double h = h0 + wind * (n.a * t * t * t / 3 + n.R0 * t);
    CHECK(run.rows.at(i, "h") == doctest::Approx(h).epsilon(of_a_run));
    const double thrust = n.thrust(t) - h * h / (m * R * R * R);
    CHECK(std::abs(run.rows.at(i, "reaction.radial") - thrust) < of_a_run * n.thrust(t));
    // (2.164): d(mT)/dt = F . G with G = m v and F the sum of gravity, side force and thrust
    const double F_G = m * ((run.rows.at(i, "reaction.radial") - n.alpha * m / (R * R)) * Rdot +
                            wind * R * run.rows.at(i, "theta_dot"));
    const double size = m * (n.alpha * m / (R * R) * std::abs(Rdot) + wind * h / (m * R));
    CHECK(std::abs(run.rows.at(i, "mT_rate") - F_G) < of_a_run * size);
  }
  CHECK(run.simulation.result.power_balance < of_a_run);
}
