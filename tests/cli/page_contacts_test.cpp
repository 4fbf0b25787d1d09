// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts on pages of `report` (through Node): stick and slip, impacts, ever smaller bounces, against `run --set`.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <optional>

#include "page_script.hpp"
#include "program.hpp"

using namespace eomgen::test;

namespace {

// Relative, both methods at rtol = 1e-11; each impact and each start of slip multiplies the errors before it.
constexpr double of_solvers = 1e-6;

// A ball in a corner: the bounces of both sides accumulate together.
const char* const corner = R"toml(format = 1
[parameters]
e = 0.6
[[particle]]
name = "P"
mass = 1
position = { cartesian = ["x", "y", 0] }
[[force]]
gravity = "-9.81*E2"
[[constraint]]
name = "left"
holonomic = "x + y"
holds = "unilateral"
restitution = "e"
[[constraint]]
name = "right"
holonomic = "y - x"
holds = "unilateral"
restitution = "e"
[scene.default]
t = [0, 3]
initial = { x = 0.1, y = 1 }
)toml";

// A block on a belt that a sample strikes: new velocities have new modes.
const char* const struck = R"toml(format = 1
[parameters]
blow = 0.8
[[particle]]
name = "P"
mass = 1
position = { cartesian = ["x", "y", 0] }
[[force]]
gravity = "-9.81*E2"
[[constraint]]
name = "floor"
holonomic = "y"
holds = "unilateral"
friction = { static = 0.3, dynamic = 0.2 }
[[sample]]
name = "strike"
every = 0.5
offset = 0.1
set = { x_dot = "x_dot + blow", y_dot = "y_dot + blow/4" }
[scene.default]
t = [0, 2]
initial = { x = 0, x_dot = 0.3, y = 0 }
)toml";

// A rough bar falls on two of its ends, with restitution by the ratio of impulses.
const char* const dropped_bar = R"toml(format = 1
[parameters]
e = 0.3
mu = 0.2
[[body]]
name = "bar"
mass = "1 kg"
inertia = "1[kg*m^2]/12"
position = { cartesian = ["x", "0", "z"] }
rotation = { axis = "E2", angle = "phi" }
[[force]]
gravity = "-9.81[m/s^2]*E3"
[[constraint]]
name = "left"
sliding = { body = "bar", at = "-0.5[m]*bar.e1", on = "ground" }
holds = "unilateral"
restitution = "e"
friction = { static = "mu", dynamic = "mu/2" }
[[constraint]]
name = "right"
sliding = { body = "bar", at = "0.5[m]*bar.e1", on = "ground" }
holds = "unilateral"
restitution = "e"
friction = { static = "mu", dynamic = "mu/2" }
[impacts]
law = "poisson"
[scene.default]
t = [0, 2]
initial = { x = 0, x_dot = 1, z = 0.6, phi = 0.4 }
)toml";

// A puck that a force which grows and turns sets in motion: slip in two directions.
const char* const puck = R"toml(format = 1
[parameters]
mu = 0.3
[[particle]]
name = "P"
mass = 1
position = { cartesian = ["x", "y", "z"] }
[[force]]
gravity = "-9.81*E3"
[[force]]
on = "P"
force = "3*t*E1 + sin(5*t)*E2"
[[constraint]]
name = "floor"
holonomic = "z"
holds = "unilateral"
friction = { static = "mu", dynamic = "mu" }
[scene.default]
t = [0, 2]
initial = { x = 0, y = 0, z = 0 }
)toml";

// A disc in a corner that a growing torque turns. While it sticks, the motion does not determine the forces.
const char* const wedged = R"toml(format = 1
[parameters]
mu = 0.3
[[body]]
name = "B"
mass = 2
inertia = 0.01
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "q" }
[[force]]
gravity = "-9.81*E2"
[[force]]
on = "B"
moment = "-0.3*t*E3"
[[constraint]]
name = "floor"
sliding = { body = "B", shape = { sphere = 0.1 }, on = { point = "origin", normal = "E2" } }
holds = "unilateral"
friction = { static = "mu", dynamic = "mu" }
[[constraint]]
name = "wall"
sliding = { body = "B", shape = { sphere = 0.1 }, on = { point = "0.1*E1", normal = "-E1" } }
holds = "unilateral"
friction = { static = "mu", dynamic = "mu" }
[scene.default]
t = [0, 3]
initial = { q = 0, x = 0 }
guess = { y = 0.1 }
)toml";

// A crate on two feet that a growing force pulls upwards and along. Both feet begin to slip together.
const char* const pulled = R"toml(format = 1
[parameters]
mu = 0.4
[[body]]
name = "A"
mass = 2
inertia = 0.1
position = { cartesian = ["x", "0", "z"] }
rotation = { axis = "E2", angle = "th" }
[[contact]]
name = "f"
body = "A"
points = { l = "-0.2*A.e1 - 0.1*A.e3", r = "0.2*A.e1 - 0.1*A.e3" }
on = "ground"
friction = { static = "mu", dynamic = "mu" }
[[force]]
gravity = "-9.81*E3"
[[force]]
on = "A"
force = "t*(4*E1 + 2*E3)"
[scene.default]
t = [0, 3]
initial = { x = 0, z = 0.1, th = 0 }
)toml";

// A load at rest on a rough floor that a rope lifts: sticking would need tension, so it slides first and opens later.
const char* const lifted = R"toml(format = 1

[[particle]]
name = "L"
mass = 0.3
position = { cartesian = ["u", "v"] }

[[particle]]
name = "Q"
mass = 1
position = { cartesian = ["x", "y"] }

[[force]]
gravity = "-9.81*E2"

[[force]]
on = "Q"
force = "16*E2 - 3*x_dot*E1"

[[constraint]]
name = "rope"
holonomic = "1 - norm(L - Q)"

[[constraint]]
name = "floor"
holonomic = "v"
holds = "unilateral"
friction = { static = 0.5, dynamic = 0.5 }

[scene.default]
t = [0, 1]
initial = { u = 0.6, v = 0, x = 0, y = 0.8 }
)toml";

struct ContactCase {
  const char* model;
  std::map<std::string, double> set;
};

void check_run(const Json& found, const Json& expected) {
  CAPTURE(found.dump());
  CHECK(found["refusal"] == "");
  CHECK(found["outcome"] == "done");
  CHECK(found["rising"] == true);
  CHECK(found["valued"] == true);
  for (const auto& [name, value] : found["end"].items()) {
    const double end = expected["final"][name].get<double>();
    CAPTURE(name);
    CHECK(std::abs(value.get<double>() - end) <= of_solvers * (1 + std::abs(end)));
  }
  // The page lists every impact. `run` lists short bounces with the impact before them.
  std::map<std::string, std::size_t> summed, left_out;
  std::size_t k = 0;
  const auto leave_out = [&](const Json& on_page) {
    const auto name = on_page["name"].get<std::string>();
    CHECK(summed.contains(name));
    ++left_out[name];
  };
  for (const Json& event : expected["events"]) {
    if (event["kind"] == "sample") continue;
    const auto is_next = [&](const Json& on_page) {
      const double t = event["t"];
      return on_page["name"] == event["name"] && std::abs(on_page["t"].get<double>() - t) <= of_solvers * (1 + t);
    };
    CAPTURE(event.dump());
    for (; k < found["events"].size() && !is_next(found["events"][k]); ++k) leave_out(found["events"][k]);
    REQUIRE(k < found["events"].size());
    ++k;
    if (event.contains("impacts")) summed[event["name"].get<std::string>()] += event["impacts"].get<std::size_t>() - 1;
  }
  for (; k < found["events"].size(); ++k) leave_out(found["events"][k]);
  for (const auto& [name, impacts] : summed) CHECK(left_out[name] >= impacts);  // and openings between them
}

}  // namespace

TEST_CASE(
    "contacts: the run on a page ends where run does, with the same changes of contacts, and takes changed values") {
  const Folder folder;
  folder.write("corner.toml", corner);
  folder.write("struck.toml", struck);
  const std::string bar = dropped_bar;
  folder.write("dropped_bar.toml", bar);
  folder.write("energetic_bar.toml", std::string(bar).replace(bar.find("poisson"), 7, "stronge"));
  folder.write("puck.toml", puck);
  folder.write("wedged.toml", wedged);
  folder.write("pulled.toml", pulled);
  folder.write("lifted.toml", lifted);
  const std::vector<ContactCase> list{{"bouncing_ball", {{"e", 0.7}, {"x_dot", 5}}},
                                      {"stick_slip_belt", {}},
                                      {"R16_disk_on_disk", {}},
                                      {"rough_incline_puck", {}},
                                      {"corner.toml", {}},
                                      {"struck.toml", {{"blow", 1}}},
                                      {"arm_with_stops", {{"e", 0.2}}},
                                      {"rocking_block", {{"g", 8}}},
                                      {"ladder", {{"mu", 0.15}}},
                                      {"dropped_bar.toml", {{"mu", 0.5}}},
                                      {"energetic_bar.toml", {}},
                                      {"puck.toml", {{"mu", 0.25}}},
                                      {"wedged.toml", {}},
                                      {"pulled.toml", {{"mu", 0.3}}},
                                      {"lifted.toml", {}}};
  for (const ContactCase& c : list) {
    CAPTURE(std::string(c.model));
    CAPTURE(in_json(c.set).dump());
    Words words{"run", c.model, "--rtol", "1e-11", "--atol", "1e-13", "--no-error-estimate"};
    for (const auto& [name, value] : c.set) words.insert(words.end(), {"--set", name + "=" + Json(value).dump()});
    const std::optional<Json> found = page(folder, c.model, c.set, {}, run_on_page);
    if (!found) return;
    check_run(*found, document(folder, words));
  }
}
