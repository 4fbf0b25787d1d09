// SPDX-License-Identifier: GPL-3.0-or-later
// NAME_start in C and JavaScript against the start of a run: every shipped model and scene, with each parameter and
// each initial value changed.
#include <dlfcn.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "derive/formulations.hpp"
#include "emit/shared_library/process.hpp"
#include "emit/write_files.hpp"
#include "numeric/numbers.hpp"
#include "pipeline/start_description.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"
#include "support/temporary_folder.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

using Json = nlohmann::ordered_json;

// Relative to the largest position, rate or parameter. Constraints are solved to 1e-14 of their terms.
constexpr double allowed_error = 1e-9;

struct StartedValues {
  std::vector<double> t{0, 0}, x, p;
  std::vector<int> open;  // states of the contacts
};

struct Case {
  std::string what;
  std::vector<int> given;
  StartedValues in;
  std::optional<StartedValues> expected;  // nothing: `run` refuses it
  std::string refusal;
};

struct Scene {
  std::string name;
  std::vector<Case> cases;
  std::size_t coordinates = 0, contacts = 0;
};

std::unique_ptr<pipeline::DerivedModel> derive_once(const std::string& path) {
  auto derived = std::make_unique<pipeline::DerivedModel>(model_at(path));
  derived->mechanics = mechanics::build_mechanics(derived->shared);
  for (const derive::FormulationEntry& formulation : derive::formulations()) {
    for (const system::Approach approach : {system::Approach::two, system::Approach::one}) {
      if (!derived->candidates.empty()) return derived;
      if (auto found = derive::derive_if_worthwhile(formulation, derived->mechanics, approach).system)
        derived->candidates.push_back(std::move(*found));
    }
  }
  REQUIRE_FALSE(derived->candidates.empty());
  return derived;
}

StartedValues values_of(const run::Scene& scene, const system::EquationSystem& system) {
  const std::vector<std::uint32_t>& free = system.free;
  StartedValues values;
  values.t = {scene.t0, scene.t1};
  for (const std::uint32_t i : free) values.x.push_back(scene.q[i]);
  for (const std::uint32_t i : free) values.x.push_back(scene.qdot[i]);
  values.x.insert(values.x.end(), scene.z.begin(), scene.z.end());
  values.p = scene.parameters;
  for (const bool open : scene.open) values.open.push_back(open ? 3 : 0);
  return values;
}

class Cases {
 public:
  Cases(pipeline::DerivedModel& derived, const model::Scene& scene)
      : derived_(derived), m_(derived.mechanics), system_(derived.candidates.front()), scene_(scene) {}

  Scene run() {
    const run::Scene begin = resolve({});
    default_ = values_of(begin, system_);
    add("nothing given", {}, {});
    const auto& parameters = derived_.model.parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (parameters[i].initial_value_of || derived_.model.start_time == i) continue;
      const double value = default_.p[i] == 0 ? 0.0625 : default_.p[i] * 1.0625;
      add(parameters[i].name + " is larger", {{parameters[i].name, value}}, {states() + i});
    }
    for (std::size_t k = 0; k < states(); ++k) {
      const std::size_t n = system_.free.size();
      if (k >= 2 * n && derived_.model.states[system_.states[k - 2 * n].symbol.index].integral) continue;
      const std::string name = k < 2 * n ? derived_.model.coordinates[system_.free[k % n]].name + (k < n ? "" : "_dot")
                                         : derived_.model.states[system_.states[k - 2 * n].symbol.index].name;
      add(name + " is given", {{name, default_.x[k] + 0.0078125}}, {k});
    }
    return std::move(result_);
  }

 private:
  std::size_t states() const { return system_.layout().size(); }
  run::Scene resolve(const std::map<std::string, double>& values) {
    run::Overrides overrides;
    overrides.can_exchange_charts = true;
    for (const auto& [name, value] : values) overrides.values[name] = cln::rational(cln::cl_DF(value));
    return run::resolve_scene(m_, system_, scene_, overrides);
  }
  void add(const std::string& what, const std::map<std::string, double>& values,
           const std::vector<std::size_t>& given) {
    Case c{what, std::vector<int>(states() + default_.p.size() + 2, 0), default_, {}, ""};
    for (double& entry : c.in.x) entry = std::nan("");
    for (double& entry : c.in.p) entry = std::nan("");
    c.in.t = {std::nan(""), std::nan("")};
    for (const std::size_t k : given) {
      c.given[k] = 1;
      (k < states() ? c.in.x[k] : c.in.p[k - states()]) = values.begin()->second;
    }
    try {
      c.expected = values_of(resolve(values), system_);
    } catch (const Error& error) {
      c.refusal = error.what();
    }
    result_.cases.push_back(std::move(c));
  }

  pipeline::DerivedModel& derived_;
  mechanics::Mechanics& m_;
  const system::EquationSystem& system_;
  const model::Scene& scene_;
  StartedValues default_;
  Scene result_;
};

/// The sources of a program without other functions.
std::vector<emit::EmittedFile> sources(pipeline::DerivedModel& derived, const model::Scene& scene,
                                       const std::string& name, const std::string& target) {
  const system::EquationSystem& system = derived.candidates.front();
  program::Program program;
  program.free = system.free;
  program.contacts.resize(system.contacts.size());
  program.states = system.state_symbols();
  program.discrete = system.discrete;
  run::Overrides overrides;
  overrides.can_exchange_charts = true;
  const run::Scene start = run::resolve_scene(derived.mechanics, system, scene, overrides);
  emit::EmissionContext context;
  context.id = name;
  for (const model::Coordinate& c : derived.model.coordinates) context.coordinates.push_back({c.name, "", "", 0});
  for (std::size_t i = 0; i < derived.model.parameters.size(); ++i)
    context.parameters.push_back({derived.model.parameters[i].name, "", "", start.parameters[i]});
  for (const model::State& state : derived.model.states) context.states.push_back({state.name, "", "", 0});
  context.start = values_of(start, system).x;
  context.start_functions = pipeline::describe_start(derived, scene);
  REQUIRE(context.start_functions);
  return emit::emit(program, context, target);
}

double distance(const StartedValues& found, StartedValues expected, std::size_t n) {
  expected.open.resize(found.open.size());  // a scene lists only unilateral contacts
  double off = found.open == expected.open ? 0 : 1;
  const auto compare = [&](const std::vector<double>& a, const std::vector<double>& b, std::size_t from,
                           std::size_t to) {
    double largest = 1;
    for (std::size_t i = from; i < to; ++i) largest = std::max(largest, std::abs(b[i]));
    for (std::size_t i = from; i < to; ++i) {
      const double part = std::abs(a[i] - b[i]) / largest;
      off = std::max(off, std::isfinite(part) ? part : 1);
    }
  };
  compare(found.t, expected.t, 0, 2);
  compare(found.x, expected.x, 0, n);
  compare(found.x, expected.x, n, 2 * n);
  compare(found.x, expected.x, 2 * n, found.x.size());
  for (std::size_t i = 0; i < found.p.size(); ++i) {
    const double part = std::abs(found.p[i] - expected.p[i]) / std::max(1e-3, std::abs(expected.p[i]));
    off = std::max(off, std::isfinite(part) ? part : 1);
  }
  return off;
}

const char* const program_of_node = R"("use strict";
const results = [];
for (const {name, cases} of JSON.parse(require("fs").readFileSync("cases.json"))) {
  const m = require("./" + name + ".js");
  for (const c of cases) {
    const number = (list) => Float64Array.from(list, (v) => (v === null ? NaN : v)), mode = [];
    const t = number(c.t), x = number(c.x), p = number(c.p);
    const code = m.start(c.given, t, x, p, mode);
    results.push({code, t: Array.from(t), x: Array.from(x), p: Array.from(p), open: mode.slice(0, c.contacts)});
  }
}
require("fs").writeFileSync("results.json", JSON.stringify(results));
)";

struct Outcome {
  int code = 0;
  StartedValues values;
};

void check(const Scene& scene, const Case& c, const Outcome& found) {
  CAPTURE(scene.name);
  CAPTURE(c.what);
  CAPTURE(c.refusal);
  if (!c.expected) {
    // The function knows constraints and ranges; `run` also knows what parameters may be.
    const bool of_start = c.refusal.find("breaks constraint") != std::string::npos ||
                          c.refusal.find("outside its range") != std::string::npos;
    if (of_start) CHECK(found.code != 0);
    return;
  }
  CHECK(found.code == 0);
  if (found.code == 0) CHECK(distance(found.values, *c.expected, scene.coordinates) <= allowed_error);
}

void check_c(const std::string& folder, const std::vector<Scene>& scenes) {
  const std::string library = folder + "/all.so";
  const emit::ProcessResult compiled =
      emit::run_process({"cc", "-std=c11", "-O0", "-fPIC", "-shared", "-o", library, folder + "/all.c", "-lm"});
  CAPTURE(compiled.output);
  REQUIRE(compiled.status == 0);
  void* const handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  REQUIRE((handle != nullptr));
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    using Function = int (*)(const int*, double*, double*, double*, int*);
    const auto start = reinterpret_cast<Function>(::dlsym(handle, ("m" + std::to_string(k) + "_start").c_str()));
    REQUIRE((start != nullptr));
    for (const Case& c : scenes[k].cases) {
      Outcome found{0, c.in};
      std::vector<int> mode(100, -1);  // enough for every shipped model
      found.code =
          start(c.given.data(), found.values.t.data(), found.values.x.data(), found.values.p.data(), mode.data());
      mode.resize(scenes[k].contacts);
      found.values.open = mode;
      check(scenes[k], c, found);
    }
  }
  ::dlclose(handle);
}

void check_javascript(const std::string& folder, const std::vector<Scene>& scenes) {
  if (emit::run_process({"node", "--version"}).status != 0) {
    MESSAGE("skipped: there is no node");
    return;
  }
  const emit::ProcessResult finished = emit::run_process({"sh", "-c", "cd '" + folder + "' && node run.js"});
  CAPTURE(finished.output);
  REQUIRE(finished.status == 0);
  const Json results = Json::parse(read_text(folder + "/results.json"));
  std::size_t at = 0;
  for (const Scene& scene : scenes) {
    for (const Case& c : scene.cases) {
      const Json& r = results.at(at++);
      const auto numbers = [](const Json& list) {
        std::vector<double> values;
        for (const Json& v : list) values.push_back(v.is_null() ? std::nan("") : v.get<double>());
        return values;
      };
      check(scene, c,
            {r["code"], {numbers(r["t"]), numbers(r["x"]), numbers(r["p"]), r["open"].get<std::vector<int>>()}});
    }
  }
  CHECK(at == results.size());
}

/// A rod whose support turns back at the start: the rates are those behind the kink.
constexpr const char* kink_at_start = R"toml(format = 1
[parameters]
v = 0.3
[functions]
s = "v*abs(t - 1)"
[coordinates]
x = {}
y = {}
[energy]
kinetic = "(x_dot^2 + y_dot^2)/2"
[[constraint]]
name = "rod"
holonomic = "(x - s)^2 + y^2 - 1"
[scene.default]
t = [1, 2]
initial = { x = 0.6, x_dot = 0.1 }
guess = { y = -0.8 }
)toml";

std::vector<std::string> shipped() {
  std::vector<std::string> paths{build_folder() + "/kink_at_start.toml"};
  write_text(paths.front(), kink_at_start);
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/models"))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

TEST_CASE(
    "starts: emitted C and JavaScript give what a run of every shipped scene gives, and one at a kink, for each "
    "changed value") {
  const TemporaryFolder folder;
  std::vector<emit::EmittedFile> files{{"run.js", program_of_node}};
  std::vector<Scene> scenes;
  std::string all = "";
  Json cases = Json::array();
  for (const std::string& path : shipped()) {
    const auto derived = derive_once(path);
    if (derived->candidates.front().free.empty()) continue;  // nothing is left to emit
    for (std::size_t k = 0; k < derived->model.scenes.size(); ++k) {
      const model::Scene& scene = derived->model.scenes[k];
      const std::string name = "m" + std::to_string(scenes.size());
      CAPTURE(path);
      CAPTURE(scene.name);
      scenes.push_back(Cases(*derived, scene).run());
      scenes.back().name = derived->model.id + " " + scene.name;
      scenes.back().coordinates = derived->candidates.front().free.size();
      scenes.back().contacts = derived->candidates.front().contacts.size();
      for (const char* target : {"c", "javascript"}) {
        for (emit::EmittedFile& file : sources(*derived, scene, name, target)) files.push_back(std::move(file));
      }
      all += "#include \"" + name + ".c\"\n";
      Json list = Json::array();
      for (const Case& c : scenes.back().cases)
        list.push_back(
            {{"given", c.given}, {"t", c.in.t}, {"x", c.in.x}, {"p", c.in.p}, {"contacts", scenes.back().contacts}});
      cases.push_back({{"name", name}, {"cases", list}});
    }
  }
  files.push_back({"all.c", all});
  files.push_back({"cases.json", cases.dump()});
  emit::write_files(folder.path, files);

  check_c(folder.path, scenes);
  check_javascript(folder.path, scenes);
}
