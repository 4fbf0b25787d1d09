// SPDX-License-Identifier: GPL-3.0-or-later
// Interruption by signals.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "program.hpp"

using namespace eomgen::test;

namespace {

// Much longer than a test may take.
const Words endless{"run", "P2_planar_pendulum", "--t-end", "1e7", "--every", "20", "--out", "a.csv", "--json"};

/// Waits until the file NAME.partial-XXXXXX has rows and returns its name; empty after 20 seconds.
std::string wait_for_rows(const Folder& folder, const std::string& name, std::size_t bytes = 100000) {
  for (int k = 0; k < 2000; ++k) {
    for (const std::string& file : folder.names()) {
      if (file.starts_with(name + ".partial-") && file.size() == name.size() + 15 &&
          std::filesystem::file_size(folder / file) > bytes)
        return file;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return "";
}

}  // namespace

TEST_CASE("an interrupted run keeps its rows, reports its outcome and exits with code 3") {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Folder folder;
    Child child(command(folder, endless));
    REQUIRE_FALSE(wait_for_rows(folder, "a.csv").empty());
    child.signal(signal);
    const ChildResult result = child.finish();
    CAPTURE(result.err);
    CHECK(result.status == 3);
    const Json run = Json::parse(result.out);
    CHECK(run["outcome"] == "interrupted");
    const Table table = read_table(folder.read("a.csv"));  // complete rows only
    CHECK(table.outcome == "interrupted");
    CHECK(table.rows.size() > 1000);
    CHECK(table.rows.back()[0] == run["t"]);
    CHECK(folder.names() == Words{"a.csv"});
  }
}

TEST_CASE(
    "a killed run leaves its rows under another name, complete except the last one, and does not touch the old table") {
  const Folder folder;
  folder.write("a.csv", "old");
  Child child(command(folder, endless));
  const std::string partial = wait_for_rows(folder, "a.csv");
  REQUIRE_FALSE(partial.empty());
  child.signal(SIGKILL);
  CHECK(child.finish().status == 128 + SIGKILL);
  CHECK(folder.read("a.csv") == "old");
  // SIGKILL may interrupt a write, which the kernel then cuts at a page boundary.
  const std::string text = folder.read(partial);
  const Table table = read_table(text.substr(0, text.rfind('\n') + 1));
  CHECK(table.outcome.empty());
  CHECK(table.rows.size() > 100);
}

TEST_CASE("progress is printed on terminals only") {
  const Folder folder;
  Child child(command(folder, endless));
  REQUIRE_FALSE(wait_for_rows(folder, "a.csv").empty());
  child.signal(SIGINT);
  CHECK(child.finish().err.empty());
}

TEST_CASE("Ctrl-C takes effect while the rows of one step are written") {
  const Folder folder;
  Child child(command(folder, {"run", "P2_planar_pendulum", "--every", "1e-9", "--yes", "--out", "a.csv", "--json"}));
  REQUIRE_FALSE(wait_for_rows(folder, "a.csv").empty());
  const auto asked = std::chrono::steady_clock::now();
  child.signal(SIGINT);
  const ChildResult result = child.finish();
  CHECK(std::chrono::steady_clock::now() - asked < std::chrono::seconds(5));  // immediate, except on a busy machine
  CHECK(result.status == 3);
  const Json run = Json::parse(result.out);
  CHECK(run["outcome"] == "interrupted");
  const Table table = read_table(folder.read("a.csv"));
  CHECK(table.outcome == "interrupted");
  CHECK(table.rows.back()[0] == run["t"]);
  CHECK(table.rows.back()[0] - table.rows[table.rows.size() - 2][0] < 2e-9);  // no gap before the end
}

TEST_CASE("SIGTERM takes effect while the compiler hangs, and no files are left") {
  const Folder folder;
  folder.write("cc", "#!/bin/sh\n[ \"$1\" = --version ] && exec echo slow\ntouch working\nsleep 1000\n");
  REQUIRE(::chmod((folder / "cc").c_str(), 0755) == 0);
  ChildCommand call = command(folder, {"run", "P2_planar_pendulum", "--tier", "compiled"});
  call.environment["EOMGEN_CC"] = folder / "cc";
  call.environment["EOMGEN_CACHE_DIR"] = folder / "cache";
  Child child(call);
  for (int k = 0; k < 2000 && !folder.has("working"); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  REQUIRE(folder.has("working"));
  child.signal(SIGTERM);
  const ChildResult result = child.finish();
  CAPTURE(result.err);
  CHECK(result.in_time);
  CHECK(result.status == 3);
  CHECK(contains(result.err, "interrupted before the run began"));
  // No files of the compilation; the certificate was complete before.
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cache"))
    CHECK(entry.path().filename().string().starts_with("certificate-"));
}

TEST_CASE("every command that derives stops on Ctrl-C immediately with exit code 3, in any stage") {
  const Folder folder;
  // Distances of all pairs of 20 particles on relative angles: every stage takes long.
  folder.write("a.toml",
               "format = 1\n[[chain]]\nname = \"link\"\nn = 20\nmass = 1\nlength = 1\ncoordinate = \"th\"\nangles = "
               "\"relative\"\n"
               "[[force]]\ngravitation = { G = 1 }\n[scene.default]\nt = [0, 1]\ninitial = { th1 = 0.5, th2 = 0.3 }\n");
  const std::vector<Words> commands{{"check", "a.toml"},
                                    {"derive", "a.toml", "--show", "all"},
                                    {"derive", "a.toml", "--document", "a.tex"},
                                    {"verify", "a.toml"},
                                    {"emit", "a.toml", "-o", "out"},
                                    {"emit", "a.toml", "-o", "out", "--target", "latex"},
                                    {"report", "a.toml", "-o", "a.html"},
                                    {"linearize", "a.toml"},
                                    {"equilibria", "a.toml"},
                                    {"stress", "a.toml"}};
  for (const Words& words : commands) {
    CAPTURE(words[0]);
    Child child(command(folder, words));
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    const auto asked = std::chrono::steady_clock::now();
    child.signal(SIGINT);
    const ChildResult result = child.finish();
    CHECK(result.status == 3);
    CHECK(contains(result.err, "interrupted"));
    CHECK(std::chrono::steady_clock::now() - asked < std::chrono::seconds(1));  // 0.2 s on an idle machine
  }
  CHECK(folder.names() == Words{"a.toml"});
}

TEST_CASE("a second signal ends a command that does not see the first") {
  for (const int second : {SIGINT, SIGTERM}) {
    const Folder folder;
    REQUIRE(::mkfifo((folder / "a.csv").c_str(), 0600) == 0);  // nobody reads: writing to it never ends
    Child child(command(folder, {"run", "P2_planar_pendulum", "--every", "1e-4", "--out", "a.csv"}));
    const int reader = ::open((folder / "a.csv").c_str(), O_RDONLY);  // returns once the command has opened it
    REQUIRE(reader >= 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    child.signal(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));  // beyond the patience of those who see it
    child.signal(second);
    const ChildResult result = child.finish();
    CHECK(result.in_time);
    CHECK(result.status == 128 + second);
    ::close(reader);
  }
}

TEST_CASE("equilibria that were found before Ctrl-C are shown") {
  const Folder folder;
  Child child(command(folder, {"equilibria", "S5_double_pendulum", "--starts", "100000", "--json"}));
  std::this_thread::sleep_for(std::chrono::seconds(2));  // a few thousand starts; the first ones find all four
  child.signal(SIGINT);
  const ChildResult result = child.finish();
  CHECK(result.status == 3);
  CHECK(contains(result.err, "interrupted"));
  const Json found = Json::parse(result.out);
  CHECK(found["interrupted"] == true);
  CHECK(found["points"].size() == 4);
}
