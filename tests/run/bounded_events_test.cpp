// SPDX-License-Identifier: GPL-3.0-or-later
// Event functions as tables for their bounds.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <eom/expressions/code.hpp>

#include "derive/formulations/lagrange.hpp"
#include "run/monitored_functions.hpp"

using namespace eomgen;

// The height of a point of a body in Euler parameters: y_2 + 2 L (p1 p2 + p0 p3) for a unit quaternion.
TEST_CASE("bounded events: the norm of Euler parameters is 1, so that no quotient widens the bounds") {
  model::Model model = model::read_model_text(R"toml(format = 1
[parameters]
L = 0.5
[[body]]
name = "B"
mass = 2
inertia = { principal = [1, 2, 3] }
position = { cartesian = ["x", "y", "z"] }
rotation = { euler_parameters = ["p0", "p1", "p2", "p3"] }
[[constraint]]
name = "floor"
holonomic = "dot(B + L*B.e1, E2)"
holds = "unilateral"
[scene.default]
t = [0, 1]
)toml",
                                              "quaternion.toml");
  mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
  const system::EquationSystem system = derive::lagrange(mechanics, system::Approach::one);
  REQUIRE(system.contacts.size() == 1);
  const std::vector<eom::expressions::Table> tables =
      run::bounded_events(system, {system.psi[*system.contacts[0].unilateral]});
  REQUIRE(tables.size() == 1);
  CHECK(std::none_of(tables[0].steps.begin(), tables[0].steps.end(),
                     [](const eom::expressions::Step& step) { return step.op == eom::expressions::Op::div; }));
  const eom::expressions::Code code(tables[0], std::vector<double>{0.5});
  const double p0 = 0.5, p1 = 0.1, p2 = -0.7, p3 = std::sqrt(1 - p0 * p0 - p1 * p1 - p2 * p2);
  const std::vector<double> variables{0, 4, 5, 6, p0, p1, p2, p3, 0, 0, 0, 0, 0, 0, 0};
  CHECK(code.value(variables) == doctest::Approx(5 + 2 * 0.5 * (p1 * p2 + p0 * p3)).epsilon(1e-14));
}
