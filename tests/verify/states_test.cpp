// SPDX-License-Identifier: GPL-3.0-or-later
// States of first order against the oracle: rates, forces, outputs and energies that use them.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "verify/certificate.hpp"

using namespace eomgen;

namespace {

// A bead on a wire that a constraint moves, with everything that a rate and a force may use: an eliminated coordinate,
// a function of time and its rate, an input, velocities of points, other states, kinks, and an integral beside them.
const char* const text = R"toml(
format = 1
[parameters]
m = 1.5
k = 3.1
c = 0.7
a = 0.4
T = 0.3
[functions]
d = "a*sin(2*t)"
[inputs]
u = { default = 0.8 }
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y", "z"] }
[[constraint]]
name = "lift"
holonomic = "z - d - integral(sqrt(1 + t^2))"
[[state]]
name = "f"
rate = "k*(ddt(norm(P)) - f/c) + z_dot*y"
energy = "f^2/(2*k)*(1 + d^2)"
initial = 0.4
[[state]]
name = "w"
rate = "(u + d_dot + lag - w)/T - abs(f)*w^3"
[[force]]
on = "P"
force = "-f*unit(P) - (w + 0.1*ddt(w))*E2"
[definitions]
lag = "f*w - x_dot*z"
slope = "diff(lag^2, f) + ddt(lag)"
[scene.default]
t = [0.2, 2]
initial = { x = 1.2, y = 0.3, w = "x/2" }
)toml";

const verify::Comparison* row(const verify::Certificate& c, const std::string& a) {
  const auto found =
      std::find_if(c.comparisons.begin(), c.comparisons.end(), [&](const auto& entry) { return entry.a == a; });
  return found == c.comparisons.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("states: rates, forces, energies and outputs of every formulation agree with the oracle to 45 digits") {
  mechanics::Mechanics m = mechanics::build_mechanics(model::read_model_text(text, "states.toml"));
  const verify::Certificate c = verify::verify(m, {50, 3, 1});
  CHECK(c.pass);
  const verify::Comparison* rates = row(c, "rates of states of first order");
  REQUIRE(rates != nullptr);
  CHECK_FALSE(rates->shares_code);
  CHECK(rates->digits_agreed >= 45);
  CHECK(row(c, "integrals of time") != nullptr);
  for (const char* one : {"power of lagrange I", "outputs of lagrange II", "energies of jacobian II"})
    CHECK(row(c, one) != nullptr);
}

TEST_CASE("states: a wrong rate, a wrong force and a forgotten energy are found") {
  mechanics::Mechanics m = mechanics::build_mechanics(model::read_model_text(text, "states.toml"));
  symbolic::Dag& dag = *m.dag;
  const symbolic::Ref f = dag.symbol({symbolic::SymbolKind::state, 0, 0});
  const auto certified = [&](const auto& change) {
    verify::Subjects subjects;
    subjects.systems = {verify::all_formulations(m).front()};
    change(subjects.systems.front());
    return verify::certify(m, subjects, {50, 2, 1});
  };
  CHECK(certified([](system::EquationSystem&) {}).pass);
  const verify::Certificate rate = certified([&](system::EquationSystem& s) {
    s.states[1].rate = dag.add(s.states[1].rate, dag.mul(f, dag.constant(cln::cl_RA(1) / 1000000)));
  });
  CHECK_FALSE(rate.pass);
  CHECK_FALSE(row(rate, "rates of states of first order")->pass);
  CHECK_FALSE(certified([&](system::EquationSystem& s) { s.f[0] = dag.add(s.f[0], f); }).pass);
  CHECK_FALSE(certified([&](system::EquationSystem& s) { s.energy = dag.add(s.kinetic, s.potential); }).pass);
}
