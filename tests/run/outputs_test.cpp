// SPDX-License-Identifier: GPL-3.0-or-later
// An output has a kind in addition to its name: names in a model cannot mislead tables.
#include <doctest/doctest.h>

#include <algorithm>

#include "conservation/conserved.hpp"
#include "derive/formulations/lagrange.hpp"
#include "run/scene.hpp"

using namespace eomgen;
using system::OutputKind;

namespace {

/// A model whose names have the prefixes of outputs for runs.
const std::string rough = R"toml(format = 1
[parameters]
m = "1 kg"
mu = 0.5
g = "1 m/s^2"
[[particle]]
name = "contact"
mass = "m"
position = { cartesian = ["x", "y"] }
[[particle]]
name = "magnitude"
mass = "m"
position = { cartesian = ["u", "v"] }
[[point]]
name = "differential"
position = "x*E1 + u*E2"
[[force]]
gravity = "-g*E2"
[[constraint]]
name = "floor"
holonomic = "y"
friction = { static = "mu", dynamic = "mu" }
[[constraint]]
name = "bond"
velocity = "u_dot - 2*v_dot"
[scene.default]
t = [0, 1]
)toml";

struct Derived {
  model::Model model = model::read_model_text(rough, "outputs.toml");
  mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
  system::EquationSystem system = derive::lagrange(mechanics, system::Approach::one);
  std::vector<conservation::ConservedQuantity> conserved = conservation::conserved_quantities(mechanics, system);

  const system::Output& output(const std::string& name) const {
    const system::Output* found = system::find(system.outputs, name);
    CAPTURE(name);
    REQUIRE(found != nullptr);
    return *found;
  }
  std::vector<std::string> expanded(const std::string& name) const {
    return run::expand_outputs(mechanics, system, {{name, {}}});
  }
};

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

TEST_CASE("outputs: 'all' takes the outputs for readers, independent of the names in the model") {
  const Derived d;
  const std::vector<std::string> all = d.expanded("all");
  for (const char* name : {"contact.position1", "magnitude.velocity2", "differential.position1", "energy", "x_ddot",
                           "reaction.floor", "friction.floor.1", "slip.floor", "mode.floor", "integral.bond"})
    CHECK_MESSAGE(has(all, name), name);
  std::size_t for_runs = 0;
  for (const system::Output& output : d.system.outputs) {
    const bool of_run = system::audience(output.kind) == system::Audience::run;
    for_runs += of_run ? 1 : 0;
    CAPTURE(output.name);
    CHECK(has(all, output.name) ==
          (!of_run && output.kind != OutputKind::coordinate && output.kind != OutputKind::rate));
  }
  CHECK(for_runs >= 4);
}

TEST_CASE("outputs: the message for a wrong name lists the outputs for readers, and no others") {
  const Derived d;
  try {
    d.expanded("nothing");
    FAIL("a name that no output has");
  } catch (const Error& error) {
    const std::string& remedy = error.remedy();
    CHECK(remedy.find("contact.position1") != std::string::npos);
    for (const char* name : {"contact.slope", "contact.phi", "differential.bond"})
      CHECK_MESSAGE(remedy.find(name) == std::string::npos, name);
  }
}

TEST_CASE("outputs: kind, owner and unit") {
  const Derived d;
  const system::Output& velocity = d.output("contact.velocity2");
  CHECK(velocity.kind == OutputKind::velocity);
  CHECK(d.model.places[velocity.index].name == "contact");
  CHECK(velocity.part == 1);
  CHECK(velocity.unit == "m/s");
  const system::Output& slope = d.output("contact.slope.floor.x");
  CHECK(slope.kind == OutputKind::slip_slope);
  CHECK(d.system.contacts[slope.index].name == "floor");
  const auto free = static_cast<std::size_t>(
      std::count_if(d.system.outputs.begin(), d.system.outputs.end(),
                    [](const system::Output& output) { return output.kind == OutputKind::slip_slope; }));
  CHECK(free == d.system.free.size());
  const system::Output& integral = d.output("integral.bond");
  CHECK(integral.kind == OutputKind::integral);
  CHECK(system::names_of(d.system.outputs, OutputKind::differential, integral.index).size() ==
        d.system.free.size() + 1);
  CHECK(d.expanded("friction.floor") ==
        std::vector<std::string>{"friction.floor.1", "friction.floor.2", "friction.floor.3"});
}

TEST_CASE("outputs: units per second") {
  CHECK(system::per_second("m") == "m/s");
  CHECK(system::per_second("m", 2) == "m/s^2");
  CHECK(system::per_second("m/s", 2) == "(m/s)/s^2");
  CHECK(system::per_second("1") == "1/s");
  CHECK(system::per_second("").empty());
}
