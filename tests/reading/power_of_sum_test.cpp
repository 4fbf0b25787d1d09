// SPDX-License-Identifier: GPL-3.0-or-later
// Brackets of springs: sums with them are equal to the expanded ones, and no longer.
#include "reading/power_of_sum.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "reading/by_name.hpp"
#include "reading/reading.hpp"
#include "reading/trig.hpp"

using namespace eomgen;
using reading::Sum;

namespace {

/// The sum with every bracket multiplied out.
Sum expanded(const Sum& sum) {
  Sum result;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    Sum term(coefficient);
    for (const reading::Factor& factor : monomial) {
      term = term * (reading::is_bracket(*factor.atom) ? reading::power(factor.atom->args[0], factor.exponent)
                                                       : Sum(reading::Monomial{factor}, 1));
    }
    result += term;
  }
  return reading::simplify(result);
}

bool has_brackets(const Sum& sum) {
  bool found = false;
  reading::for_each_atom(sum, [&](const reading::Atom& atom) { found = found || reading::is_bracket(atom); });
  return found;
}

}  // namespace

TEST_CASE("brackets: energies and equations of shipped models are those without them") {
  for (const char* name :
       {"E7_2_spring_on_body", "P4_moving_cone", "P5_rough_sphere", "P12_pfaffian_set", "P13_saddle_field",
        "R18_euler_121", "S1_two_masses", "S4_two_particles", "andrews_squeezer", "car_axis", "elastic_pendulum",
        "engine_mount", "lugre_friction", "pid_cart", "quarter_car", "six_bar_spatial", "woodpecker"}) {
    CAPTURE(std::string(name));
    const mechanics::Mechanics m = mechanics::build_mechanics(model::read_model(test::shipped(name)));
    int with = 0;
    for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
      const reading::DisplayForm form = reading::derive_display_form(m, approach);
      const auto check = [&](const Sum& sum, const Sum& kept) {
        with += has_brackets(kept) ? 1 : 0;
        CHECK(kept.size() <= sum.size());
        CHECK(reading::simplify(expanded(kept) - sum).is_zero());
      };
      check(form.potential, with_powers(form.potential, form.powers));
      for (const reading::Equation& equation : form.equations) {
        check(equation.expanded, with_brackets(equation.expanded, form.powers));
        check(equation.slope, with_brackets(equation.slope, form.powers));
        check(equation.force, with_brackets(equation.force, form.powers));
      }
    }
    if (std::string(name) != "R18_euler_121") CHECK(with > 0);
  }
}

TEST_CASE("brackets: a difference of coordinates is kept only if no other term contains them") {
  const auto powers_of = [](const std::string& potential) {
    const mechanics::Mechanics m = mechanics::build_mechanics(
        model::read_model_text("format = 1\n[parameters]\nk = 1\nK = 1\n[coordinates]\nx = {}\ny = {}\n[energy]\n"
                               "kinetic = \"x_dot^2 + y_dot^2\"\npotential = \"" +
                                   potential + "\"\n",
                               "chain.toml"));
    const reading::DisplayForm form = reading::derive_display_form(m, system::Approach::two);
    std::vector<bool> result;
    for (const reading::Equation& e : form.equations)
      result.push_back(has_brackets(with_brackets(e.expanded, form.powers)));
    return result;
  };
  CHECK(powers_of("k*(y - x)^2/2") == std::vector<bool>{true, true});
  CHECK(powers_of("k*(y - x)^2/2 + K*x^2/2") == std::vector<bool>{false, true});
}

TEST_CASE("brackets: the powers of untrusted models are few and short") {
  const auto count = [](const std::string& potential) {
    return reading::powers_of_sums(mechanics::build_mechanics(model::read_model_text(
                                       "format = 1\n[parameters]\nk = 1\n[coordinates]\nx = {}\n[energy]\n"
                                       "kinetic = \"x_dot^2\"\npotential = \"" +
                                           potential + "\"\n",
                                       "long.toml")))
        .size();
  };
  CHECK(count("k*(x - 1)^8") == 1);
  CHECK(count("k*(x - 1)^9") == 0);
  CHECK(count("k*(x + sin(x) + cos(x) + exp(x) + x^2 + x^3 + 1)^2") == 0);
  std::string sum = "k*(x - 1)^2";
  for (int i = 2; i < 200; ++i) sum += " + k*(x - " + std::to_string(i) + ")^2";
  CHECK(count(sum) == 64);
}
