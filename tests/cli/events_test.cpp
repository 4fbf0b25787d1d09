// SPDX-License-Identifier: GPL-3.0-or-later
// Events in exit codes, JSON, tables and emitted code.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

namespace {

const std::string scene =
    "[scene.default]\nt = [0, 3]\nrtol = 1e-12\natol = 1e-12\ninitial = { x = 1, y = 0, x_dot = 0 }\n";

}  // namespace

TEST_CASE("a terminal event is no failure: exit code 0, reported in JSON, text and table") {
  const Folder folder;
  const Json run = document(folder, {"run", "leaving_sphere", "--out", "a.csv", "--every", "0.1"});
  CHECK(run["outcome"] == "stopped_by_event");
  REQUIRE(run["events"].size() == 2);
  CHECK(run["events"][0]["kind"] == "custom");
  CHECK(run["events"][1] == Json{{"t", run["t"]}, {"kind", "stop"}, {"name", "leaves"}});
  CHECK(run["error_estimate"]["t"].get<double>() < 1e-8);
  const Table table = read_table(folder.read("a.csv"));
  CHECK(table.outcome == "stopped_by_event");
  REQUIRE(table.rows.size() == 7);
  CHECK(table.rows[5][0] == run["events"][0]["t"].get<double>());
  CHECK(table.rows[6][0] == run["t"].get<double>());
  const ChildResult text = expect(0, folder, {"run", "leaving_sphere"});
  CHECK(contains(text.out, "leaves"));
}

TEST_CASE("events with projection: on the rod, x = 0 is crossed at y = -L, and the event does not change the motion") {
  const Folder folder;
  folder.write("plain.toml", pendulum_text(scene));
  folder.write("watched.toml", pendulum_text("[[event]]\nname = \"bottom\"\nwhen = \"x\"\n"
                                             "[[event]]\nname = \"pull\"\nwhen = \"y_ddot\"\ndirection = \"up\"\n" +
                                             scene));
  const Json plain = document(folder, {"run", "plain.toml"});
  const Json watched = document(folder, {"run", "watched.toml", "--out", "a.csv", "--every", "10"});
  CHECK(watched["final"] == plain["final"]);
  CHECK(watched["steps"] == plain["steps"]);
  CHECK(watched["projection"]["work"] == plain["projection"]["work"]);
  const Table table = read_table(folder.read("a.csv"));
  std::size_t bottoms = 0;
  for (const Json& event : watched["events"]) {
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      if (table.rows[row][0] != event["t"].get<double>() || event["name"] != "bottom") continue;
      ++bottoms;
      CHECK(std::abs(table.at(row, "x")) < 1e-9);
      CHECK(std::abs(table.at(row, "y") + std::hypot(table.at(row, "x"), table.at(row, "y"))) < 1e-9);
    }
  }
  CHECK(bottoms >= 2);
  CHECK(watched["events"].size() > bottoms);
}

TEST_CASE("emit --with events: the function, its names and directions") {
  const Folder folder;
  expect(0, folder, {"emit", "leaving_sphere", "-o", ".", "--with", "events", "--target", "python"});
  expect(0, folder, {"emit", "leaving_sphere", "-o", ".", "--with", "events"});
  CHECK(contains(folder.read("leaving_sphere.h"), "int leaving_sphere_events("));
  CHECK(contains(folder.read("leaving_sphere.hpp"), "struct Event { enum : std::size_t { leaves, halfway }; };"));
  CHECK(contains(folder.read("leaving_sphere.c"), "\\\"direction\\\":\\\"down\\\""));
  // Without the option, no code for events is emitted.
  const Folder other;
  expect(0, other, {"emit", "bilinear_oscillator", "-o", "."});
  CHECK_FALSE(contains(other.read("bilinear_oscillator.c"), "side_1"));
}
