// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C in the middle of a run.
#include <doctest/doctest.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "program.hpp"

using namespace eomgen::test;

namespace {

// Far longer than any test may take.
const Words endless{"run", "P2_planar_pendulum", "--t-end", "1e7", "--every", "0.1", "--out", "a.csv", "--json"};

/// Until there are rows in `name`, at most ten seconds.
bool wait_for_rows(const Folder& folder, const std::string& name) {
  for (int k = 0; k < 1000; ++k) {
    if (folder.has(name) && folder.read(name).size() > 100000) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace

TEST_CASE("an interrupted run keeps its rows, names its outcome and ends with 3") {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Folder folder;
    Child child(command(folder, endless));
    REQUIRE(wait_for_rows(folder, "a.csv.partial"));
    child.signal(signal);
    const ChildResult result = child.finish();
    CAPTURE(result.err);
    CHECK(result.status == 3);
    const Json run = Json::parse(result.out);
    CHECK(run["outcome"] == "interrupted");
    const Table table = read_table(folder.read("a.csv"));  // whole rows only
    CHECK(table.outcome == "interrupted");
    CHECK(table.rows.size() > 1000);
    CHECK(table.rows.back()[0] == run["t"]);
    CHECK(folder.names() == Words{"a.csv"});
  }
}

TEST_CASE("a run that is killed leaves its rows under another name, whole but for the last, and the old table as it was") {
  const Folder folder;
  folder.write("a.csv", "old");
  Child child(command(folder, endless));
  REQUIRE(wait_for_rows(folder, "a.csv.partial"));
  child.signal(SIGKILL);
  CHECK(child.finish().status == 128 + SIGKILL);
  CHECK(folder.read("a.csv") == "old");
  // SIGKILL may fall into the middle of a write, which the kernel then cuts between two pages.
  const std::string text = folder.read("a.csv.partial");
  const Table table = read_table(text.substr(0, text.rfind('\n') + 1));
  CHECK(table.outcome.empty());
  CHECK(table.rows.size() > 100);
}

TEST_CASE("what is no terminal gets no progress") {
  const Folder folder;
  Child child(command(folder, endless));
  REQUIRE(wait_for_rows(folder, "a.csv.partial"));
  child.signal(SIGINT);
  CHECK(child.finish().err.empty());
}
