// SPDX-License-Identifier: GPL-3.0-or-later
// The runtime's registry is the only list of solvers: `list`, --solver of every command, the reader of scenes, the JSON
// schemas and the documentation agree with it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <eom/registry.hpp>
#include <fstream>
#include <set>
#include <sstream>

#include "program.hpp"
#include "support/folders.hpp"

using namespace eomgen::test;

namespace {

/// `auto`, then the names of the registry, as in all messages.
std::vector<std::string> names() {
  std::vector<std::string> result{eom::Automatic::name};
  for (const eom::MethodInfo& method : eom::methods()) result.emplace_back(method.name);
  return result;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string text_of(const std::string& path) {
  std::ifstream file(source_folder() + "/" + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string scene_of(const std::string& solver) {
  return pendulum_text("[scene.default]\nt = [0, 0.1]\ninitial = { x = 0.6, y = -0.8 }\nstep = 0.01\nsolver = \"" +
                       solver + "\"\n");
}

}  // namespace

TEST_CASE("solvers: list shows the registry in its order, with the needs of each method") {
  const Json solvers = document(Folder(), {"list"})["solvers"];
  REQUIRE(solvers.size() == eom::methods().size());
  for (std::size_t k = 0; k < solvers.size(); ++k) {
    const eom::MethodInfo& method = eom::methods()[k];
    const Json& reply = solvers[k];
    CAPTURE(std::string(method.name));
    CHECK(reply["name"] == method.name);
    CHECK(reply["order"] == method.order);
    CHECK(reply["dense_order"] == method.dense_order);
    CHECK(reply["adaptive"] == method.adaptive);
    CHECK(reply["implicit"] == method.needs.used.has(eom::Feature::jacobian));
    CHECK(reply["series"] == method.needs.required.has(eom::Feature::series));
    CHECK(reply["variational"] == method.needs.required.has(eom::Feature::momenta));
    CHECK(reply["constrained"] == method.needs.required.has(eom::Feature::constraints));
  }
}

TEST_CASE("solvers: --solver of every command refuses unknown names and lists all known ones") {
  const Folder folder;
  for (const Words& words :
       {Words{"run", "P2_planar_pendulum"}, Words{"bench", "P2_planar_pendulum"}, Words{"stress", "P2_planar_pendulum"},
        Words{"report", "P2_planar_pendulum", "-o", "a.html"},
        Words{"sweep", "P2_planar_pendulum", "--grid", "m=1,2", "--out", "a.csv"}}) {
    CAPTURE(words[0]);
    Words asked = words;
    asked.insert(asked.end(), {"--solver", "no_such_method"});
    const ChildResult result = expect(2, folder, asked);
    CHECK(contains(result.err, "there is no solver 'no_such_method'"));
    CHECK(contains(result.err, "remedy: choose from: " + joined(names()) + "\n"));
  }
}

TEST_CASE("solvers: a scene may name every method of the registry, and no other") {
  const Folder folder;
  for (const std::string& name : names()) {
    CAPTURE(name);
    folder.write("model.toml", scene_of(name));
    expect(0, folder, {"check", "model.toml"});
  }
  folder.write("model.toml", scene_of("no_such_method"));
  const ChildResult result = expect(2, folder, {"check", "model.toml"});
  CHECK(contains(result.err, "there is no solver 'no_such_method'"));
  CHECK(contains(result.err, "remedy: the solvers are " + joined(names()) + "\n"));
}

TEST_CASE("solvers: every method of the registry integrates the pendulum on a rod, with its scene and with --solver") {
  const Folder folder;
  for (const eom::MethodInfo& method : eom::methods()) {
    CAPTURE(std::string(method.name));
    folder.write("model.toml", scene_of(method.name));
    CHECK(document(folder, {"run", "model.toml", "--no-error-estimate"})["solver"] == method.name);
  }
}

TEST_CASE("solvers: rodas keeps its order in Euler parameters, which needs its Jacobian off the unit sphere") {
  const Folder folder;
  const auto end = [&](const Words& how) {
    Words words{"run", "R17_follower_force", "--t-end", "1", "--no-error-estimate"};
    words.insert(words.end(), how.begin(), how.end());
    return document(folder, words)["final"];
  };
  const Json exact = end({"--solver", "dop853", "--rtol", "1e-13", "--atol", "1e-15"});
  const auto error = [&](const std::string& step) {
    const Json final = end({"--solver", "rodas", "--step", step});
    double largest = 0;
    for (const char* e : {"e0", "e1", "e2", "e3"})
      largest = std::max(largest, std::abs(final[e].get<double>() - exact[e].get<double>()));
    return largest;
  };
  CHECK(std::log2(error("0.02") / error("0.01")) == doctest::Approx(5).epsilon(0.04));  // else 3
}

TEST_CASE("solvers: the schema of runs and the documentation name the methods of the registry") {
  const Json schema = Json::parse(text_of("docs/schema/run.schema.json"));
  std::set<std::string> reply;
  for (const Json& name : schema["properties"]["solver"]["enum"]) CHECK(reply.insert(name).second);
  const std::string format = text_of("docs/model-format.md"), runtime = text_of("docs/runtime.md");
  const std::size_t row = format.find("| `solver`,");
  REQUIRE(row != std::string::npos);
  const std::string of_scenes = format.substr(row, format.find('\n', row) - row);
  CHECK(reply.size() == eom::methods().size());
  for (const eom::MethodInfo& method : eom::methods()) {
    CAPTURE(std::string(method.name));
    CHECK(reply.contains(method.name));
    CHECK(contains(of_scenes, "`" + std::string(method.name) + "`"));
    CHECK(contains(runtime, "\n| `" + std::string(method.name) + "` |"));
  }
}
