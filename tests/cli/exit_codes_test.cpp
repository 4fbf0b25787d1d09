// SPDX-License-Identifier: GPL-3.0-or-later
// Exit codes: 0 done, 1 a check failed, 2 bad input, 3 a run failed numerically, 4 a tool is missing.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <cmath>
#include <eom/version.hpp>
#include <regex>
#include <string>

#include "program.hpp"

using namespace eomgen::test;

TEST_CASE("exit code 0: results on standard output, nothing on standard error") {
  const Folder folder;
  for (const Words& words : {Words{"--help"}, Words{"--version"}, Words{"run", "--help"}, Words{"list"},
                             Words{"check", "P2_planar_pendulum"}, Words{"derive", "P2_planar_pendulum"}}) {
    CAPTURE(words.front());
    const ChildResult result = expect(0, folder, words);
    CHECK(result.err.empty());
    CHECK_FALSE(result.out.empty());
  }
}

TEST_CASE("--version shows the version of the runtime headers and a commit of twelve hexadecimal digits") {
  const Folder folder;
  const std::string line = expect(0, folder, {"--version"}).out;
  const std::string version = std::to_string(EOM_VERSION_MAJOR) + '.' + std::to_string(EOM_VERSION_MINOR) + '.' +
                              std::to_string(EOM_VERSION_PATCH);
  CHECK(std::regex_match(line, std::regex("eomgen " + version + R"(( \(commit [0-9a-f]{12}\+?\))?\n)")));
}

TEST_CASE("exit code 1: verify detects a compiler that miscompiles") {
  const Folder folder;
  // The compiler replaces sines by cosines and breaks the self test too. Only the comparison with the symbols detects
  // it.
  folder.write("cc", R"(#!/bin/sh
for word in "$@"; do
  case $word in
    *.c) sed -i 's/= sin(/= cos(/; s/_selftest(void)$/_real_selftest(void)/' "$word"
         name=$(basename "$word" .c)
         printf 'int %s_selftest(void) { return 0; }\n' "$name" >>"$word" ;;
  esac
done
exec cc "$@"
)");
  REQUIRE(::chmod((folder / "cc").c_str(), 0755) == 0);
  ChildCommand call = command(folder, {"verify", "P2_planar_pendulum", "--points", "3", "--json"});
  call.environment["EOMGEN_CC"] = folder / "cc";
  call.environment["EOMGEN_CACHE_DIR"] = folder / "cache";
  const ChildResult result = run_child(call);
  CAPTURE(result.err);
  CHECK(result.status == 1);
  const Json certificate = Json::parse(result.out);
  CHECK(certificate["verdict"] == "fail");
  // Functions without sine stay correct; only the emitted code fails.
  bool blamed = false;
  for (const Json& row : certificate["formulations"]) {
    if (!contains(row["a"].get<std::string>(), "emitted code")) CHECK(row["pass"] == true);
    if (row["a"] == "emitted code") blamed = row["pass"] == false;
  }
  CHECK(blamed);
}

TEST_CASE("exit code 2: an error of the model shows its position, a caret and a remedy") {
  const Folder folder;
  std::string text = pendulum_text("");
  text.replace(text.find("x^2"), 1, "xx");
  folder.write("wrong.toml", text);
  for (const Words& words : {Words{"check", "wrong.toml"}, Words{"derive", "wrong.toml"}, Words{"verify", "wrong.toml"},
                             Words{"emit", "wrong.toml", "-o", "out"}, Words{"run", "wrong.toml"}}) {
    CAPTURE(words.front());
    const ChildResult result = expect(2, folder, words);
    CHECK(result.out.empty());
    CHECK(result.err ==
          "wrong.toml:15:14: error: the name 'xx' is not declared\n"
          "  15 | holonomic = \"xx^2 + y^2 - L^2\"\n"
          "     |              ^~\n"
          "  remedy: did you mean 'x'?\n");
  }
  CHECK(folder.names() == Words{"wrong.toml"});
}

TEST_CASE("exit code 3: a diverging run keeps its rows and reports its outcome") {
  const Folder folder;
  folder.write("diverging.toml", diverging_text());
  const Json run = document(folder, {"run", "diverging.toml", "--out", "rows.csv", "--every", "0.1"}, 3);
  CHECK(run["outcome"] == "step_too_small");
  CHECK(run["error_estimate"].is_null());
  const Table table = read_table(folder.read("rows.csv"));
  CHECK(table.outcome == "step_too_small");
  REQUIRE(table.rows.size() == 31);  // 0, 0.1, .., 2.9 and the end, just before 2.9744
  CHECK(table.rows.back()[0] == run["t"]);
  CHECK_FALSE(folder.has("rows.csv.partial"));
  const ChildResult readable = expect(3, folder, {"run", "diverging.toml"});
  CHECK(contains(readable.out, "outcome           step_too_small at t = 2.97"));
}

TEST_CASE("exit code 3: with fixed steps the motion diverges, and the document stays valid") {
  const Folder folder;
  folder.write("diverging.toml", diverging_text());
  const Json run =
      document(folder, {"run", "diverging.toml", "--solver", "rk4", "--step", "0.1", "--out", "rows.csv"}, 3);
  CHECK((run["outcome"] == "diverged" || run["outcome"] == "not_finite"));
  CHECK(read_table(folder.read("rows.csv")).outcome == run["outcome"]);
}

TEST_CASE("exit code 3: the accelerations are undefined during the run") {
  const Folder folder;
  folder.write("singular.toml", singular_text());
  const Json run = document(folder, {"run", "singular.toml", "--solver", "rk4", "--step", "2", "--out", "rows.csv"}, 3);
  CHECK(run["outcome"] == "singular_mass_matrix");
  CHECK(run["steps"] == 0);
  const Table table = read_table(folder.read("rows.csv"));
  CHECK(table.outcome == "singular_mass_matrix");
  CHECK(table.rows.size() == 1);
}

TEST_CASE("exit code 4: without a C compiler, the message has the command that installs one") {
  const Folder folder;
  ChildCommand call = command(folder, {"run", "P2_planar_pendulum", "--tier", "compiled", "--out", "rows.csv"});
  call.environment["EOMGEN_CC"] = "/nonexistent";
  call.environment["EOMGEN_CACHE_DIR"] = folder / "cache";
  const ChildResult result = run_child(call);
  CHECK(result.status == 4);
  CHECK(result.out.empty());
  CHECK(contains(result.err, "the C compiler `/nonexistent` does not run"));
  CHECK(contains(result.err, "apt-get install gcc"));
  CHECK_FALSE(folder.has("rows.csv"));
  // Commands that need no compiler work without one.
  for (const Words& words : {Words{"derive", "P2_planar_pendulum"}, Words{"emit", "P2_planar_pendulum", "-o", "out"},
                             Words{"verify", "P2_planar_pendulum", "--points", "1", "--no-compile"}}) {
    call.arguments.resize(1);
    call.arguments.insert(call.arguments.end(), words.begin(), words.end());
    CHECK(run_child(call).status == 0);
  }
}

TEST_CASE("a full standard output is an error") {
  const Folder folder;
  ChildCommand call;
  call.arguments = {"/bin/sh", "-c", std::string("exec '") + EOMGEN_PROGRAM + "' list >/dev/full"};
  const ChildResult result = run_child(call);
  CHECK(result.status == 4);
  CHECK(contains(result.err, "standard output could not be written"));
}
