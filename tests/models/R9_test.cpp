// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "derive/formulations/lagrange.hpp"
#include "support/simulation.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;
using Eigen::Vector3d;

namespace {

/// The arm by hand at constant rates: base s(t), axes, force (7.102), and the moment (7.103) with its missing terms.
struct Arm {
  static constexpr double m = 5, g = 9.81, L = 0.4, J1 = 0.3, J2 = 0.25, J3 = 0.1, a = 0.2, w = 3, dpsi = 1.5,
                          dtheta = 0.8;
  double psi, theta;
  Vector3d e1, e2, e3, velocity, force, moment;

  explicit Arm(double t) : psi(dpsi * t), theta(0.4 + dtheta * t) {
    const double c = std::cos(theta), s = std::sin(theta);
    e1 = {std::cos(psi), std::sin(psi), 0};
    e2 = {-std::sin(psi) * c, std::cos(psi) * c, s};
    e3 = {std::sin(psi) * s, -std::cos(psi) * s, c};
    velocity = {a * w * std::cos(w * t), -2 * a * w * std::sin(2 * w * t), -a * w * std::exp(-w * t)};
    const Vector3d acceleration(-a * w * w * std::sin(w * t), -4 * a * w * w * std::cos(2 * w * t),
                                a * w * w * std::exp(-w * t));
    force = m * g * Vector3d::UnitZ() + m * acceleration + 2 * m * L * dpsi * dtheta * c * e1 +
            m * L * dpsi * dpsi * s * c * e2 - m * L * (dtheta * dtheta + dpsi * dpsi * s * s) * e3;
    const Vector3d H = J1 * dtheta * e1 + J2 * dpsi * s * e2 + J3 * dpsi * c * e3,
                   turn = dtheta * e1 + dpsi * s * e2 + dpsi * c * e3;
    moment = L * e3.cross(force) + turn.cross(H) + J2 * dpsi * dtheta * c * e2 - J3 * dpsi * dtheta * s * e3;
  }
};

/// Ex 6.2 by hand: Newton and Euler for shaft, axle A and payload, from the tip to the ground.
struct PayloadArm {
  static constexpr double L = 0.8, H = 0.6, b = 0.1, m = 4, g = 9.81, T = 2;
  Eigen::Matrix3d axes;  // columns: the payload's
  Vector3d g2, g3, position;
  double psi_moment, theta_moment, phi_moment, power;

  explicit PayloadArm(double t) {
    const double k = 2 * M_PI / T, c = std::cos(k * t), s = std::sin(k * t);
    const double psi = 0.8 * s, dpsi = 0.8 * k * c, ddpsi = -0.8 * k * k * s;
    const double theta = 1 + 0.4 * c, dtheta = -0.4 * k * s, ddtheta = -0.4 * k * k * c;
    const double phi = 0.9 * t * t / (T * T), dphi = 1.8 * t / (T * T), ddphi = 1.8 / (T * T);
    const auto turn = [](double angle, const Vector3d& axis) {
      return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    };
    const Eigen::Matrix3d shaft = turn(psi, Vector3d::UnitZ()), A = shaft * turn(theta, Vector3d::UnitY());
    axes = A * turn(phi, Vector3d::UnitZ());
    g2 = shaft.col(1);
    g3 = A.col(2);
    const Vector3d E3 = Vector3d::UnitZ(), wS = dpsi * E3, aS = ddpsi * E3;
    const Vector3d wA = wS + dtheta * g2, aA = aS + ddtheta * g2 + wS.cross(dtheta * g2);
    const Vector3d w = wA + dphi * g3, a = aA + ddphi * g3 + wA.cross(dphi * g3);
    const auto rate = [](const Eigen::Matrix3d& Q, const Eigen::Matrix3d& J, const Vector3d& turning,
                         const Vector3d& second) {
      const Eigen::Matrix3d now = Q * J * Q.transpose();
      return Vector3d(now * second + turning.cross(now * turning));
    };
    Eigen::Matrix3d J;
    J << 0.06, 0, 0.01, 0, 0.08, 0, 0.01, 0, 0.05;
    const Vector3d out = H * g3, arm = out + b * axes.col(0);
    position = L * E3 + arm;
    // H g3 turns with axle A, b e1 with the payload.
    const Vector3d acceleration =
        aA.cross(out) + wA.cross(wA.cross(out)) + a.cross(arm - out) + w.cross(w.cross(arm - out));
    const Vector3d moment = arm.cross(m * (acceleration + g * E3)) + rate(axes, J, w, a);
    const Vector3d on_A = moment + rate(A, Vector3d(0.02, 0.01, 0.03).asDiagonal(), wA, aA);
    phi_moment = moment.dot(g3);
    theta_moment = on_A.dot(g2);
    psi_moment = on_A[2] + 0.04 * ddpsi;
    power = psi_moment * dpsi + theta_moment * dtheta + phi_moment * dphi;
  }
};

}  // namespace

TEST_CASE("R9: the moments of the drives of the payload arm satisfy the laws of Newton and Euler") {
  const model::Model model = model::read_model(test::model_path("R9_payload_arm"));
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  const auto s = derive::lagrange(m, system::Approach::one);
  std::vector<symbolic::Ref> roots;
  for (const system::Reaction& r : s.reactions) roots.push_back(r.value);
  for (const char* wanted : {"power", "payload.position1", "payload.position2", "payload.position3"}) {
    for (const system::Output& o : s.outputs) {
      if (o.name == wanted) roots.push_back(o.value);
    }
  }
  REQUIRE(roots.size() == 7);
  for (const double t : {0.0, 0.35, 1.1, 1.7}) {
    CAPTURE(t);
    const auto given = [&](const auto& self, const symbolic::Symbol& symbol) -> double {
      if (symbol.kind == symbolic::SymbolKind::time) return t;
      return symbolic::evaluate(*m.dag, {m.parameter_value[symbol.index]},
                                [&](const symbolic::Symbol& q) { return self(self, q); })[0];
    };
    const std::vector<double> found =
        symbolic::evaluate(*m.dag, roots, [&](const symbolic::Symbol& symbol) { return given(given, symbol); });
    const PayloadArm arm(t);
    CHECK(found[0] == doctest::Approx(arm.psi_moment).epsilon(1e-11));
    CHECK(found[1] == doctest::Approx(arm.theta_moment).epsilon(1e-11));
    CHECK(found[2] == doctest::Approx(arm.phi_moment).epsilon(1e-11));
    CHECK(found[3] == doctest::Approx(arm.power).epsilon(1e-10));
    for (int k = 0; k < 3; ++k)
      CHECK(found[static_cast<std::size_t>(4 + k)] == doctest::Approx(arm.position[k]).epsilon(1e-12));
  }
  // Part (d): back where it was, the payload has turned by phi(t1) - phi(t0) about g3(t0).
  const PayloadArm start(0), end(PayloadArm::T);
  const Eigen::AngleAxisd turned(Eigen::Matrix3d(end.axes * start.axes.transpose()));
  CHECK(turned.angle() == doctest::Approx(0.9).epsilon(1e-12));
  CHECK(turned.axis().dot(start.g3) == doctest::Approx(1).epsilon(1e-12));
}

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
        return symbolic::evaluate(*m.dag, {m.parameter_value[p.index]},
                                  [&](const symbolic::Symbol& q) { return self(self, q); })[0];
      };
      return value(value, symbol);
    };
    const std::vector<double> found = symbolic::evaluate(*m.dag, roots, parameter);
    const Arm arm(t);
    for (int k = 0; k < 3; ++k)
      CHECK(found[static_cast<std::size_t>(k)] == doctest::Approx(arm.force[k]).epsilon(1e-12));
    CHECK(found[3] == doctest::Approx(arm.moment[2]).epsilon(1e-11));
    CHECK(found[4] == doctest::Approx(arm.moment.dot(arm.e1)).epsilon(1e-11));
    CHECK(found[5] == doctest::Approx(arm.moment.dot(arm.e3)).epsilon(1e-11));
    // (7.104): what force and moment do is what the energy gains.
    const double work = arm.force.dot(arm.velocity) + Arm::dpsi * arm.moment[2] + Arm::dtheta * arm.moment.dot(arm.e1);
    CHECK(found[6] == doctest::Approx(work).epsilon(1e-11));
  }
}
