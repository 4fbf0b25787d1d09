// SPDX-License-Identifier: GPL-3.0-or-later
// Stick and slip of derived models in the mode machine, against closed forms.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "eom/modes/contacts.hpp"
#include "friction/compiled.hpp"
#include "friction/rough_models.hpp"

using namespace eomgen;
using std::numbers::pi;

namespace {

// rtol = atol = 1e-13 over a few periods; the closed forms are exact.
constexpr double closed_form = 1e-10;

template <class Observer>
eom::ModeResult run(const test::RoughProgram& rough, std::vector<double> x0, double t1, Observer&& observer) {
  const auto rhs = [&](double t, const double* x, int mode, double* dx) { return rough.rhs(t, x, mode, dx); };
  const auto functions = [&](double t, const double* x, int mode, double* g) { return rough.contacts(t, x, mode, g); };
  eom::Contacts rule(rough.contact_list(), rough.states(), rhs, functions);
  eom::Options options;
  options.rtol = 1e-13;
  options.atol = 1e-13;
  const int mode = rule.start(0, x0);
  return eom::integrate_modes("dop853", rhs, 0, x0, mode, t1, options, functions, rule.functions(), rule.table(), rule,
                              std::forward<Observer>(observer));
}
eom::ModeResult run(const test::RoughProgram& rough, std::vector<double> x0, double t1) {
  return run(rough, std::move(x0), t1, [](const eom::StepView&, int) { return true; });
}

}  // namespace

TEST_CASE("friction: a block on a belt sticks for 5 and slips for 2(pi - atan 2.5), again and again") {
  const test::RoughProgram rough(test::belt, {1, 1, 0.2, 1, 0.5, 1});
  const double stick = 5, slip = 2 * (pi - std::atan(2.5));
  const eom::ModeResult end = run(rough, {0, 0.2}, 4 * (stick + slip));
  REQUIRE(end.outcome == eom::Outcome::done);
  REQUIRE(end.events.size() >= 6);
  // The belt carries the block from x = 0 to the limit x = 1. It sticks again at x = 0 (sticking starts at the mirror
  // image 1 - 2 * 0.5).
  double t = 5;
  for (std::size_t i = 0; i < end.events.size(); ++i) {
    CHECK(end.events[i].kind == (i % 2 == 0 ? "slip" : "stick"));
    CHECK(end.events[i].name == "belt");
    CHECK(std::abs(end.events[i].t - t) <= closed_form);
    t += i % 2 == 0 ? slip : stick;
  }
}

TEST_CASE("friction: an oscillator with dry friction stops as in the closed form, and loses the work of friction") {
  const test::RoughProgram rough(test::dry, {1, 1, 0.25, 1});
  const eom::ModeResult end = run(rough, {1.6, 0}, 20);
  REQUIRE(end.outcome == eom::Outcome::done);
  CHECK(std::abs(end.x[0] + 0.1) <= closed_form);  // 1.6 -> -1.1 -> 0.6 -> -0.1, inside the band of 0.25
  CHECK(std::abs(end.x[1]) <= closed_form);
  REQUIRE(!end.events.empty());
  CHECK(end.events.back().kind == "stick");
  CHECK(std::abs(end.events.back().t - 3 * pi) <= 1e-7);  // a turning point: dt^2 of the position
  const double lost = (1.6 * 1.6 - end.x[0] * end.x[0]) / 2, work = 0.25 * (2.7 + 1.7 + 0.7);
  CHECK(std::abs(lost - work) <= closed_form);
}

TEST_CASE("friction: of two masses on rough lines one may stick while the other slides") {
  const test::RoughProgram rough(test::rough_line, {1, 1.5, 10, 8, 0.3, 0.2, 9.81});
  bool modes_differ = false;  // at first A sticks with 2.6 of 2.94, B is pulled with 5.6 of 4.41
  const eom::ModeResult end = run(rough, {1.3, 3.0, 0, 0}, 20, [&](const eom::StepView&, int mode) {
    modes_differ = modes_differ || ((mode % 6 % 3 == 0) != (mode / 6 % 3 == 0));
    return true;
  });
  CHECK(end.outcome == eom::Outcome::done);
  CHECK(modes_differ);
  // At the end both stick, within their cones.
  CHECK(end.mode % 3 == 0);
  CHECK(end.mode / 6 % 3 == 0);
  double g[10];
  rough.contacts(end.t, end.x.data(), end.mode, g);
  for (const int i : {1, 2, 6, 7}) CHECK(g[i] >= 0);
}
