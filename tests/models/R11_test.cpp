// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "conservation/conservative.hpp"
#include "models/displayed_model.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("R11: a constant moment is conservative only if the body rotates about its direction") {
  DisplayedModel r11("R11_constant_moment"), axis("R11_constant_moment_fixed_axis");
  CHECK(conservation::classify_forces(r11.s.mechanics).at(0).conservative == conservation::ConservativeVerdict::no);
  const conservation::ForceClassification fixed = conservation::classify_forces(axis.s.mechanics).at(0);
  CHECK(fixed.conservative == conservation::ConservativeVerdict::yes);
  REQUIRE(fixed.potential.has_value());
  CHECK(same(reading::display_sum(axis.s.mechanics, *fixed.potential), -(axis("M0") * axis("n"))));
}

// Ziegler's two ways to one attitude: half a turn about E3, or half turns about E1 and then E2, which do no work.
TEST_CASE("R11: two paths to the same attitude with different work") {
  const auto rotation = [](int axis) {
    std::array<std::array<int, 3>, 3> R{};
    for (int k = 0; k < 3; ++k) R[static_cast<std::size_t>(k)][static_cast<std::size_t>(k)] = k == axis ? 1 : -1;
    return R;
  };
  const auto product = [](const auto& a, const auto& b) {
    std::array<std::array<int, 3>, 3> c{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
    return c;
  };
  CHECK(product(rotation(1), rotation(0)) == rotation(2));
  // In the model: with 1-2-3 angles the moment's components along n1, n2 vanish on the second way, and not along n3 at
  // n1 = n2 = 0.
  DisplayedModel r11("R11_constant_moment");
  const reading::DisplayForm form = r11.form(system::Approach::two);
  const Sum M0 = r11("M0"), n1 = r11("n1"), n2 = r11("n2");
  CHECK(r11.equation(form, "n1").force.is_zero());
  CHECK(same(r11.equation(form, "n2").force, M0 * sin(n1)));
  CHECK(same(r11.equation(form, "n3").force, M0 * cos(n1) * cos(n2)));
}

TEST_CASE(
    "R11: the energy increases by the work of the moment; about a fixed axis T + U is conserved and the rotation "
    "is that of M0/J") {
  const FinishedRun run = run_model("R11_constant_moment");
  CHECK(run.simulation.result.power_balance < 1e-8);
  for (std::size_t i = 0; i < run.rows.size(); ++i)
    CHECK(run.rows.at(i, "work") == doctest::Approx(run.rows.at(i, "power")).epsilon(1e-12));
  const FinishedRun axis = run_model("R11_constant_moment_fixed_axis");
  CHECK(axis.drift("energy.applied") < 1e-12);
  CHECK(axis.final("n") == doctest::Approx(0.1 + 5 + 0.3 / 2.5 * 25 / 2).epsilon(1e-12));
}
