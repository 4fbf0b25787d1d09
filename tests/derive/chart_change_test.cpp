// SPDX-License-Identifier: GPL-3.0-or-later
// Switches from one chart to another and back: the attitude or direction stays the same, and rates are the derivatives
// of the values.
#include "derive/chart_change.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "rotations/rotation.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;

namespace {

constexpr double chart_rounding = 1e-13;  // a few operations on numbers about 1, about 0.2 from a singular set
constexpr double difference = 1e-8;  // of central differences with steps of 1e-5: their square, times third derivatives

model::Model body(const std::string& set) {
  return model::read_model_text(
      "format = 1\n[[body]]\nname = \"B\"\nmass = 1\ninertia = { principal = [1, 2, 3] }\nrotation = { euler = \"" +
          set + "\", angles = [\"a\", \"b\", \"c\"] }\n[scene.default]\nt = [0, 1]\n",
      "body.toml");
}
model::Model particle() {
  return model::read_model_text(
      "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { spherical = [\"R\", \"phi\", \"theta\"] }\n"
      "[scene.default]\nt = [0, 1]\ninitial = { R = 1, phi = 1 }\n",
      "particle.toml");
}

using Values = std::vector<double>;  // angles, then rates

Values applied(symbolic::Dag& dag, const std::vector<symbolic::Ref>& formulas, const std::vector<std::uint32_t>& angles,
               const Values& x) {
  return symbolic::evaluate(dag, formulas, [&](const symbolic::Symbol& s) {
    const auto found = std::find(angles.begin(), angles.end(), s.index);
    REQUIRE(found != angles.end());
    return x[static_cast<std::size_t>(found - angles.begin()) + (s.order == 1 ? angles.size() : 0)];
  });
}

/// Rows e_k . E_j.
Eigen::Matrix3d attitude(const std::string& set, const Values& n) {
  Eigen::Matrix3d Q = Eigen::Matrix3d::Identity();
  for (std::size_t s = 0; s < 3; ++s)
    Q = Eigen::AngleAxisd(-n[s], Eigen::Vector3d::Unit(set[s] - '1')).toRotationMatrix() * Q;
  return Q;
}

Values moved(const Values& x, double h) {
  Values result = x;
  for (std::size_t k = 0; k < x.size() / 2; ++k) result[k] += h * x[x.size() / 2 + k];
  return result;
}

/// The rates of `formulas` against the change of its values along the motion.
void check_rates(symbolic::Dag& dag, const std::vector<symbolic::Ref>& formulas,
                 const std::vector<std::uint32_t>& angles, const Values& x) {
  constexpr double h = 1e-5;
  const Values before = applied(dag, formulas, angles, moved(x, -h)),
               after = applied(dag, formulas, angles, moved(x, h));
  const Values here = applied(dag, formulas, angles, x);
  for (std::size_t k = 0; k < angles.size(); ++k) {
    CHECK(std::remainder(after[k] - before[k], 2 * M_PI) / (2 * h) ==
          doctest::Approx(here[angles.size() + k]).epsilon(difference));
  }
}

}  // namespace

TEST_CASE(
    "chart change: each of the twelve sets converts to a second one with the same attitude and rates that match the "
    "values") {
  std::size_t sets = 0;
  for (const rotations::Rotation& r : rotations::registry()) {
    if (r.family != "euler") continue;
    CAPTURE(r.name);
    ++sets;
    const model::Model model = body(r.name);
    const std::vector<model::ChartPair> charts = model::charts(model);
    REQUIRE(charts.size() == 1);
    CHECK(charts[0].refusal.empty());
    CHECK(rotations::find(charts[0].second) != nullptr);
    CHECK(charts[0].singularity(model) == (r.name[0] == r.name[2] ? "sin(b)" : "cos(b)"));
    symbolic::Dag dag;
    const system::ChartChange change = derive::chart_change(dag, model, charts[0]);
    const double near = change.at_sine ? 0.2 : M_PI / 2 - 0.2;  // near the singularity of the own set
    for (const Values& x : {Values{0.4, near, -1.1, 0.3, -0.8, 1.7}, Values{2.9, near, 4.0, -2, 0.1, 0.6},
                            Values{-1.3, near + 0.5, 0.2, 1, 2, -3}}) {
      const Values second = applied(dag, change.to_second, change.angles, x);
      CHECK((attitude(r.name, x) - attitude(charts[0].second, second)).norm() < chart_rounding);
      check_rates(dag, change.to_second, change.angles, x);
      const Values again = applied(dag, change.to_own, change.angles, second);
      CHECK((attitude(r.name, again) - attitude(r.name, x)).norm() < chart_rounding);
      check_rates(dag, change.to_own, change.angles, second);
      const double guard = change.second_at_sine ? std::sin(second[1]) : std::cos(second[1]);
      if (x[1] == near) CHECK(std::abs(guard) > 0.97);  // the second set is far from singular there
    }
  }
  CHECK(sets == 12);
}

TEST_CASE("chart change: spherical coordinates about E3 and about E1") {
  const model::Model model = particle();
  const std::vector<model::ChartPair> charts = model::charts(model);
  REQUIRE(charts.size() == 1);
  symbolic::Dag dag;
  const system::ChartChange change = derive::chart_change(dag, model, charts[0]);
  CHECK(change.singularity == "sin(phi)");
  for (const Values& x : {Values{0.2, 0.9, -1.1, 0.3}, Values{M_PI - 0.2, -2.5, 0.4, 1.6}}) {
    const Values second = applied(dag, change.to_second, change.angles, x);
    CHECK(std::cos(second[0]) == doctest::Approx(std::sin(x[0]) * std::cos(x[1])).epsilon(chart_rounding));
    CHECK(std::sin(second[0]) * std::cos(second[1]) ==
          doctest::Approx(std::sin(x[0]) * std::sin(x[1])).epsilon(chart_rounding));
    CHECK(std::sin(second[0]) * std::sin(second[1]) == doctest::Approx(std::cos(x[0])).epsilon(chart_rounding));
    check_rates(dag, change.to_second, change.angles, x);
    const Values again = applied(dag, change.to_own, change.angles, second);
    for (std::size_t k = 0; k < 4; ++k) CHECK(again[k] == doctest::Approx(x[k]).epsilon(chart_rounding));
    check_rates(dag, change.to_own, change.angles, second);
  }
}
