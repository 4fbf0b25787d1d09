// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

#include "model_support.hpp"
#include "support/folders.hpp"

using namespace eomgen::model;

namespace {

std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> result;
  for (const auto& entry : std::filesystem::directory_iterator(eomgen::test::source_folder() + "/models")) {
    if (entry.path().extension() == ".toml") result.push_back(entry.path());
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

TEST_CASE("every shipped model is read without a warning, has a title and a default scene") {
  REQUIRE(shipped().size() >= 18);
  for (const auto& path : shipped()) {
    CAPTURE(path.string());
    try {
      const Model model = read_model(path.string());
      CHECK(model.warnings.empty());
      CHECK(!model.title.empty());
      CHECK(model.scenes[0].span.line > 0);
      CHECK(model.id == path.stem().string());
    } catch (const eomgen::Error& error) {
      FAIL_CHECK(error.what());
    }
  }
}

TEST_CASE("in shipped models every coordinate and parameter has a unit") {
  for (const auto& path : shipped()) {
    const Model model = read_model(path.string());
    CAPTURE(model.id);
    for (const Parameter& parameter : model.parameters) {
      CAPTURE(parameter.name);
      CHECK(parameter.unit.dimension.has_value());
    }
    for (const Coordinate& coordinate : model.coordinates) {
      CAPTURE(coordinate.name);
      CHECK(coordinate.unit.dimension.has_value());
    }
  }
}

TEST_CASE("reading is deterministic") {
  const std::string path = eomgen::test::source_folder() + "/models/P7_moving_sphere.toml";
  const Model a = read_model(path), b = read_model(path);
  REQUIRE(a.arena.nodes.size() == b.arena.nodes.size());
  for (std::size_t k = 0; k < a.arena.nodes.size(); ++k) {
    CHECK(a.arena.nodes[k].op == b.arena.nodes[k].op);
    CHECK(a.arena.nodes[k].args == b.arena.nodes[k].args);
  }
  CHECK(a.content_hash == b.content_hash);
}

TEST_CASE("a path that is not a file is reported") {
  for (const auto& [path, message] :
       {std::pair<std::string, std::string>{"/nonexistent/model.toml", "there is no such file"},
        {eomgen::test::source_folder() + "/models", "this is a directory"}}) {
    try {
      read_model(path);
      FAIL("accepted");
    } catch (const eomgen::Error& error) {
      CHECK(error.message() == message);
    }
  }
}
