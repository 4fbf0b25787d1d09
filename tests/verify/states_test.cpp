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

TEST_CASE("resets: values, conditions and event functions agree with the oracle, and a wrong one is found") {
  const std::string with_resets = std::string(text).substr(0, std::string(text).find("[scene.default]")) + R"toml(
[discrete]
gear = { initial = 1 }
[[event]]
name = "hit"
when = "x*y_dot - gear*w"
if = "f + x_dot > 0"
set = { x_dot = "-0.3*x_dot + norm(P)*u", gear = "gear + lag", f = "d_dot - f*x" }
[[sample]]
every = "0.1*T"
set = { gear = "y_dot*lag" }
[scene.default]
t = [0.2, 2]
initial = { x = 1.2, y = 0.3, w = "x/2" }
)toml";
  mechanics::Mechanics m = mechanics::build_mechanics(model::read_model_text(with_resets, "resets.toml"));
  symbolic::Dag& dag = *m.dag;
  const auto certified = [&](const auto& change) {
    verify::Subjects subjects;
    subjects.systems = {verify::all_formulations(m).front()};
    change(subjects.systems.front());
    return verify::certify(m, subjects, {50, 2, 1});
  };
  const verify::Certificate right = certified([](system::EquationSystem&) {});
  CHECK(right.pass);
  for (const char* name : {"events", "resets"}) {
    REQUIRE(row(right, name) != nullptr);
    CHECK_FALSE(row(right, name)->shares_code);
    CHECK(row(right, name)->digits_agreed >= 45);
  }
  const auto off = [&dag](symbolic::Ref value) { return dag.mul(value, dag.constant(cln::cl_RA(1000001) / 1000000)); };
  CHECK_FALSE(row(certified([&](auto& s) { s.events[0].value = off(s.events[0].value); }), "events")->pass);
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k);
    const auto wrong =
        certified([&](auto& s) { s.events[0].reset.set[k].value = off(s.events[0].reset.set[k].value); });
    CHECK_FALSE(row(wrong, "resets")->pass);
  }
  const auto condition =
      certified([&](auto& s) { s.events[0].reset.condition = dag.sub(dag.one(), *s.events[0].reset.condition); });
  CHECK_FALSE(row(condition, "resets")->pass);
  const auto sample =
      certified([&](auto& s) { s.samples[0].reset.set[0].value = off(s.samples[0].reset.set[0].value); });
  CHECK_FALSE(row(sample, "resets")->pass);
}
