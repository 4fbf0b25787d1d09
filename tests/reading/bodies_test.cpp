// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies in Euler parameters, whose formulas are quotients of long sums.
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>

#include "reading/by_name.hpp"
#include "symbolic/calculus.hpp"
#include "work.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

const char* const rolling_disk = R"toml(format = 1
[parameters]
m = 1
R = 0.2
[[body]]
name = "disk"
mass = "m"
inertia = { disk = "R" }
position = { cartesian = ["x1", "x2", "x3"] }
rotation = { euler_parameters = ["e0", "e1", "e2", "e3"] }
[[constraint]]
name = "contact"
rolling = { body = "disk", shape = { disk = "R" }, on = "ground" }
)toml";

/// A sum is an atom only under powers other than 1; printing and comparison rely on it.
bool is_canonical(const Sum& sum) {
  bool result = true;
  const std::function<void(const Sum&)> visit = [&](const Sum& s) {
    for (const auto& [monomial, coefficient] : s.terms()) {
      for (const reading::Factor& factor : monomial) {
        result = result && !(factor.atom->op == reading::Op::add && reading::is_one(factor.exponent));
        for (const Sum& arg : factor.atom->args) visit(arg);
      }
    }
  };
  visit(sum);
  return result;
}

}  // namespace

TEST_CASE(
    "a rolling disk in Euler parameters: constraint and time derivative are canonical, and factors S/S are gone") {
  System s(model::read_model_text(rolling_disk, "disk"));
  const reading::DisplayForm form = reading::derive_display_form(s.mechanics, system::Approach::two);
  std::size_t seen = 0;
  for (const reading::DisplayConstraint& c : form.constraints) {
    if (c.holonomic) continue;
    ++seen;
    CHECK(c.acceleration_skip_reason.empty());
    CHECK(is_canonical(c.rate));
    CHECK(is_canonical(c.acceleration));
    // x1_dot, or x2_dot, is alone.
    CHECK(std::any_of(c.rate.terms().begin(), c.rate.terms().end(),
                      [](const auto& term) { return term.first.size() == 1 && reading::is_one(term.second); }));
  }
  CHECK(seen == 2);
}

TEST_CASE("sqrt(x^2 S^-2) of a sum of squares S is |x|/S: S is never negative") {
  System s(model::read_model_text(rolling_disk, "disk"));
  ByName n(s.mechanics);
  const Sum S = square(n("e0")) + square(n("e1"));
  const Sum root = sqrt(square(n("x1")) * reading::power(S, -2));
  CHECK(is_canonical(root));
  CHECK(root == over(reading::call(symbolic::Op::abs, {n("x1")}), S));
  CHECK(reading::call(symbolic::Op::abs, {S}) == S);
}

TEST_CASE("a budget ends a calculation that exceeds it, also when nested; the outer budget is charged too") {
  const auto exceeds_budget = [](std::size_t outer, std::size_t inner, std::size_t operations) {
    const work::Budget around(outer);
    bool over = false;
    try {
      const work::Budget budget(inner);
      work::consume_budget(operations);
    } catch (const work::BudgetExceeded&) {
      over = true;
    }
    return over;
  };
  CHECK_FALSE(exceeds_budget(100, 10, 10));
  CHECK(exceeds_budget(100, 10, 11));
  CHECK(exceeds_budget(5, 10, 6));
  const work::Budget around(100);
  {
    const work::Budget budget(60);
    work::consume_budget(50);
  }
  CHECK_NOTHROW(work::consume_budget(50));
  CHECK_THROWS_AS(work::consume_budget(1), work::BudgetExceeded);
}
