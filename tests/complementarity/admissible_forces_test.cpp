// SPDX-License-Identifier: MIT
// Forces that the motion does not determine, against closed forms: a box on two feet, a ladder at a wall.
#include "eom/contacts/admissible_forces.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using eom::contacts::AdmissibleForces;
using eom::contacts::ForceLimit;
using eom::contacts::forces_without_effect;
using eom::contacts::least_margin;
using eom::contacts::margin_error;

namespace {

/// A foot with the forces N = x(first), T = x(first + 1).
ForceLimit foot(Eigen::Index first, double mu) { return {first, 1, 0, true, mu, 1, first + 1, 1}; }

}  // namespace

// N = 1 and 3, T1 + T2 = push: the feet hold up to push = 4 mu, each by its own share.
TEST_CASE("admissible forces: two feet share friction as long as any share holds") {
  const double mu = 0.5;
  const std::vector<ForceLimit> limits{foot(0, mu), foot(2, mu)};
  Eigen::MatrixXd Z(4, 1);
  Z << 0, 1, 0, -1;
  for (const double push : {0.0, 0.5, 1.2, 1.9, 1.999999, -1.9}) {
    CAPTURE(push);
    const Eigen::Vector4d equal(1, push / 2, 3, push / 2);
    const Eigen::VectorXd x = AdmissibleForces(equal, Z, limits).find();
    CHECK(std::abs(x(1) + x(3) - push) < 1e-12);
    CHECK(least_margin(limits, x) > 0);
    if (std::abs(push) < 0.9) CHECK(x == equal);
  }
  AdmissibleForces over(Eigen::Vector4d(1, 1.05, 3, 1.05), Z, limits);
  // The largest margin is the same at both feet: (4 mu - push)/2.
  CHECK(std::abs(least_margin(limits, over.find()) + 0.05) < 1e-11);  // the last weight of the barrier, times the terms
}

// A wheel in the corner of a floor and a wall, without a load on the wall. Friction at the wall turns it, so that of
// the floor is as large, and so is the force of the wall: N = 1 - T, T, T, T with T <= mu T has T = 0 alone.
TEST_CASE("admissible forces: a single set of forces within the limits is found within the stated error") {
  const std::vector<ForceLimit> limits{foot(0, 0.3), foot(2, 0.3)};
  Eigen::MatrixXd Z(4, 1);
  Z << -1, 1, 1, 1;
  for (const double begin : {0.0, 0.5, -0.2}) {
    CAPTURE(begin);
    AdmissibleForces corner(Eigen::Vector4d(1 - begin, begin, begin, begin), Z, limits);
    const Eigen::VectorXd x = corner.find();
    CHECK(std::abs(x(2)) <= margin_error(limits));
    CHECK(least_margin(limits, x) >= -margin_error(limits));
    CHECK(margin_error(limits) < 1e-11);
  }
}

TEST_CASE("admissible forces: they depend continuously on the loads") {
  const std::vector<ForceLimit> limits{foot(0, 0.5), foot(2, 0.5)};
  Eigen::MatrixXd Z(4, 1);
  Z << 0, 1, 0, -1;
  double before = 0;
  for (int k = 0; k <= 2000; ++k) {
    const double push = 2.1 * k / 2000;
    const double now = AdmissibleForces(Eigen::Vector4d(1, push / 2, 3, push / 2), Z, limits).find()(1);
    if (k > 0) CHECK(std::abs(now - before) < 0.02);  // steps of 0.001; the slope is at most that of 1/wanted near 1
    before = now;
  }
}

// Two opposite contacts: the preload may grow without bound, and its pull towards the given forces bounds it.
TEST_CASE("admissible forces: a wedged body gets a finite preload") {
  const std::vector<ForceLimit> limits{{0, 1, 0, false, 0, 0, -1, 1}, {1, 1, 0, false, 0, 0, -1, 1}};
  Eigen::MatrixXd Z(2, 1);
  Z << 1, 1;
  const Eigen::VectorXd x = AdmissibleForces(Eigen::Vector2d(0.5, -0.5), Z, limits).find();
  CHECK(std::abs(x(0) - x(1) - 1) < 1e-12);
  CHECK(x(1) > 0);
  CHECK(x(1) < 100);
}

TEST_CASE("forces without effect: the differences of equal columns") {
  Eigen::MatrixXd R(2, 3);
  R << 1, 2, 0, 0, 0, 5;
  const Eigen::MatrixXd Z = forces_without_effect(R);
  REQUIRE(Z.cols() == 1);
  CHECK((R * Z).norm() < 1e-12);
  CHECK(forces_without_effect(Eigen::MatrixXd::Identity(3, 3)).cols() == 0);
}
