// SPDX-License-Identifier: GPL-3.0-or-later
// Starts that follow from changed parameters and initial values: on pages of `report` (through Node) and in the Python
// target, against the first and last row of `run --set`. tests/models/start_test.cpp has every shipped scene.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <optional>

#include "page_script.hpp"
#include "program.hpp"

using namespace eomgen::test;

namespace {

constexpr double allowed = 1e-12;  // relative: formulas are evaluated in another order

// A spring whose length at rest is that of the start; a rate and the end that depend on it.
const char* const begins_at_rest = R"(format = 1
[parameters]
m = 2
k = 3
c = "k/10"
[coordinates]
x = {}
y = {}
[[particle]]
name = "P"
mass = "m"
position = ["x", "y", 0]
[[force]]
generalized = { x = "-k*(x - initial(x)) - c*x_dot" }
[[constraint]]
name = "curve"
holonomic = "y - x^2 + 1"
[scene.default]
t = ["1/k", "10*m/k"]
initial = { x = "1 + c", x_dot = "x*c" }
)";

// A pendulum in Cartesian coordinates; a blow at the lowest point, which the rod changes to one along its circle.
const char* const pushed_pendulum = R"toml(format = 1
[parameters]
push = 0.5
[[particle]]
name = "P"
mass = 1
position = { cartesian = ["x", "y", 0] }
[[force]]
gravity = "-9.81*E2"
[[constraint]]
name = "rod"
holonomic = "x^2 + y^2 - 1"
[[event]]
name = "strike"
when = "x - 0.1"
direction = "up"
if = "x_dot < 2"
set = { x_dot = "push", y_dot = "y_dot - 0.1" }
[scene.default]
t = [0, 3]
initial = { x = 0.3, x_dot = 0 }
guess = { y = -1 }
)toml";

// Samples that trigger an event, at times that meet those of another sample; an integral over time.
const char* const counted = R"toml(format = 1
[parameters]
every = "0.1 s"
[[particle]]
name = "P"
mass = "1 kg"
position = { cartesian = ["x", 0, 0] }
[[force]]
generalized = { x = "-(4 + n/10)*1[N/m]*x + F" }
[discrete]
n = 0
blows = 0
w = 0
F = "0 N"
[[sample]]
name = "count"
every = "every"
set = { n = "n + 1", F = "0.1[kg/s]*x_dot + 0.01[N]*w" }
[[sample]]
name = "noise"
every = "0.2 s"
offset = "0.05 s"
noise = { w = { uniform = 3 } }
[[event]]
name = "blow"
when = "n - 4.5"
direction = "up"
set = { x_dot = "x_dot + 0.5[m/s]", blows = "blows + 1" }
[[event]]
name = "passing"
when = "x"
[[state]]
name = "way"
unit = "m"
rate = "x_dot*sign(x_dot)"
[scene.default]
t = [0, 4]
initial = { x = 1 }
)toml";

struct Case {
  const char* model;
  std::map<std::string, double> set;
  bool on_page = true;  // not: a page replays it, or has no slider for a value
  bool to_end = true;   // whether an event ends it
};

const std::vector<Case>& cases() {
  static const std::vector<Case> list{
      {"leaving_sphere", {{"g", 10.791}}, true, false},
      {"elastic_pendulum", {{"L", 0.8}}},
      {"bilinear_oscillator", {{"m", 2.5}, {"k1", 40}}},
      {"S5_double_pendulum_cartesian", {{"L2", 1.25}}},
      {"S5_double_pendulum_cartesian", {{"L1", 1.125}, {"x1_dot", 0}}},
      {"begins_at_rest.toml", {{"x", 2}}},
      {"begins_at_rest.toml", {{"k", 4}}},
      {"begins_at_rest.toml", {{"c", 0.5}, {"x_dot", -1}}, false},
  };
  return list;
}

struct Start {
  double t0 = 0, t1 = 0;
  std::map<std::string, double> values;
};

Start of_run(const Folder& folder, const Case& c) {
  Words words{"run", c.model, "--out", "run.csv"};
  for (const auto& [name, value] : c.set) words.insert(words.end(), {"--set", name + "=" + std::to_string(value)});
  expect(0, folder, words);
  const Table table = read_table(folder.read("run.csv"));
  Start start{table.rows.front()[0], table.rows.back()[0], {}};
  for (std::size_t k = 1; k < table.columns.size(); ++k) start.values[table.columns[k]] = table.rows.front()[k];
  return start;
}

void check(const Json& found, const Start& expected) {
  CHECK(found["t0"].get<double>() == doctest::Approx(expected.t0).epsilon(allowed));
  CHECK(found["states"].size() > 1);
  for (const auto& [name, value] : found["states"].items()) {
    CAPTURE(name);
    REQUIRE(expected.values.contains(name));
    CHECK(std::abs(value.get<double>() - expected.values.at(name)) <=
          allowed * (1 + std::abs(expected.values.at(name))));
  }
}

// Prints the start of each case, and of the whole motion the final state.
const char* const in_python = R"(import importlib, json, sys
sys.dont_write_bytecode = True
sys.path.insert(0, ".")
for case in json.load(open("cases.json")):
    model = importlib.import_module(case["module"])
    x0 = {name: value for name, value in case["set"].items() if name in model.states}
    p = {name: value for name, value in case["set"].items() if name in model.params}
    t0, t1, x, parameters, mode = model._begin(x0 or None, p or None)
    end = [float(v) for v in model.simulate(t1, x0 or None, p or None).x[-1]]
    print(json.dumps({"t0": t0, "t1": t1, "states": dict(zip(model.states, map(float, x))), "end": end,
                      "parameters": dict(zip(model.params, map(float, parameters)))}))
)";

}  // namespace

TEST_CASE("starts: on a page they follow from changed values as in run --set") {
  const Folder folder;
  folder.write("begins_at_rest.toml", begins_at_rest);
  for (const Case& c : cases()) {
    if (!c.on_page) continue;
    CAPTURE(std::string(c.model));
    CAPTURE(in_json(c.set).dump());
    const Start expected = of_run(folder, c);
    const std::optional<Json> found = page(folder, c.model, c.set);
    if (!found) return;
    CHECK((*found)["refusal"] == "");
    check(*found, expected);
    if (c.to_end) CHECK((*found)["t1"].get<double>() == doctest::Approx(expected.t1).epsilon(allowed));
    for (const Json& psi : (*found)["psi"]) CHECK(std::abs(psi.get<double>()) < 1e-13);
    if ((*found)["parameters"].contains("initial_x"))
      CHECK((*found)["parameters"]["initial_x"] == (*found)["states"]["x"]);
  }
}

TEST_CASE("starts: values that break a constraint are refused on the page, which keeps its motion") {
  const Folder folder;
  const std::optional<Json> before = page(folder, "S5_double_pendulum_cartesian", {});
  if (!before) return;
  CHECK((*before)["refusal"] == "");
  const std::optional<Json> after = page(folder, "S5_double_pendulum_cartesian", {{"x1", 2}});
  CHECK((*after)["refusal"] == "the start breaks a constraint");
  CHECK((*after)["states"] == (*before)["states"]);
  expect(2, folder, {"run", "S5_double_pendulum_cartesian", "--set", "x1=2"});
}

TEST_CASE("starts: values and an end of the command line stay on the page") {
  const Folder folder;
  folder.write("begins_at_rest.toml", begins_at_rest);
  const Words options{"--set", "x=2", "--set", "c=0.25", "--t-end", "4"};
  const std::optional<Json> found = page(folder, "begins_at_rest.toml", {{"k", 5}}, options);
  if (!found) return;
  CHECK((*found)["states"]["x"] == 2);
  CHECK((*found)["states"]["y"] == 3);
  CHECK((*found)["states"]["x_dot"] == 0.5);
  CHECK((*found)["t0"] == 0.2);
  CHECK((*found)["t1"] == 4);
  CHECK((*found)["parameters"]["initial_x"] == 2);
}

TEST_CASE("starts: the Python target follows changed values as run --set, and simulates from there") {
  const Folder folder;
  if (run_child({{"sh", "-c", "python3 -c 'import ctypes'"}, folder.path()}).status != 0) {
    MESSAGE("skipped: there is no python3");
    return;
  }
  folder.write("begins_at_rest.toml", begins_at_rest);
  Json list = Json::array();
  std::vector<Start> expected;
  std::vector<Json> ends;
  for (const Case& c : cases()) {
    std::string module = c.model;
    module = module.substr(0, module.find('.'));
    if (!folder.has(module + ".py")) expect(0, folder, {"emit", c.model, "--target", "python", "-o", "."});
    list.push_back({{"module", module}, {"set", in_json(c.set)}});
    expected.push_back(of_run(folder, c));
    const Table table = read_table(folder.read("run.csv"));
    Json end = Json::object();
    for (std::size_t k = 1; k < table.columns.size(); ++k) end[table.columns[k]] = table.rows.back()[k];
    ends.push_back(end);
  }
  folder.write("cases.json", list.dump());
  folder.write("follow.py", in_python);
  const ChildResult result = run_child({{"python3", "follow.py"}, folder.path()});
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  std::size_t at = 0;
  std::string rest = result.out;
  for (std::size_t k = 0; k < list.size(); ++k) {
    CAPTURE(list[k].dump());
    const std::size_t end = rest.find('\n', at);
    REQUIRE(end != std::string::npos);
    const Json found = Json::parse(rest.substr(at, end - at));
    at = end + 1;
    check(found, expected[k]);
    if (found["parameters"].contains("initial_x")) CHECK(found["parameters"]["initial_x"] == found["states"]["x"]);
    if (!cases()[k].to_end) continue;
    CHECK(found["t1"].get<double>() == doctest::Approx(expected[k].t1).epsilon(allowed));
    std::size_t state = 0;
    for (const auto& [name, value] : found["states"].items())
      CHECK(found["end"][state++].get<double>() == doctest::Approx(ends[k][name].get<double>()).epsilon(1e-5));
  }
}

TEST_CASE(
    "resets: simulate of the Python target ends where run does, with the same resets, and takes changed periods") {
  const Folder folder;
  if (run_child({{"sh", "-c", "python3 -c 'import ctypes'"}, folder.path()}).status != 0) {
    MESSAGE("skipped: there is no python3");
    return;
  }
  folder.write("hybrid.py", R"(import importlib, json, sys
sys.dont_write_bytecode = True
sys.path.insert(0, ".")
model = importlib.import_module(sys.argv[1])
motion = model.simulate(float(sys.argv[2]), p=json.loads(sys.argv[3]), rtol=1e-11, atol=1e-13)
print(json.dumps({"outcome": motion.outcome, "end": dict(zip(model.states, map(float, motion.x[-1]))),
                  "resets": [t for t, kind, _ in motion.events if kind == "reset"]}))
)");
  const std::vector<Case> list{{"simplest_walker", {}},
                               {"thermostat", {}},
                               {"clock_escapement", {}},
                               {"rimless_wheel", {}},
                               {"sampled_cart_pole", {}},
                               {"clock_escapement", {{"k", 9e-7}}},
                               {"sampled_cart_pole", {{"Ts", 0.0125}}}};
  constexpr double of_solvers = 1e-7;  // relative: both methods at rtol = 1e-11
  for (const Case& c : list) {
    CAPTURE(std::string(c.model));
    expect(0, folder, {"emit", c.model, "--target", "python", "-o", "."});
    Words words{"run", c.model, "--rtol", "1e-11", "--atol", "1e-13"};
    for (const auto& [name, value] : c.set) words.insert(words.end(), {"--set", name + "=" + Json(value).dump()});
    const Json expected = document(folder, words);
    const ChildResult result =
        run_child({{"python3", "hybrid.py", c.model, expected["t"].dump(), in_json(c.set).dump()}, folder.path()});
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    const Json found = Json::parse(result.out);
    CHECK(found["outcome"] == expected["outcome"]);
    for (const auto& [name, value] : found["end"].items())
      CHECK(value.get<double>() == doctest::Approx(expected["final"][name].get<double>()).epsilon(of_solvers));
    std::vector<double> resets;
    for (const Json& event : expected["events"]) {
      if (event["kind"] == "reset") resets.push_back(event["t"].get<double>());
    }
    REQUIRE(found["resets"].size() == resets.size());
    for (std::size_t k = 0; k < resets.size(); ++k)
      CHECK(found["resets"][k].get<double>() == doctest::Approx(resets[k]).epsilon(of_solvers));
  }
}

TEST_CASE("starts: the address of a page carries its values; other names and texts are not taken") {
  const Folder folder;
  const std::optional<Json> found = page(folder, "rimless_wheel", {{"gamma", 0.1}, {"theta_dot", 2}}, {}, R"(
const fragment = fragmentOf(live), before = Array.from(live.x);
takeFragment(live, "m=3");
const others = [live.chosen[find("gamma")], live.chosen[find("m")]];
takeFragment(live, fragment);
live.prepare();
const after = Array.from(live.x);
live.placed = Float64Array.of(0.1, 0, 5, 2);
const placed = fragmentOf(live);
takeFragment(live, placed);
live.prepare();
const unknown = takeFragment(live, "gamma=0.2&theta=x&__proto__=1&m=&L=1,2&(state)=1&q=<b>");
console.log(JSON.stringify({fragment, before, after, others, placed, x: Array.from(live.x), unknown, gamma: live.chosen[find("gamma")]}));
)");
  if (!found) return;
  CHECK((*found)["fragment"] == "gamma=0.1&theta_dot=2");
  CHECK((*found)["after"] == (*found)["before"]);
  CHECK((*found)["others"] == Json::parse("[0.08, 3]"));
  CHECK(contains((*found)["placed"].get<std::string>(), "=0.1%2C0%2C5%2C2"));
  CHECK((*found)["unknown"] == Json::array({"theta", "__proto__", "m", "L", "(state)", "q"}));
  CHECK((*found)["gamma"] == 0.2);
}

TEST_CASE("resets: the run on a page ends where run does, with the same events, and takes changed values") {
  const Folder folder;
  folder.write("pushed_pendulum.toml", pushed_pendulum);
  folder.write("counted.toml", counted);
  const std::vector<Case> list{{"simplest_walker", {}},
                               {"thermostat", {}},
                               {"thermostat", {{"band", 1}, {"T", 19.5}}},
                               {"clock_escapement", {{"k", 9e-7}}},
                               {"rimless_wheel", {{"gamma", 0.1}, {"steps", 3}}},
                               {"sampled_cart_pole", {}},
                               {"sampled_cart_pole", {{"Ts", 0.0125}}},
                               {"dc_motor", {}},
                               {"maxwell_element", {}},
                               {"hill_muscle", {}},
                               {"brake_temperature", {}},
                               {"pushed_pendulum.toml", {{"push", 0.7}}},
                               {"counted.toml", {{"every", 0.15}}}};
  constexpr double of_solvers = 1e-7;  // relative: both methods at rtol = 1e-11
  for (const Case& c : list) {
    CAPTURE(std::string(c.model));
    CAPTURE(in_json(c.set).dump());
    Words words{"run", c.model, "--rtol", "1e-11", "--atol", "1e-13"};
    for (const auto& [name, value] : c.set) words.insert(words.end(), {"--set", name + "=" + Json(value).dump()});
    const Json expected = document(folder, words);
    const std::optional<Json> found = page(folder, c.model, c.set, {}, run_on_page);
    if (!found) return;
    CAPTURE(found->dump());
    CHECK((*found)["outcome"] == "done");
    CHECK((*found)["rising"] == true);
    CHECK((*found)["t"].get<double>() == doctest::Approx(expected["t"].get<double>()).epsilon(of_solvers));
    for (const auto& [name, value] : (*found)["end"].items()) {
      const double end = expected["final"][name].get<double>();
      CAPTURE(name);
      CHECK(std::abs(value.get<double>() - end) <= of_solvers * (1 + std::abs(end)));
    }
    std::vector<std::pair<std::string, double>> events;
    for (const Json& event : expected["events"]) {
      if (event["kind"] == "reset" || event["kind"] == "custom")
        events.emplace_back(event["name"].get<std::string>(), event["t"].get<double>());
    }
    REQUIRE((*found)["events"].size() == events.size());
    for (std::size_t k = 0; k < events.size(); ++k) {
      CHECK((*found)["events"][k]["name"] == events[k].first);
      CHECK((*found)["events"][k]["t"].get<double>() == doctest::Approx(events[k].second).epsilon(of_solvers));
    }
  }
}

TEST_CASE("resets: bounces that become ever shorter, and a place beside a constraint, end the run on a page by name") {
  const Folder folder;
  folder.write("bounces.toml", R"toml(format = 1
[[particle]]
name = "P"
mass = 1
position = { cartesian = ["x", 0, 0] }
[[force]]
gravity = "-9.81*E1"
[[event]]
name = "floor"
when = "x"
direction = "down"
set = { x_dot = "-x_dot/2" }
[scene.default]
t = [0, 5]
initial = { x = 1 }
)toml");
  std::optional<Json> found = page(folder, "bounces.toml", {}, {}, run_on_page, 3);  // as run does
  if (!found) return;
  const double rests = 3 * std::sqrt(2 / 9.81);  // sqrt(2 h/g) (1 + 2 e/(1 - e)), e = 1/2
  CHECK(contains((*found)["outcome"].get<std::string>(), "ever faster"));
  CHECK((*found)["t"].get<double>() == doctest::Approx(rests).epsilon(1e-6));
  std::string text = pushed_pendulum;
  const std::string was = "x_dot = \"push\"";
  text.replace(text.find(was), was.size(), "x = \"x/2\"");
  folder.write("moved.toml", text);
  found = page(folder, "moved.toml", {}, {}, run_on_page, 3);
  REQUIRE(found);
  CHECK(contains((*found)["outcome"].get<std::string>(), "that \u201cstrike\u201d sets break a constraint"));
}

TEST_CASE("emit: the JavaScript of a start in single precision loads, and finds the start") {
  const Folder folder;
  folder.write("rod.toml",
               "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"x\", \"y\", \"0\"] }\n"
               "[[constraint]]\nname = \"rod\"\nholonomic = \"x^2 + y^2 - 4\"\n[[force]]\ngravity = \"-9.81*E2\"\n"
               "[scene.default]\nt = [0, 1]\ninitial = { x = 1 }\nguess = { y = -1 }\n");
  expect(0, folder, {"emit", "rod.toml", "-o", "out", "--target", "javascript", "--real", "float", "--with", "start"});
  folder.write("load.js", "process.exit(require('./out/rod.js').selftest());");
  try {
    CHECK(run_child({{"node", "load.js"}, folder.path()}).status == 0);
  } catch (const std::runtime_error&) {
    MESSAGE("skipped: there is no node");
  }
}
