// SPDX-License-Identifier: MIT
// Contacts with friction at one instant, against closed forms: a block on an incline, a puck pushed in two directions,
// three balls in a row, a block held from two sides.
#include "eom/contacts/friction_problem.hpp"

#include <doctest/doctest.h>

#include <cmath>

using eom::contacts::FrictionForces;
using eom::contacts::FrictionProblem;
using eom::contacts::solve_friction_problem;
using Kind = FrictionProblem::Kind;

namespace {

/// A particle of unit mass on a rough plane: rows are the normal and the tangents; q are accelerations without contact.
FrictionProblem particle(const Eigen::VectorXd& q, double mu) {
  FrictionProblem problem{Eigen::MatrixXd::Identity(q.size(), q.size()), q, {Kind::unilateral}, {{{}, 0, 1, 0, mu}}};
  for (Eigen::Index a = 1; a < q.size(); ++a) {
    problem.kinds.push_back(Kind::friction);
    problem.laws[0].tangents.push_back(a);
  }
  return problem;
}

}  // namespace

TEST_CASE("friction problem: a block on an incline sticks below the angle of friction, and slides above it") {
  const FrictionForces sticks = solve_friction_problem(particle(Eigen::Vector2d(-2, 0.9), 0.5));
  REQUIRE(sticks.found);
  CHECK(sticks.force(0) == doctest::Approx(2));
  CHECK(sticks.force(1) == doctest::Approx(-0.9));
  CHECK(std::abs(sticks.speed[0]) < 1e-12);  // rows are softened by 1e-13
  const FrictionForces slides = solve_friction_problem(particle(Eigen::Vector2d(-2, 1.5), 0.5));
  REQUIRE(slides.found);
  CHECK(slides.force(1) == doctest::Approx(-1));
  CHECK(slides.velocity(1) == doctest::Approx(0.5));
  const FrictionForces leaves = solve_friction_problem(particle(Eigen::Vector2d(0.1, 1.5), 0.5));
  CHECK(leaves.force.isZero(0));
}

TEST_CASE("friction problem: in two directions the force opposes the slip to 1e-12, whatever the angle") {
  for (double angle = 0.1; angle < 6.2; angle += 0.37) {
    CAPTURE(angle);
    const FrictionForces slides =
        solve_friction_problem(particle(Eigen::Vector3d(-2, 3 * std::cos(angle), 3 * std::sin(angle)), 0.5));
    REQUIRE(slides.found);
    CHECK(std::abs(slides.force(1) + std::cos(angle)) < 1e-12);
    CHECK(std::abs(slides.force(2) + std::sin(angle)) < 1e-12);
    const FrictionForces sticks =
        solve_friction_problem(particle(Eigen::Vector3d(-2, 0.999 * std::cos(angle), 0.999 * std::sin(angle)), 0.5));
    REQUIRE(sticks.found);
    CHECK(sticks.speed[0] < 1e-12);
  }
}

TEST_CASE("friction problem: three balls that meet at the same time") {
  // Gap speeds v2 - v1, v3 - v2 of unit masses; the first ball arrives with speed 1. Newton's law with e = 1.
  FrictionProblem balls;
  balls.G.resize(2, 2);
  balls.G << 2, -1, -1, 2;
  balls.q = Eigen::Vector2d(2 * -1.0, 0);
  balls.kinds = {Kind::unilateral, Kind::unilateral};
  const FrictionForces impulses = solve_friction_problem(balls);
  REQUIRE(impulses.found);
  CHECK(impulses.force(0) == doctest::Approx(4.0 / 3));
  CHECK(impulses.force(1) == doctest::Approx(2.0 / 3));
}

TEST_CASE("friction problem: held rows are eliminated, and friction may hang on their force") {
  // A bead on a rough rod across which a force of 3 acts: the rod holds it, and friction takes at most 0.5 * 3.
  FrictionProblem bead;
  bead.G = Eigen::Matrix2d::Identity();
  bead.q = Eigen::Vector2d(-3, 2);
  bead.kinds = {Kind::bilateral, Kind::friction};
  bead.laws = {{{1}, 0, 1, 0, 0.5}};
  const FrictionForces forces = solve_friction_problem(bead);
  REQUIRE(forces.found);
  CHECK(forces.force(0) == doctest::Approx(3));
  CHECK(forces.force(1) == doctest::Approx(-1.5));
  CHECK(forces.velocity(1) == doctest::Approx(0.5));
}

TEST_CASE("friction problem: the residual is that of the laws, not of the method") {
  const FrictionProblem problem = particle(Eigen::Vector3d(-2, 3, 4), 0.5);
  FrictionForces slides = solve_friction_problem(problem);
  REQUIRE(slides.found);
  CHECK(slides.residual < 1e-13);  // the iteration ends there
  CHECK(eom::contacts::complementarity_residual(problem, slides) == slides.residual);
  slides.force(1) += 0.01;  // no longer against the slip
  slides.velocity = problem.G * slides.force + problem.q;
  CHECK(eom::contacts::complementarity_residual(problem, slides) > 1e-3);
  // A row that separates without a force, and one that is pressed together.
  FrictionProblem gaps{Eigen::Matrix2d::Identity(), Eigen::Vector2d(1, -2), {Kind::unilateral, Kind::unilateral}, {}};
  FrictionForces forces = solve_friction_problem(gaps);
  CHECK(forces.residual < 1e-15);  // the softness of the rows, 1e-13, does not stay
  forces.force(0) = 0.1;           // holds what separates
  forces.velocity = gaps.G * forces.force + gaps.q;
  CHECK(eom::contacts::complementarity_residual(gaps, forces) == doctest::Approx(0.05));
}

TEST_CASE("friction problem: friction just above its limit slides, whatever the units") {
  // The sleeve of a woodpecker toy: grams and millimetres, so that a force of 0.1 N belongs to 100 m/s^2.
  for (const double unit : {1.0, 1e-6, 1e6}) {
    CAPTURE(unit);
    FrictionProblem sleeve = particle(Eigen::Vector2d(0, 0), 0.3);
    sleeve.G << 1092.45, -1035.52, -1035.52, 1448.97;
    sleeve.G *= unit;
    const Eigen::Vector2d sticking(0.144777, 0.3 * 0.144777 * (1 + 2e-9));  // what would hold it
    sleeve.q = -sleeve.G * sticking;
    const FrictionForces forces = solve_friction_problem(sleeve);
    REQUIRE(forces.found);
    CHECK(forces.residual < 1e-12);
    CHECK(forces.velocity(1) < -1e-8 * unit);
    CHECK(forces.force(1) <= 0.3 * forces.force(0) * (1 + 1e-12));
  }
}

TEST_CASE("friction problem: what sticks is at rest to rounding, also where the rows depend on one another") {
  // The strike of a foot of a compass gait. With its impulse of 13 N s a softness of 1e-13 would leave 3e-13 m/s.
  FrictionProblem foot = particle(Eigen::Vector2d(-0.883003, -0.299951), 0.8);
  foot.G << 0.1202317, 0.2246799, 0.2246799, 0.8249386;
  const FrictionForces impulses = solve_friction_problem(foot);
  REQUIRE(impulses.found);
  CHECK(impulses.residual < 1e-15);
  CHECK(std::abs(impulses.velocity(0)) < 2e-15);
  CHECK(std::abs(impulses.velocity(1)) < 2e-15);
  // A table on four legs: three rows are independent.
  Eigen::MatrixXd legs(4, 3);
  legs << 1, 1, 1, 1, 1, -1, 1, -1, 1, 1, -1, -1;
  FrictionProblem table{legs * legs.transpose(), Eigen::VectorXd::Constant(4, -8), {}, {}};
  table.kinds.assign(4, Kind::unilateral);
  const FrictionForces shares = solve_friction_problem(table);
  REQUIRE(shares.found);
  CHECK(shares.residual < 1e-14);
  CHECK(shares.force.sum() == doctest::Approx(8));  // the shares are not determined
}
