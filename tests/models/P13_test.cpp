// SPDX-License-Identifier: GPL-3.0-or-later
// Force fields of Ex 2.1: verdicts from (2.20), potentials by their differences between two points, which do not depend
// on a constant.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "conservation/conservative.hpp"
#include "support/simulation.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;

namespace {

constexpr double rounding_of_numbers = 1e-13;  // about twenty operations on numbers of magnitude 1
constexpr double k = 2, GM = 3, c = 0.4;

struct Place {
  double x, y, z;
  double norm() const { return std::sqrt(x * x + y * y + z * z); }
};
const Place here{0.7, 0.4, -0.3}, there{1.9, 0.8, 1.1};  // both with x > 0, y > 0: no cut between them

using Field = std::function<double(const Place&)>;

struct Expected {
  std::string name;
  conservation::ConservativeVerdict verdict;
  bool many_valued;
  Field U;  // empty: no potential
};

const std::vector<Expected>& expected() {
  using enum conservation::ConservativeVerdict;
  static const std::vector<Expected> fields{
      {"F1", no, false, {}},
      {"F2", yes, false, [](const Place& p) { return -k * p.x * p.y; }},
      {"F3", no, false, {}},
      {"F4", no, false, {}},
      {"spring", yes, false, [](const Place& p) { return k / 2 * (p.norm() - 0.5) * (p.norm() - 0.5); }},
      {"attraction", yes, false, [](const Place& p) { return -GM / p.norm(); }},
      {"vortex", no, true, [](const Place& p) { return -c * std::atan2(p.y, p.x); }}};
  return fields;
}

double value(const mechanics::Mechanics& m, symbolic::Ref r, const std::vector<double>& q) {
  const auto lookup = [&](const symbolic::Symbol& s) -> double {
    if (s.kind == symbolic::SymbolKind::coordinate) return q[s.index];
    if (s.kind == symbolic::SymbolKind::parameter) return cln::double_approx(m.dag->value(m.parameter_value[s.index]));
    return std::nan("");
  };
  return symbolic::evaluate(*m.dag, {r}, lookup)[0];
}

void check_fields(const std::string& name, const std::function<std::vector<double>(const Place&)>& coordinates) {
  INFO(name);
  const model::Model model = model::read_model(test::model_path(name));
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  const std::vector<conservation::ForceClassification> found = conservation::classify_forces(m);
  REQUIRE(found.size() == expected().size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Expected& right = expected()[i];
    INFO(right.name);
    CHECK(found[i].name == right.name);
    CHECK(found[i].conservative == right.verdict);
    CHECK(found[i].many_valued == right.many_valued);
    CHECK(found[i].reason.empty() == (right.verdict == conservation::ConservativeVerdict::yes));
    CHECK_FALSE(found[i].in_energy);
    REQUIRE(found[i].potential.has_value() == static_cast<bool>(right.U));
    if (!right.U) continue;
    const double difference =
        value(m, *found[i].potential, coordinates(there)) - value(m, *found[i].potential, coordinates(here));
    CHECK(difference == doctest::Approx(right.U(there) - right.U(here)).epsilon(rounding_of_numbers));
  }
}

}  // namespace

TEST_CASE("P13: in Cartesian coordinates two of the four fields of (2.155) are conservative, as their curl shows") {
  check_fields("P13_force_fields", [](const Place& p) { return std::vector<double>{p.x, p.y, p.z}; });
}

TEST_CASE("P13: in cylindrical coordinates the verdicts and the potentials are the same") {
  check_fields("P13_force_fields_cylindrical", [](const Place& p) {
    return std::vector<double>{std::hypot(p.x, p.y), std::atan2(p.y, p.x), p.z};
  });
}

TEST_CASE("P13: e_theta/r does work 2 pi c per turn although its curl vanishes, and its domain excludes the axis") {
  const model::Model model = model::read_model(test::model_path("P13_force_fields_cylindrical"));
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  const conservation::ForceClassification vortex = conservation::classify_forces(m).back();
  REQUIRE(vortex.work.has_value());
  CHECK(value(m, *vortex.work, {1, 1, 1}) == doctest::Approx(2 * std::numbers::pi * c).epsilon(rounding_of_numbers));
  CHECK(vortex.reason.find("one turn of theta") != std::string::npos);
  const model::Model cartesian = model::read_model(test::model_path("P13_force_fields"));
  mechanics::Mechanics n = mechanics::build_mechanics(cartesian);
  const conservation::ForceClassification same = conservation::classify_forces(n).back();
  CHECK(same.reason.find("a closed path in the plane of x1 and x2") != std::string::npos);
  CHECK_FALSE(same.domain.empty());
}

TEST_CASE("P13: the energy with the potentials of forces is conserved, T + U is not") {
  const test::FinishedRun run = test::run_model("P13_saddle_field", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
  CHECK(run.drift("energy.applied") < 1e-9);  // 10 s at rtol 1e-12, on a saddle where the motion grows
  CHECK_THROWS(run.drift("energy"));
  CHECK(run.simulation.result.power_balance < 1e-9);
}
