// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/open_contacts.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

using namespace eomgen;

TEST_CASE("open contacts: the other constraints keep their joints and forces, and forces of open contacts are 0") {
  const model::Model read = model::read_model_text(R"toml(format = 1
[parameters]
m = 2
J = 0.3
[[body]]
name = "A"
mass = "m"
inertia = { principal = ["J", "J", "J"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { axis = "E3", angle = "q" }
[[constraint]]
name = "floor"
holonomic = "z + 1"
holds = "unilateral"
[[joint]]
name = "hinge"
type = "pin"
bodies = ["ground", "A"]
at = ["origin", "A - A.e1/2"]
axis = "E3"
[[event]]
name = "lifted"
when = "reaction.floor - 1"
[[event]]
name = "torn"
when = "reaction.hinge.1 - 5"
)toml",
                                                   "hinged");
  REQUIRE(read.constraints.size() >= 2);
  const std::shared_ptr<const model::Model> open = model::without_open_contacts(read, {"floor"});
  CHECK(open->constraints.size() == read.constraints.size() - 1);
  CHECK(std::none_of(open->constraints.begin(), open->constraints.end(),
                     [](const model::Constraint& c) { return c.unilateral; }));
  CHECK(model::without_open_contacts(read, {})->constraints.size() == read.constraints.size());
  CHECK(model::without_open_contacts(read, {"hinge"})->constraints.size() == read.constraints.size());
  REQUIRE(open->joints.size() == 1);
  CHECK(open->constraints[open->joints[0].constraint].name == "hinge");
  CHECK(open->content_hash.empty());
  std::set<std::string> named;
  REQUIRE(open->arena.nodes.size() == read.arena.nodes.size());
  for (std::size_t i = 0; i < read.arena.nodes.size(); ++i) {
    const model::Node &before = read.arena.nodes[i], &after = open->arena.nodes[i];
    if (before.op != model::Op::reaction) continue;
    named.insert(read.constraints[before.index].name);
    if (read.constraints[before.index].name == "floor") {
      CHECK(after.op == model::Op::number);
      CHECK(after.value == 0);
    } else {
      CHECK(after.op == model::Op::reaction);
      CHECK(open->constraints[after.index].name == read.constraints[before.index].name);
    }
  }
  CHECK(named == std::set<std::string>{"floor", "hinge"});
}
