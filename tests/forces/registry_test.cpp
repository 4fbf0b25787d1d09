// SPDX-License-Identifier: GPL-3.0-or-later
// Requirements on every kind of force in the registry. A new kind is checked automatically.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>

#include "forces/kind.hpp"
#include "model/names.hpp"
#include "oracle/forces/force_law.hpp"

using namespace eomgen;

namespace {

bool has_key(const forces::Kind& kind, const std::string& name) {
  return std::any_of(kind.keys.begin(), kind.keys.end(), [&](const forces::Key& key) { return key.name == name; });
}

bool has_potential(const forces::Kind& kind) {
  return std::any_of(kind.terms.begin(), kind.terms.end(), [](const forces::Term& term) {
    return term.load_type == forces::LoadType::potential || term.load_type == forces::LoadType::acceleration;
  });
}

}  // namespace

TEST_CASE("every kind of force has a unique name and a statement of the oracle, with an energy if it has a potential") {
  std::set<std::string> names;
  REQUIRE(forces::registry().size() >= 12);
  for (const forces::Kind& kind : forces::registry()) {
    CAPTURE(kind.name);
    CHECK(names.insert(kind.name).second);
    CHECK(forces::find(kind.name) == &kind);
    CHECK_FALSE(kind.title.empty());
    const verify::forces::ForceLaw& force_law = verify::forces::force_law(kind.name);
    CHECK((force_law.add_virtual_work != nullptr));
    CHECK((force_law.potential != nullptr) == has_potential(kind));
  }
  CHECK(forces::find("no_such_force") == nullptr);
}

TEST_CASE("keys, rules and terms of a kind refer to existing keys") {
  for (const forces::Kind& kind : forces::registry()) {
    CAPTURE(kind.name);
    std::set<std::string> keys;
    for (const forces::Key& key : kind.keys) {
      CAPTURE(key.name);
      CHECK(keys.insert(key.name).second);
      CHECK(model::is_identifier(key.name));
      for (const std::string& other : {key.default_requires, key.required_unless})
        CHECK((other.empty() || has_key(kind, other)));
      CHECK(key.choices.empty() == (key.type != forces::ValueType::choice));
    }
    for (const forces::Rule& rule : kind.rules) {
      CHECK(has_key(kind, rule.first));
      CHECK(has_key(kind, rule.second));
      CHECK_FALSE(rule.what.empty());
      CHECK_FALSE(rule.remedy.empty());
    }
    for (const forces::Term& term : kind.terms) {
      CHECK_FALSE(term.formula.empty());
      CHECK((term.domain == forces::Domain::bodies) == !term.arm.empty());
      for (const forces::Condition& when : term.conditions) CHECK(has_key(kind, when.key));
    }
    for (const forces::Line& line : {kind.spring, kind.damper}) CHECK(line.from.empty() == line.to.empty());
    // A linear spring has the energy of its stiffness and its length between two points, and stress varies the
    // stiffness.
    const forces::LinearSpring& linear = kind.linear_spring;
    CHECK(linear.stiffness.empty() == linear.length.empty());
    if (!linear.stiffness.empty()) {
      CHECK(has_key(kind, linear.length));
      CHECK(std::any_of(kind.keys.begin(), kind.keys.end(), [&](const forces::Key& key) {
        return key.name == linear.stiffness && key.is_stiffness && key.unit == "N/m";
      }));
      CHECK(has_potential(kind));
    }
    const bool data = kind.form == forces::InputFormat::table || kind.form == forces::InputFormat::value;
    CHECK(data == !kind.terms.empty());
    if (kind.form == forces::InputFormat::value) CHECK(kind.keys.at(0).name == kind.name);
  }
}
