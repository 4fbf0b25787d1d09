// SPDX-License-Identifier: GPL-3.0-or-later
// Stronge's energetic law: phases of slip by hand, limits in which all laws agree, and its energy.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <eom/contacts/stronge.hpp>
#include <random>

using eom::contacts::Collision;
using eom::contacts::CollisionImpulse;
using eom::contacts::solve_collision;

namespace {

/// Normal and tangential velocity after the impact.
std::array<double, 2> velocities_after(const Collision& at, const CollisionImpulse& by) {
  return {at.normal + at.nn * by.normal + at.nt * by.tangential,
          at.tangential + at.nt * by.normal + at.tt * by.tangential};
}

/// Twice the change of the kinetic energy.
double energy_change(const Collision& at, const CollisionImpulse& by) {
  const std::array<double, 2> after = velocities_after(at, by);
  return by.normal * (at.normal + after[0]) + by.tangential * (at.tangential + after[1]);
}

}  // namespace

TEST_CASE("Stronge's law is Newton's without friction, and where a central impact keeps its slip") {
  const Collision smooth{-1.5, 0.4, 3, 0.7, 2, 0, 0.6};
  const CollisionImpulse found = solve_collision(smooth);
  REQUIRE(found.found);
  CHECK(found.normal == doctest::Approx(1.6 * 1.5 / 3).epsilon(1e-15));
  CHECK(found.tangential == 0);
  const Collision central{-1.5, 4, 3, 0, 2, 0.1, 0.6};
  const CollisionImpulse rough = solve_collision(central);
  CHECK(rough.normal == doctest::Approx(1.6 * 1.5 / 3).epsilon(1e-15));
  CHECK(rough.tangential == doctest::Approx(-0.1 * rough.normal).epsilon(1e-15));
  // Slip in one sense throughout: Newton's and Poisson's laws have the same impulse also if nt is not 0.
  const Collision sliding{-1, 5, 2, 0.5, 1.5, 0.2, 0.7};
  CHECK(solve_collision(sliding).normal == doctest::Approx(1.7 / (2 - 0.2 * 0.5)).epsilon(1e-15));
}

TEST_CASE("Stronge's law with slip that reverses in compression: the phases by hand") {
  // Slip 0.2 ends at p = 0.2/1.5, where the normal velocity is -0.7; it reverses, since holding it takes 0.5 > mu.
  const Collision at{-1, 0.2, 2, -1, 2, 0.25, 0.5};
  const CollisionImpulse found = solve_collision(at);
  REQUIRE(found.found);
  const double first = 0.2 / 1.5, compression = 0.7 / 1.75;
  const double work = -first + 2.25 * first * first / 2 - 0.7 * compression / 2;
  const double restitution = std::sqrt(-0.25 * work * 2 / 1.75);
  CHECK(found.normal == doctest::Approx(first + compression + restitution).epsilon(1e-14));
  CHECK(found.tangential == doctest::Approx(0.25 * (compression + restitution - first)).epsilon(1e-14));
  CHECK(found.compression_work == doctest::Approx(work).epsilon(1e-14));
  CHECK(found.restitution_work == doctest::Approx(-0.25 * work).epsilon(1e-14));
  // Newton's law would have 0.5 here, Poisson's 1.75 (0.5 (first + compression)).
  CHECK(velocities_after(at, found)[0] == doctest::Approx(1.75 * restitution).epsilon(1e-14));
  CHECK(std::abs(velocities_after(at, found)[0] - 0.5) > 0.02);
  CHECK(std::abs(restitution - 0.5 * (first + compression)) > 0.002);
}

TEST_CASE("Stronge's law: slip that stops stays at rest if friction can hold it") {
  const Collision at{-1, 0.2, 2, -1, 2, 0.8, 0};
  const CollisionImpulse found = solve_collision(at);
  REQUIRE(found.found);
  const std::array<double, 2> after = velocities_after(at, found);
  CHECK(std::abs(after[0]) < 1e-15);
  CHECK(std::abs(after[1]) < 1e-15);
}

TEST_CASE("Stronge's law: a contact that jams separates once its slip has stopped") {
  const Collision jam{-1, 1, 1, 2, 6, 0.8, 0.5};  // nn - mu nt < 0 while it slides
  const CollisionImpulse found = solve_collision(jam);
  REQUIRE(found.found);
  CHECK(velocities_after(jam, found)[0] > 0);
  CHECK(found.compression_work < -0.5 / (1 + 0.8 * 2));
}

TEST_CASE("Stronge's law never gains energy, and restores the share e^2 of the normal work") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t solved = 0;
  for (int k = 0; k < 5000; ++k) {
    Collision at{-unit(random) - 1e-3, 4 * unit(random) - 2, 0.5 + unit(random), 0,
                 0.5 + unit(random),   1.5 * unit(random),   unit(random)};
    at.nt = (2 * unit(random) - 1) * 0.98 * std::sqrt(at.nn * at.tt);  // positive definite
    const CollisionImpulse found = solve_collision(at);
    if (!found.found) continue;
    ++solved;
    CAPTURE(k);
    const std::array<double, 2> after = velocities_after(at, found);
    CHECK(after[0] >= -1e-12);
    CHECK(energy_change(at, found) <= 1e-12);
    CHECK(std::abs(found.tangential) <= at.friction * found.normal * (1 + 1e-12));
    CHECK(found.restitution_work ==
          doctest::Approx(-at.restitution * at.restitution * found.compression_work).epsilon(1e-10));
  }
  CHECK(solved == 5000);  // slip always stops where it jams
}
