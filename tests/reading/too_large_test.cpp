// SPDX-License-Identifier: GPL-3.0-or-later
// Large systems: displayed by parts, quickly.
#include <doctest/doctest.h>

#include <chrono>

#include "reading/by_name.hpp"
#include "reading/forms.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

// Planar chain of n masses with relative angles: its energy has of the order of n^5 terms.
std::string relative_chain(int n) {
  std::string text = "format = 1\n[parameters]\nm = 1\nl = 1\ng = 9.81\n[coordinates]\n";
  for (int i = 1; i <= n; ++i) text += "q" + std::to_string(i) + " = {}\n";
  std::string angle;
  for (int i = 1; i <= n; ++i) {
    angle += (i > 1 ? " + q" : "q") + std::to_string(i);
    const std::string before = i > 1 ? "P" + std::to_string(i - 1) + " + " : "";
    text += "[[particle]]\nname = \"P" + std::to_string(i) + "\"\nmass = \"m\"\nposition = \"" + before + "l*sin(" +
            angle + ")*E1 - l*cos(" + angle + ")*E2\"\n";
  }
  return text + "[[force]]\ngravity = \"-g*E2\"\n";
}

}  // namespace

TEST_CASE("a chain of 15 relative angles is displayed by parts, with every coordinate, in seconds") {
  System s(model::read_model_text(relative_chain(15), "chain"));
  const auto start = std::chrono::steady_clock::now();
  const reading::DisplayForm form = reading::derive_display_form(s.mechanics, system::Approach::one);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
  CHECK(form.is_unexpanded);
  CHECK(form.equations.size() == 15);
  CHECK(reading::residuals_on_dag(form, s.mechanics).empty());
}

TEST_CASE("a form too long in one approach is not tried in the other if both have the same equations") {
  System s(model::read_model_text(relative_chain(15), "chain"));
  reading::DisplayForms forms(s.mechanics);
  const reading::DisplayForm& one = forms(system::Approach::one);
  CHECK(one.is_unexpanded);
  const work::Budget nothing(0);
  const reading::DisplayForm& two = forms(system::Approach::two);
  CHECK(two.is_unexpanded);
  CHECK(two.approach == system::Approach::two);
  CHECK(two.equations.size() == 15);
  CHECK(two.unexpanded_reason == one.unexpanded_reason);
  CHECK(reading::derive_display_form(s.mechanics, system::Approach::two).unexpanded_reason != one.unexpanded_reason);
}

TEST_CASE("a chain of 4 relative angles is expanded, with residuals on the Dag") {
  System s(model::read_model_text(relative_chain(4), "chain"));
  const reading::DisplayForm form = reading::derive_display_form(s.mechanics, system::Approach::one);
  CHECK_FALSE(form.is_unexpanded);
  CHECK(reading::residuals_on_dag(form, s.mechanics).size() == 4);
}
