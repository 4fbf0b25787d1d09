// SPDX-License-Identifier: GPL-3.0-or-later
// The oracle against equations of motion derived by hand, at states with arbitrary accelerations and multipliers: the
// residual is lhs - rhs and must agree as a number, not only vanish.
#include "oracle/dalembert.hpp"

#include <cln/rational.h>
#include <doctest/doctest.h>

#include <random>

#include "verify/near.hpp"
#include "verify/sample_models.hpp"

using namespace eomgen;
using namespace eomgen::verify::test;
using verify::Oracle;
using verify::Real;
using verify::State;

namespace {

constexpr int digits = 60;
constexpr int agreement = 55;

struct Dice {
  std::mt19937_64 engine{20240607};
  const verify::Precision p{digits};
  Real operator()(int low, int high) {
    const cln::cl_RA u = cln::cl_RA(static_cast<long>(engine() % 1000003)) / 1000003;
    return p.round(low + u * (high - low));
  }
};

State random_state(const Oracle& oracle, Dice& dice) {
  State s;
  s.t = dice(0, 3);
  for (std::size_t i = 0; i < oracle.model().coordinates.size(); ++i) {
    s.q.push_back(dice(1, 2));
    s.qdot.push_back(dice(-2, 2));
    s.qddot.push_back(dice(-3, 3));
  }
  std::vector<Real> given;
  for (std::size_t i = 0; i < oracle.model().parameters.size(); ++i) given.push_back(dice(1, 3));
  s.parameters = oracle.parameters(given);
  for (std::size_t i = 0; i < oracle.model().inputs.size(); ++i) s.inputs.push_back(dice(-2, 2));
  return s;
}

void check_rows(const std::vector<verify::Residual>& rows, const std::vector<Real>& expected) {
  REQUIRE(rows.size() == expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CAPTURE(i);
    CHECK(near(rows[i].value, expected[i], agreement, rows[i].scale));
  }
}

}  // namespace

TEST_CASE("oracle: the particle on a moving sphere obeys (2.109) in spherical coordinates") {
  const model::Model m = moving_sphere();
  const Oracle oracle(m, digits);
  Dice dice;
  for (int point = 0; point < 5; ++point) {
    const State s = random_state(oracle, dice);
    const Real lambda = dice(-4, 4);
    const Real &mass = s.parameters[0], &g = s.parameters[1], &D = s.parameters[2];
    const Real &R = s.q[0], &Rd = s.qdot[0], &Rdd = s.qddot[0], &pd = s.qdot[1], &pdd = s.qddot[1], &td = s.qdot[2],
               &tdd = s.qddot[2];
    const Real sp = cln::sin(s.q[1]), cp = cln::cos(s.q[1]);
    check_rows(
        oracle.dalembert_residuals(s, {lambda}),
        {mass * (Rdd - R * pd * pd - R * sp * sp * td * td) + mass * g * cp - lambda,
         mass * (R * R * pdd + 2 * R * Rd * pd - R * R * sp * cp * td * td) - mass * g * R * sp,
         mass * (R * R * sp * sp * tdd + 2 * R * Rd * sp * sp * td + 2 * R * R * sp * cp * pd * td) - D * R * R * sp});
  }
}

TEST_CASE("oracle: constraint rates along the path are those of R - d(t)") {
  const model::Model m = moving_sphere();
  const Oracle oracle(m, digits);
  Dice dice;
  const State s = random_state(oracle, dice);
  const Real &d0 = s.parameters[3], &a = s.parameters[4], &w = s.parameters[5];
  const verify::ConstraintValues c = oracle.constraint_values(s);
  CHECK(near(c.psi[0], s.q[0] - d0 - a * cln::sin(w * s.t), agreement));
  CHECK(near(c.psi_dot[0], s.qdot[0] - a * w * cln::cos(w * s.t), agreement));
  CHECK(near(c.psi_ddot[0], s.qddot[0] + a * w * w * cln::sin(w * s.t), agreement));
  CHECK(c.gradient[0][0] == 1);
  CHECK(cln::zerop(c.gradient[0][1]));
}

TEST_CASE("oracle: cart and pendulum from their energies give Lagrange's equations") {
  const model::Model m = cart_pendulum();
  const Oracle oracle(m, digits);
  Dice dice;
  for (int point = 0; point < 5; ++point) {
    const State s = random_state(oracle, dice);
    const Real &M = s.parameters[0], &mass = s.parameters[1], &l = s.parameters[2], &g = s.parameters[3],
               &c = s.parameters[4], &F = s.inputs[0];
    const Real sn = cln::sin(s.q[1]), cs = cln::cos(s.q[1]);
    check_rows(oracle.dalembert_residuals(s, {}),
               {(M + mass) * s.qddot[0] + mass * l * (s.qddot[1] * cs - s.qdot[1] * s.qdot[1] * sn) - F + c * s.qdot[0],
                mass * l * cs * s.qddot[0] + mass * l * l * s.qddot[1] + mass * g * l * sn});
  }
}

TEST_CASE("oracle: the double pendulum in absolute angles") {
  const model::Model m = chain(2);
  const Oracle oracle(m, digits);
  Dice dice;
  for (int point = 0; point < 5; ++point) {
    const State s = random_state(oracle, dice);
    const Real &m1 = s.parameters[0], &l1 = s.parameters[1], &m2 = s.parameters[2], &l2 = s.parameters[3],
               &g = s.parameters[4];
    const Real c12 = cln::cos(s.q[0] - s.q[1]), s12 = cln::sin(s.q[0] - s.q[1]);
    check_rows(oracle.dalembert_residuals(s, {}),
               {(m1 + m2) * l1 * l1 * s.qddot[0] + m2 * l1 * l2 * (s.qddot[1] * c12 + s.qdot[1] * s.qdot[1] * s12) +
                    (m1 + m2) * g * l1 * cln::sin(s.q[0]),
                m2 * l2 * l2 * s.qddot[1] + m2 * l1 * l2 * (s.qddot[0] * c12 - s.qdot[0] * s.qdot[0] * s12) +
                    m2 * g * l2 * cln::sin(s.q[1])});
  }
}

TEST_CASE("oracle: spring, damper and rod of a pendulum in Cartesian coordinates") {
  const model::Model m = rod_pendulum();
  const Oracle oracle(m, digits);
  Dice dice;
  const State s = random_state(oracle, dice);
  const Real lambda = dice(-4, 4);
  const Real &mass = s.parameters[0], &g = s.parameters[1], &k = s.parameters[3], &c = s.parameters[4];
  const Real dx = s.q[0] - 2, dy = s.q[1] - 1;
  const Real length = cln::sqrt(oracle.precision().round(dx * dx + dy * dy));
  const Real speed = (dx * s.qdot[0] + dy * s.qdot[1]) / length;
  const Real tension = k * (length - cln::cl_RA(3) / 2) + c * speed;
  check_rows(oracle.dalembert_residuals(s, {lambda}),
             {mass * s.qddot[0] + tension * dx / length - 2 * lambda * s.q[0],
              mass * s.qddot[1] + mass * g + tension * dy / length - 2 * lambda * s.q[1]});
}

TEST_CASE("oracle: variable mass, drag, attraction, torsion, an energy of the extension, diff and ddt in a force") {
  model::Model m;
  const ModelFormula k = parameter(m, "k", 2);
  const ModelFormula x = coordinate(m, "x");
  const ModelFormula zero = number(m, 0);
  const ModelFormula P = place(m, "P", vector(x, zero, zero), time(m) * k);  // m = k t
  force(m, "drag", {{"on", P.id}, {"density", k.id}, {"area", k.id}, {"coefficient", k.id}});
  force(m, "central_gravity", {{"GM", k.id}, {"center", (-(k * E(m, 1))).id}});
  force(m, "torsion", {{"angle", (x ^ 2).id}, {"stiffness", k.id}, {"rest", zero.id}, {"coefficient", k.id}});
  const ModelFormula e = leaf(m, Op::extension, 0);
  force(m, "spring", {{"a", vector(zero, zero, zero).id}, {"b", P.id}, {"length", k.id}, {"energy", (k * (e ^ 4)).id}});
  applied(m, diff(ddt(x ^ 3), rate(x)) * E(m, 1), P);  // 3 x^2
  const Oracle oracle(m, digits);
  Dice dice;
  const State s = random_state(oracle, dice);
  const Real &K = s.parameters[0], &X = s.q[0], &V = s.qdot[0];
  const Real drag = -K * K * K / 2 * cln::abs(V) * V, pull = -K * (K * s.t) / ((X + K) * (X + K));
  const Real torsion = -(K * X * X + K * 2 * X * V) * 2 * X, spring = -4 * K * cln::expt(X - K, 3);
  check_rows(oracle.dalembert_residuals(s, {}),
             {K * s.t * s.qddot[0] + K * V - drag - pull - torsion - spring - 3 * X * X});
}

TEST_CASE("oracle: energies and their rates balance for the true motion") {
  const model::Model m = cart_pendulum();
  const Oracle oracle(m, digits);
  Dice dice;
  State s = random_state(oracle, dice);
  const verify::EnergyValues e = oracle.energy_values(s);
  const auto rows = oracle.dalembert_residuals(s, {});
  // dT/dt + dU/dt = sum (residual_i + Q_i) qdot_i for a scleronomic system
  const Real work = (rows[0].value + s.inputs[0] - s.parameters[4] * s.qdot[0]) * s.qdot[0] + rows[1].value * s.qdot[1];
  CHECK(near(e.kinetic_rate + e.potential_rate, work, agreement, e.rate_scale));
}

TEST_CASE("oracle: dependent parameters are computed, basis vectors are dual to one another") {
  model::Model m = moving_sphere();
  model::Parameter J;
  J.name = "J";
  J.value = (leaf(m, Op::parameter, 0) * leaf(m, Op::parameter, 3)).id;
  m.parameters.push_back(J);
  const Oracle oracle(m, digits);
  CHECK(oracle.is_independent_parameter(0));
  CHECK(!oracle.is_independent_parameter(6));
  Dice dice;
  const State s = random_state(oracle, dice);
  CHECK(near(s.parameters[6], s.parameters[0] * s.parameters[3], agreement));
  model::Chart chart;
  chart.system = "spherical";
  for (std::uint32_t i = 0; i < 3; ++i) chart.entries[i] = leaf(m, Op::coordinate, i).id;
  m.places[1].chart = chart;
  const ModelFormula P = leaf(m, Op::place, 1, 0, true);
  for (std::uint32_t i = 0; i < 3; ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const ModelFormula a = basis(Op::covariant_basis, P, leaf(m, Op::coordinate, i));
      const ModelFormula g = basis(Op::contravariant_basis, P, leaf(m, Op::coordinate, k));
      CHECK(near(oracle.evaluate(dot(a, g).id, s), i == k ? 1 : 0, agreement, 1));
    }
  const ModelFormula e_phi = basis(Op::unit_basis, P, leaf(m, Op::coordinate, 1));
  CHECK(near(oracle.evaluate(dot(e_phi, E(m, 3)).id, s), -cln::sin(s.q[1]), agreement));
}
