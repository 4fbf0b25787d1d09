// SPDX-License-Identifier: GPL-3.0-or-later
// Emission as text and as files: equal bytes, targets, written files.
#include <doctest/doctest.h>

#include "emit/examples.hpp"
#include "error.hpp"
#include "model/content_hash.hpp"

using namespace eomgen;
using namespace test_systems;

TEST_CASE("emission: repeated emission gives the same bytes, and only the requested functions") {
  const Example a = examples()[1], b = examples()[1];
  const auto first = emit::emit(a.program, a.context), second = emit::emit(b.program, b.context);
  for (std::size_t i = 0; i < first.size(); ++i) CHECK(first[i].text == second[i].text);
  const Example bare = example("pendulum", pendulum(), {"theta"}, {"m", "l", "g"}, {}, {});
  const std::string c = file_named(emit::emit(bare.program, bare.context), ".c");
  CHECK(c.find("pendulum_rhs") != std::string::npos);
  CHECK(c.find("pendulum_jac") == std::string::npos);
  CHECK(c.find("pendulum_mass") == std::string::npos);
  CHECK(c.find("pow(") == std::string::npos);
}

TEST_CASE("print the checksum of what is emitted" * doctest::skip()) {  // for the next test, which runs this program
  std::string all;
  for (const Example& e : examples()) {
    for (const auto& file : emit::emit(e.program, e.context)) all += file.text;
  }
  MESSAGE("emitted: ", model::content_hash(all), ";");
}

TEST_CASE("emission: equal bytes in fresh processes") {
  std::string first;
  for (int process = 0; process < 5; ++process) {
    const std::string said =
        emit::run_process({"/proc/self/exe", "--no-skip", "--test-case=print the checksum*"}).output;
    const std::size_t place = said.find("emitted: ");
    REQUIRE(place != std::string::npos);
    const std::string sum = said.substr(place, said.find(';', place) - place);
    if (process == 0) first = sum;
    CHECK(sum == first);
  }
}

TEST_CASE("emission: an unknown target is rejected with a list of the known ones") {
  const Example e = examples()[0];
  try {
    emit::emit(e.program, e.context, "fortran");
    FAIL("accepted");
  } catch (const Error& error) {
    CHECK(error.message() == "there is no target `fortran`");
    CHECK(error.remedy().starts_with("targets: cpp, c"));
  }
}

TEST_CASE("emission: every target emits nonempty files with distinct names") {
  const Example e = examples()[3];
  for (const auto& target : emit::targets()) {
    const auto files = target.emit(e.program, e.context);
    REQUIRE_FALSE(files.empty());
    std::vector<std::string> names;
    for (const auto& file : files) {
      CHECK(file.text.size() > 100);
      CHECK(std::find(names.begin(), names.end(), file.name) == names.end());
      names.push_back(file.name);
    }
  }
}

TEST_CASE("write_files: writes complete files or none, and errors contain the path") {
  const Folder folder;
  const std::string inside = folder.path + "/deep/er";
  const auto paths = emit::write_files(inside, {{"a.txt", "one"}, {"b.txt", "two"}});
  REQUIRE(paths.size() == 2);
  std::ostringstream text;
  text << std::ifstream(paths[1]).rdbuf();
  CHECK(text.str() == "two");
  CHECK(std::distance(std::filesystem::directory_iterator(inside), {}) == 2);
  try {
    emit::write_files(paths[0], {{"c.txt", "three"}});  // a file blocks the folder
    FAIL("written");
  } catch (const Error& error) {
    CHECK(error.fault() == ErrorKind::input);
    CHECK(error.message().find("a.txt") != std::string::npos);
  }
}
