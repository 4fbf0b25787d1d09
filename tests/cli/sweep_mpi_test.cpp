// SPDX-License-Identifier: GPL-3.0-or-later
// eomgen-mpi: any number of ranks writes the bytes of a single process, also after ranks were killed. Skipped without
// MPI.
#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "program.hpp"

using namespace eomgen::test;

#if !defined(EOMGEN_MPI_PROGRAM)

TEST_CASE("sweep: without MPI there is no eomgen-mpi, and its tests are skipped") {
  MESSAGE("CMake found no MPI: eomgen-mpi is not built, and not tested");
}

#else

namespace {

ChildCommand mpirun_command(const char* ranks, const Folder& folder, const Words& words) {
  ChildCommand result = command(folder, words);
  result.arguments =
      with({EOMGEN_MPIRUN, "--oversubscribe", "--allow-run-as-root", "-n", ranks, EOMGEN_MPI_PROGRAM}, words);
  result.limit = 120;
  result.environment["OMPI_MCA_odls_base_sigkill_timeout"] =
      "0";  // otherwise mpirun waits for seconds after a nonzero exit code
  return result;
}

/// Processes of eomgen-mpi that run in this folder.
std::vector<pid_t> ranks_in(const Folder& folder) {
  namespace fs = std::filesystem;
  std::vector<pid_t> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc", none)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (fs::read_symlink(entry.path() / "cwd", none) != fs::canonical(folder.path())) continue;
    if (fs::read_symlink(entry.path() / "exe", none) == fs::canonical(EOMGEN_MPI_PROGRAM))
      found.push_back(static_cast<pid_t>(std::stol(name)));
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::size_t times(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("sweep by ranks: same bytes, counts and statistics as a single process") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  for (const Words& how : {Words{"--ensemble"}, Words{"--no-error-estimate"}}) {
    CAPTURE(how.front());
    const Words words = with({"sweep", "oscillator.toml", "--grid", "m=-1,1,2", "--sample", "k=1:9", "--samples", "700",
                              "--statistics", "--json"},
                             how);
    const Json alone = Json::parse(expect(3, folder, with(words, {"--out", "alone.csv"})).out);
    CHECK(alone["done"] == 1400);
    for (const char* ranks : {"1", "2", "5"}) {
      CAPTURE(std::string(ranks));
      const ChildResult result = run_child(mpirun_command(ranks, folder, with(words, {"--out", "ranks.csv"})));
      CAPTURE(result.err);
      CHECK(result.status == 3);
      CHECK(folder.read("ranks.csv") == folder.read("alone.csv"));
      const Json found = Json::parse(result.out);
      for (const char* key : {"runs", "done", "failed", "statistics"}) CHECK(found[key] == alone[key]);
      CHECK(folder.names() == Words{"alone.csv", "oscillator.toml", "ranks.csv"});
      CHECK(Json::parse(run_child(mpirun_command(ranks, folder, with(words, {"--out", "ranks.csv"}))).out)["resumed"] ==
            2100);
      std::filesystem::remove(folder / "ranks.csv");
    }
  }
  // A shard by ranks.
  const Words words{"sweep", "oscillator.toml", "--grid", "k=1:9:100", "--shard", "2/3", "--ensemble"};
  expect(0, folder, with(words, {"--out", "alone.csv"}));
  CHECK(run_child(mpirun_command("3", folder, with(words, {"--out", "ranks.csv"}))).status == 0);
  CHECK(folder.read("ranks.csv") == folder.read("alone.csv"));
}

TEST_CASE("sweep by ranks: after one or all ranks are killed, other ranks continue from all rows") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words words{"sweep", "oscillator.toml",     "--sample", "k=1:9", "--samples",
                    "20000", "--no-error-estimate", "--out"};
  expect(0, folder, with(words, {"whole.csv"}));
  const ChildResult once = run_child(mpirun_command("3", folder, with(words, {"once.csv"})));
  REQUIRE(once.status == 0);
  std::mt19937 random(7);
  int killed = 0, ended = 0;
  bool resumed = false;
  const char* const counts[] = {"3", "5", "2"};
  for (int i = 0; i < 8; ++i) {
    Child child(mpirun_command(counts[i % 3], folder, with(words, {"killed.csv"})));
    std::this_thread::sleep_for(
        std::chrono::duration<double>(std::uniform_real_distribution<>(0.3, 0.7)(random) * once.seconds));
    const std::vector<pid_t> ranks = ranks_in(folder);
    if (i % 4 == 3)
      child.signal(SIGTERM);  // to mpirun
    else if (!ranks.empty())
      ::kill(ranks[random() % ranks.size()], SIGKILL);
    const ChildResult result = child.finish();
    for (int wait = 0; wait < 100 && !ranks_in(folder).empty(); ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (result.status != 0) {
      ++killed;
      const Words names = folder.names();
      resumed = resumed || std::any_of(names.begin(), names.end(),
                                       [](const std::string& name) { return contains(name, "killed.csv.partial"); });
      continue;
    }
    ++ended;
    CHECK(folder.read("killed.csv") == folder.read("whole.csv"));
    std::filesystem::remove(folder / "killed.csv");
  }
  CHECK(killed > 0);
  CHECK(resumed);
  // A single process completes the sweep of several ranks.
  expect(0, folder, with(words, {"killed.csv"}));
  CHECK(folder.read("killed.csv") == folder.read("whole.csv"));
  CHECK(folder.read("once.csv") == folder.read("whole.csv"));
  CHECK(folder.names() == Words{"killed.csv", "once.csv", "oscillator.toml", "whole.csv"});
}

TEST_CASE("sweep by ranks: an error is reported once") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const auto reply = [&](const Words& words, int status, const std::string& what) {
    const ChildResult result = run_child(mpirun_command("3", folder, words));
    CAPTURE(result.err);
    CHECK(result.status == status);
    CHECK(times(result.err, what) == 1);
  };
  reply({"sweep", "oscillator.toml", "--grid", "kk=1,2"}, 2, "did you mean 'k'?");
  reply({"sweep", "oscillator.toml", "--grid", "m=-1,-2"}, 2, "no run of the grid can begin");
  reply({"sweep", "oscillator.toml", "--grid", "k=1,2", "--out", "-"}, 2, "several processes write one file");
  reply({"sweep", "oscillator.toml", "--grid", "k=1,2", "--jobs", "2"}, 2, "--jobs are threads of an ensemble here");
  reply({"derive", "oscillator.toml"}, 2, "derive");
  CHECK(folder.names() == Words{"oscillator.toml"});
}

#endif
