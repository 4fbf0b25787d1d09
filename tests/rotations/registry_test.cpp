// SPDX-License-Identifier: GPL-3.0-or-later
// Every representation of rotations: its axes are orthonormal and right-handed, and the angular velocities, bases and
// singular sets of its file are correct.
#include <set>

#include "rotations/rotation_model.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

const std::string axes_of_B = "[definitions]\na1 = \"B.e1\"\na2 = \"B.e2\"\na3 = \"B.e3\"\nw = \"omega(B)\"\n";

/// Sets a regular state with nonzero rates. Euler parameters have unit norm, and rates that preserve it.
void set(RotationModel& model, const rotations::Rotation& r, const std::string& suffix = "", long shift = 0) {
  constexpr std::array<long, 4> unit{1, 2, 4, 10}, kept{2, -1, 10, -4};
  for (std::size_t k = 0; k < r.entries.size(); ++k) {
    const std::string name = r.entries[k].name + suffix;
    const long i = static_cast<long>(k) + shift;
    model.at[{name, 0}] = r.unit.empty() ? ratio(3 + 2 * i, 7 + i) : ratio(unit[k], 11);
    model.at[{name, 1}] = r.unit.empty() ? ratio(5 - 3 * i, 4 + i) : ratio(kept[k], 3);
  }
}

/// The registry's formulas as definitions basis_ik, dual_ik over the same coordinates.
std::string formulas(const rotations::Rotation& r) {
  std::string text;
  for (std::size_t i = 0; i < r.basis.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string ik = std::to_string(i) + std::to_string(k);
      text += "basis_" + ik + " = \"" + r.basis[i][k] + "\"\ndual_" + ik + " = \"" + r.dual[i][k] + "\"\n";
    }
  }
  if (!r.singularity.empty()) text += "regular = \"" + r.singularity + "\"\n";
  if (r.family == "axis") text += "r1 = \"1/3\"\nr2 = \"2/3\"\nr3 = \"-2/3\"\n";
  return text;
}

Numbers components(RotationModel& model, const std::string& kind, std::size_t i) {
  Numbers v;
  for (std::size_t k = 0; k < 3; ++k) v[k] = model.scalar(kind + "_" + std::to_string(i) + std::to_string(k));
  return v;
}

}  // namespace

TEST_CASE("rotations: there are the twelve sets of Euler angles, each once, and four others") {
  std::set<std::string> sets;
  for (const rotations::Rotation& r : rotations::registry()) {
    CHECK(rotations::find(r.name) == &r);
    if (r.family == "euler") sets.insert(r.name);
  }
  CHECK(sets ==
        std::set<std::string>{"121", "131", "212", "232", "313", "323", "123", "132", "213", "231", "312", "321"});
  CHECK(rotations::registry().size() == 16);
  CHECK(rotations::find("111") == nullptr);
}

TEST_CASE("rotations: Q Q^T = I and det Q = 1") {
  for (const rotations::Rotation& r : rotations::registry()) {
    CAPTURE(r.name);
    RotationModel model(body("B", rotation_toml(r)) + axes_of_B);
    set(model, r);
    if (!r.unit.empty()) model.at[{"e0", 0}] = 3;  // a rotation for parameters of any length
    const Numbers e1 = model.vector("a1"), e2 = model.vector("a2"), e3 = model.vector("a3");
    for (const Numbers& e : {e1, e2, e3}) CHECK(size(dot(e, e) - 1) < exact);
    CHECK(distance(cross(e1, e2), e3) < exact);
  }
}

TEST_CASE("rotations: the angular velocity is the axial vector of Qdot Q^T, along space and along the body's axes") {
  for (const rotations::Rotation& r : rotations::registry()) {
    CAPTURE(r.name);
    RotationModel model(body("B", rotation_toml(r)) + axes_of_B);
    set(model, r);
    if (!r.unit.empty()) model.at[{"e0", 0}] = 3;
    const Numbers turning = model.axial_vector("a"), w = model.vector("w"), own = model.angular_velocity(1);
    CHECK(distance(turning, w) < difference);
    CHECK(distance({dot(w, model.vector("a1")), dot(w, model.vector("a2")), dot(w, model.vector("a3"))}, own) < exact);
    CHECK(((size(dot(w, w)) > 0.1) == (r.family != "fixed")));
  }
}

TEST_CASE("rotations: w is the sum of the basis times the rates, and the dual basis recovers the rates") {
  for (const rotations::Rotation& r : rotations::registry()) {
    CAPTURE(r.name);
    RotationModel model(body("B", rotation_toml(r)) + axes_of_B + formulas(r));
    set(model, r);
    const Numbers own = model.angular_velocity(1);
    Numbers sum{0, 0, 0};
    for (std::size_t i = 0; i < r.basis.size(); ++i) {
      const Real rate = model.at[{r.entries[i].name, 1}];
      const Numbers g = components(model, "basis", i);
      for (std::size_t k = 0; k < 3; ++k) sum[k] = sum[k] + g[k] * rate;
      CHECK(size(dot(components(model, "dual", i), own) - rate) < exact);
      if (r.unit.empty()) {
        for (std::size_t j = 0; j < r.basis.size(); ++j) {
          CHECK(size(dot(components(model, "dual", i), components(model, "basis", j)) - (i == j ? 1 : 0)) < exact);
        }
      }
    }
    CHECK(distance(sum, own) < exact);
  }
}

TEST_CASE("rotations: the basis of Euler angles is dependent exactly at the documented angles") {
  for (const rotations::Rotation& r : rotations::registry()) {
    CAPTURE(r.name);
    CHECK((r.family == "euler") == !r.singularity.empty());
    if (r.singularity.empty()) continue;
    RotationModel model(body("B", rotation_toml(r)) + axes_of_B + formulas(r));
    const auto volume = [&](const Real& n2) {
      set(model, r);
      model.at[{"n2", 0}] = n2;
      return dot(components(model, "basis", 0), cross(components(model, "basis", 1), components(model, "basis", 2)));
    };
    const Real half = cln::pi(cln::float_format(static_cast<std::uintptr_t>(digits))) / 2;
    const bool symmetric = r.name[0] == r.name[2];
    for (const Real& n2 : {Real(0), half, Real(-half), Real(2 * half), ratio(2, 3)}) {
      const bool singular = size(volume(n2)) < exact;
      CHECK(singular == (size(model.scalar("regular")) < exact));
    }
    CHECK((size(volume(0)) < exact) == symmetric);
    CHECK((size(volume(half)) < exact) == !symmetric);
    CHECK((size(volume(-half)) < exact) == !symmetric);
    CHECK((size(volume(2 * half)) < exact) == symmetric);
    CHECK(r.singular == (symmetric ? "n2 = 0, n2 = pi" : "n2 = pi/2, n2 = -pi/2"));
  }
}

TEST_CASE("rotations: relative to another body angular velocities add up, in every pair of representations") {
  for (const rotations::Rotation& a : rotations::registry()) {
    for (const rotations::Rotation& b : rotations::registry()) {
      if (b.family == "axis") continue;  // its axis is given along E1, E2, E3; tested below
      CAPTURE(a.name);
      CAPTURE(b.name);
      RotationModel model(body("B", rotation_toml(a, "a")) + body("C", rotation_toml(b, "b"), "relative_to = \"B\"\n") +
                          "[definitions]\na1 = \"C.e1\"\na2 = \"C.e2\"\na3 = \"C.e3\"\nw = \"omega(C)\"\n");
      set(model, a, "a");
      set(model, b, "b", 1);
      const Numbers w = model.vector("w");
      CHECK(distance(model.axial_vector("a"), w) < difference);
      CHECK(distance({dot(w, model.vector("a1")), dot(w, model.vector("a2")), dot(w, model.vector("a3"))},
                     model.angular_velocity(2)) < exact);
    }
  }
}

TEST_CASE("rotations: an axis may be any vector that is fixed in the parent") {
  RotationModel model(
      body("B", "{ euler = \"321\", angles = [\"a\", \"b\", \"c\"] }") +
      body("C", "{ axis = \"B.e1 - 3*B.e3\", angle = \"d\" }", "relative_to = \"B\"\n") +
      "[definitions]\na1 = \"C.e1\"\na2 = \"C.e2\"\na3 = \"C.e3\"\nw = \"omega(C)\"\nof_B = \"dot(C.e1 - "
      "3*C.e3, B.e1 - 3*B.e3)\"\n");
  for (const char* name : {"a", "b", "c", "d"}) {
    model.at[{name, 0}] = ratio(name[0] - 'a' + 1, 3);
    model.at[{name, 1}] = ratio(7 - 2 * (name[0] - 'a'), 5);
  }
  CHECK(distance(model.axial_vector("a"), model.vector("w")) < difference);
  CHECK(size(model.scalar("of_B") - 10) < exact);
}
