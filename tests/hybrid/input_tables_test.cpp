// SPDX-License-Identifier: MIT
// Inputs of a run as tables, held or along straight lines, against the exact motion of a mass.
#include <doctest/doctest.h>

#include <array>
#include <eom/hybrid/run.hpp>

namespace {

/// x'' = u.
int mass_rhs(double, const double* x, const double*, const double* u, const int*, double* dx) {
  dx[0] = x[1];
  dx[1] = u[0];
  return 0;
}
/// x, x_dot, kinetic and potential energy, their sum, the power of the force.
int mass_outputs(double, const double* x, const double*, const double* u, const int*, double* y) {
  const double T = x[1] * x[1] / 2;
  const std::array<double, 6> values{x[0], x[1], T, 0, T, x[1] * u[0]};
  std::copy(values.begin(), values.end(), y);
  return 0;
}

const std::vector<double> knots{-0.2, 0.1, 0.13, 0.7, 1.1, 1.2}, values{1, 3, -8, 2, 2, -5};

/// x and x' at 1.5 from rest: a cubic between two knots.
std::array<double, 2> exact_end(bool linear) {
  double x = 0, v = 0, from = 0;
  for (std::size_t k = 1; k <= knots.size(); ++k) {
    const bool is_last = k == knots.size();
    const double end = is_last ? 1.5 : knots[k], h = end - from,
                 slope = is_last || !linear ? 0 : (values[k] - values[k - 1]) / (knots[k] - knots[k - 1]);
    const double before = values[k - 1] + slope * (from - knots[k - 1]), after = before + slope * h;
    x += v * h + h * h * (2 * before + after) / 6;
    v += h * (before + after) / 2;
    from = end;
  }
  return {x, v};
}

}  // namespace

TEST_CASE("a linear table has its values at its times, straight lines in between, and is constant outside") {
  const eom::hybrid::Signal table{{}, {0, 1, 3}, {2, 4, -2}, {}, true};
  const auto at = [&](double t) { return eom::hybrid::table_value(table, t, t); };
  CHECK(at(-1).value == 2);
  CHECK(at(-1).slope == 0);
  CHECK(at(0.25).value == 2.5);
  CHECK(at(0.25).slope == 2);
  CHECK(at(2).value == 1);
  CHECK(at(2).slope == -3);
  CHECK(at(5).value == -2);
  CHECK(at(5).slope == 0);
  // On the segment that ends there, also beyond its end.
  CHECK(eom::hybrid::table_value(table, 1, 0.9).value == 4);
  CHECK(eom::hybrid::table_value(table, 1.5, 0.9).value == 5);
  CHECK(eom::hybrid::is_time_dependent(table));
  CHECK_FALSE(eom::hybrid::is_time_dependent({{}, {0, 1}, {2, 4}, {}}));
  CHECK_FALSE(eom::hybrid::is_time_dependent({{}, {0}, {2}, {}, true}));
}

TEST_CASE("steps end at the times of a table: a tolerance that allows any step gives the exact motion") {
  eom::hybrid::Code code;
  code.rhs = mass_rhs;
  code.outputs = mass_outputs;
  code.output_names = {"x", "x_dot", "kinetic", "potential", "energy", "power"};
  code.free = {0};
  for (const bool linear : {false, true}) {
    CAPTURE(linear);
    eom::hybrid::Problem problem;
    problem.code = &code;
    problem.t1 = 1.5;
    problem.start = {0, 0};
    problem.inputs = {{{}, knots, values, {}, linear}};
    problem.rtol = problem.atol = 0.1;
    problem.kinetic = 2;
    problem.potential = 3;
    problem.energy = 4;
    problem.power = 5;
    problem.estimate = false;
    problem.state_names = {"x", "x_dot"};
    for (const char* solver : {"dop853", "dopri5", "tsit5", "radau5", "rodas"}) {
      CAPTURE(std::string(solver));
      problem.solver = solver;
      const eom::hybrid::RunResult end = eom::hybrid::run(problem);
      REQUIRE(end.ended());
      CHECK(end.state[0] == doctest::Approx(exact_end(linear)[0]).epsilon(1e-11));
      CHECK(end.state[1] == doctest::Approx(exact_end(linear)[1]).epsilon(1e-11));
    }
  }
}
