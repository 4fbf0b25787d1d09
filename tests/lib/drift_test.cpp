// Drift of invariants and the power balance: the scales defined in the header. The maxima never decrease.
#include "eom/watch/drift.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "eom/ode.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"
#include "support/tolerances.hpp"

TEST_CASE("drift: the largest distance from the initial value, relative to it") {
  eom::Drift drift("energy");
  for (const double value : {4.0, 4.1, 3.5, 4.0}) drift.observe(value);
  CHECK(drift.name() == "energy");
  CHECK(drift.initial() == 4);
  CHECK(drift.max_abs_drift() == 0.5);
  CHECK(drift.max_relative_drift() == 0.125);
}

TEST_CASE("drift: an initial value that is zero by cancellation is compared with the magnitude of its terms") {
  eom::Drift drift("energy");
  drift.observe(0, 100);
  drift.observe(1e-12, 200);
  CHECK(std::abs(drift.max_relative_drift() - 5e-15) < 1e-29);
  eom::Drift without("momentum");
  without.observe(0);
  without.observe(1e-12);
  CHECK(without.max_relative_drift() == 1e-12);  // no scale: absolute
}

TEST_CASE("drift: a value that is not finite makes it permanently infinite") {
  eom::Drift drift("energy");
  for (const double value : {1.0, std::numeric_limits<double>::quiet_NaN(), 1.0}) drift.observe(value);
  CHECK(std::isinf(drift.max_abs_drift()));
  CHECK(std::isinf(drift.max_relative_drift()));
}

TEST_CASE("drift: dop853 keeps the energy of Kepler's problem to 1e-10 over 20 periods at rtol 1e-13") {
  const problems::Kepler kepler;
  eom::Drift energy("energy");
  const auto watch = [&](std::span<const double> x) {
    const double kinetic = 0.5 * (x[2] * x[2] + x[3] * x[3]);
    const double potential = -1 / std::hypot(x[0], x[1]);
    energy.observe(kinetic + potential, kinetic - potential);
  };
  watch(kepler.start);
  eom::Options options;
  options.rtol = 1e-13;
  options.atol = 1e-14;
  compiled::integrate("dop853", kepler, 0, kepler.start, 125.6, options, [&](const eom::StepView& view) {
    watch(view.x1);
    return true;
  });
  CHECK(std::abs(energy.initial() + 0.5) < tolerances::rounding);
  CHECK(energy.max_relative_drift() < 1e-10);
  CHECK(energy.max_relative_drift() > 0);
}

TEST_CASE("power balance: energy lost to damping is the work done, as a quadrature beside the state") {
  // x'' = -x - c x', W' = -c x'^2
  const auto rhs = [](double, const double* x, double* dx) {
    dx[0] = x[1];
    dx[1] = -x[0] - 0.3 * x[1];
    dx[2] = -0.3 * x[1] * x[1];
    return 0;
  };
  const auto energy = [](std::span<const double> x) { return 0.5 * (x[0] * x[0] + x[1] * x[1]); };
  eom::PowerBalance honest;
  eom::PowerBalance without_work;
  const problems::State start{1, 0, 0};
  honest.observe(energy(start), 0);
  without_work.observe(energy(start), 0);
  eom::Options options;
  options.quadratures = 1;
  compiled::integrate("dop853", rhs, 0, start, 10, options, [&](const eom::StepView& view) {
    honest.observe(energy(view.x1), view.x1[2]);
    without_work.observe(energy(view.x1), 0);
    return true;
  });
  CHECK(honest.max_relative_defect() < tolerances::closed_form);
  CHECK(without_work.max_relative_defect() > 0.5);
}

TEST_CASE("power balance: relative to the largest energy or work exchanged, also where the energy starts at zero") {
  eom::PowerBalance balance;
  balance.observe(0, 0);
  balance.observe(-3, -3);
  balance.observe(1, 1.5);
  CHECK(balance.max_abs_defect() == 0.5);
  CHECK(std::abs(balance.max_relative_defect() - 0.5 / 3) < tolerances::rounding);
}
