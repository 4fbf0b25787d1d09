// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "derive/lagrange.hpp"
#include "support/simulation.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;
using Eigen::Vector3d;

namespace {

/// The arm by hand at constant rates: base s(t), axes, force (7.102), and the moment (7.103) with its missing terms.
struct Arm {
  static constexpr double m = 5, g = 9.81, L = 0.4, J1 = 0.3, J2 = 0.25, J3 = 0.1, a = 0.2, w = 3, dpsi = 1.5, dtheta = 0.8;
  double psi, theta;
  Vector3d e1, e2, e3, velocity, force, moment;

  explicit Arm(double t) : psi(dpsi * t), theta(0.4 + dtheta * t) {
    const double c = std::cos(theta), s = std::sin(theta);
    e1 = {std::cos(psi), std::sin(psi), 0};
    e2 = {-std::sin(psi) * c, std::cos(psi) * c, s};
    e3 = {std::sin(psi) * s, -std::cos(psi) * s, c};
    velocity = {a * w * std::cos(w * t), -2 * a * w * std::sin(2 * w * t), -a * w * std::exp(-w * t)};
    const Vector3d acceleration(-a * w * w * std::sin(w * t), -4 * a * w * w * std::cos(2 * w * t), a * w * w * std::exp(-w * t));
    force = m * g * Vector3d::UnitZ() + m * acceleration + 2 * m * L * dpsi * dtheta * c * e1 + m * L * dpsi * dpsi * s * c * e2 -
            m * L * (dtheta * dtheta + dpsi * dpsi * s * s) * e3;
    const Vector3d H = J1 * dtheta * e1 + J2 * dpsi * s * e2 + J3 * dpsi * c * e3, turn = dtheta * e1 + dpsi * s * e2 + dpsi * c * e3;
    moment = L * e3.cross(force) + turn.cross(H) + J2 * dpsi * dtheta * c * e2 - J3 * dpsi * dtheta * s * e3;
  }
};

}  // namespace

TEST_CASE("R9: inverse dynamics gives the force (7.102) at the base and the moment (7.103), corrected, about it") {
  const model::Model model = model::read_model(test::model_path("R9_robot_arm"));
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  const auto s = derive::lagrange(m, system::Approach::one);
  std::vector<symbolic::Ref> roots;
  for (const system::Reaction& r : s.reactions) roots.push_back(r.value);
  for (const system::Output& o : s.outputs) {
    if (o.name == "power") roots.push_back(o.value);
  }
  REQUIRE(roots.size() == 7);
  for (const double t : {0.0, 0.3, 1.1, 2.7}) {
    CAPTURE(t);
    const auto parameter = [&](const symbolic::Symbol& symbol) -> double {
      if (symbol.kind == symbolic::SymbolKind::time) return t;
      const auto value = [&](const auto& self, const symbolic::Symbol& p) -> double {
        return symbolic::evaluate(*m.dag, {m.parameter_value[p.index]}, [&](const symbolic::Symbol& q) { return self(self, q); })[0];
      };
      return value(value, symbol);
    };
    const std::vector<double> found = symbolic::evaluate(*m.dag, roots, parameter);
    const Arm arm(t);
    for (int k = 0; k < 3; ++k) CHECK(found[static_cast<std::size_t>(k)] == doctest::Approx(arm.force[k]).epsilon(1e-12));
    CHECK(found[3] == doctest::Approx(arm.moment[2]).epsilon(1e-11));
    CHECK(found[4] == doctest::Approx(arm.moment.dot(arm.e1)).epsilon(1e-11));
    CHECK(found[5] == doctest::Approx(arm.moment.dot(arm.e3)).epsilon(1e-11));
    // (7.104): what force and moment do is what the energy gains.
    const double work = arm.force.dot(arm.velocity) + Arm::dpsi * arm.moment[2] + Arm::dtheta * arm.moment.dot(arm.e1);
    CHECK(found[6] == doctest::Approx(work).epsilon(1e-11));
  }
}
