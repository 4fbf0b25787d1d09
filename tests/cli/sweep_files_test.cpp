// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of sweeps that were killed, truncated or damaged; memory of sweeps with many runs.
#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <random>
#include <thread>

#include "program.hpp"
#include "support/sanitized.hpp"

using namespace eomgen::test;

namespace {

/// Offset of the end of the first `lines` lines.
std::size_t offset_after_lines(const std::string& text, int lines) {
  std::size_t at = 0;
  for (int i = 0; i < lines; ++i) at = text.find('\n', at) + 1;
  return at;
}

}  // namespace

TEST_CASE("sweep: after repeated kills at any time, it ends with the bytes of an uninterrupted sweep") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  std::mt19937 random(5);  // fixed: NOLINT(cert-msc32-c,cert-msc51-cpp)
  for (const Words& how : {Words{"--ensemble"}, Words{"--no-error-estimate", "--jobs", "2"}}) {
    CAPTURE(how.front());
    const Words words =
        with({"sweep", "oscillator.toml", "--grid", "m=1,-1,2", "--sample", "k=1:9", "--samples", "3000", "--out"}, {});
    const ChildResult alone = expect(3, folder, with(with(words, {"whole.csv"}), how));
    int killed = 0, ended = -1;
    for (int i = 0; i < 20 && ended < 0; ++i) {
      Child child(command(folder, with(with(words, {"killed.csv"}), how)));
      std::this_thread::sleep_for(
          std::chrono::duration<double>(std::uniform_real_distribution<>(0, 0.6 * alone.seconds)(random)));
      child.signal(SIGKILL);
      const ChildResult result = child.finish();
      if (result.status == 128 + SIGKILL)
        ++killed;
      else
        ended = result.status;
    }
    CHECK(killed > 0);
    if (ended < 0) ended = eomgen::test::eomgen(folder, with(with(words, {"killed.csv"}), how)).status;
    CHECK(ended == 3);  // negative masses are refused
    CHECK(folder.read("killed.csv") == folder.read("whole.csv"));
    CHECK(folder.names() == Words{"killed.csv", "oscillator.toml", "whole.csv"});
  }
}

TEST_CASE("sweep: rows truncated by a full disk, and runs that do not belong to the sweep, are computed again") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words words{"sweep", "oscillator.toml", "--grid", "k=1:9:9", "--out", "all.csv"};
  expect(0, folder, words);
  const std::string whole = folder.read("all.csv");
  folder.write("all.csv", "something else");
  std::string damaged = whole;
  damaged.erase(offset_after_lines(whole, 4) - 20, 19);  // the end of the second row
  folder.write("all.csv.partial", damaged + "9,9,done,1,6,74,0,0,0,0,\n77,9,done,1,6,74,0,0,0,0,\n");
  CHECK(document(folder, words)["resumed"] == 8);
  CHECK(folder.read("all.csv") == whole);
  // The same for one row of an otherwise complete table.
  folder.write("all.csv", damaged);
  CHECK(document(folder, words)["resumed"] == 8);
  CHECK(folder.read("all.csv") == whole);
}

TEST_CASE("sweep: rows that were edited are computed again, with a warning") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words words{"sweep", "oscillator.toml", "--grid", "k=1:9:9", "--out", "all.csv"};
  expect(0, folder, words);
  const std::string whole = folder.read("all.csv");
  const std::size_t begin = offset_after_lines(whole, 3), end = offset_after_lines(whole, 4);
  const std::string row = whole.substr(begin, end - begin);  // the second one: "1,2,done,1,.."
  const auto with_row = [&](const std::string& other) { return whole.substr(0, begin) + other + whole.substr(end); };
  const auto replaced = [&row](const std::string& from, const std::string& to) {
    std::string text = row;
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
  };
  const std::string last_field = row.substr(row.rfind(','));
  for (const std::string& edited :
       {with_row(replaced(",done,1,", ",done,2,")), with_row(replaced(",done,1,", ",done,nan,")),
        with_row(replaced(",done,", ",exploded,")), with_row(replaced(last_field, ",=cmd|calc" + last_field)),
        with_row(replaced("1,2,", "1,3,"))}) {
    CAPTURE(edited);
    folder.write("all.csv", edited);
    const ChildResult result = expect(0, folder, words);
    CHECK(contains(result.out, "(8 of them were there)"));
    CHECK(contains(result.err, "1 lines of 'all.csv' are no rows of this sweep"));
    CHECK(folder.read("all.csv") == whole);
  }
  // Text behind the rows is removed.
  for (const std::string& tail :
       {std::string("=cmd|calc\n"), std::string(3 << 20, 'x'), std::string(8 << 20, 'x'), "9" + row.substr(1)}) {
    folder.write("all.csv", whole + tail);
    CHECK(contains(expect(0, folder, words).out, "(9 of them were there)"));
    CHECK(folder.read("all.csv") == whole);
  }
}

TEST_CASE("sweep: a table whose columns were changed is refused and kept") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words words{"sweep", "oscillator.toml", "--grid", "k=1:9:9", "--out", "all.csv"};
  expect(0, folder, words);
  std::string table = folder.read("all.csv");
  table.replace(table.find(",energy,"), 8, ",energie,");
  for (const char* name : {"all.csv", "all.csv.partial"}) {
    std::filesystem::remove(folder / "all.csv");
    folder.write(name, table);
    CHECK(contains(expect(2, folder, words).err, "has other columns than this sweep writes"));
    CHECK(folder.read(name) == table);
    CHECK(folder.names() == Words{name, "oscillator.toml"});
  }
}

TEST_CASE("sweep: a second sweep to the same table is refused while the first one runs") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words first = {"sweep",  "oscillator.toml", "--sample", "k=1:9", "--samples",
                       "200000", "--jobs",          "1",        "--out", "all.csv"};
  Child child(command(folder, first));
  const auto writes = [&folder] {
    const Words names = folder.names();
    return std::any_of(names.begin(), names.end(), [](const std::string& n) { return contains(n, "all.csv.partial"); });
  };
  for (int wait = 0; wait < 2000 && !writes(); ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  REQUIRE(writes());
  const Words second{"sweep", "oscillator.toml", "--grid", "k=1:9:9", "--out", "all.csv"};
  CHECK(contains(expect(2, folder, second).err, "another sweep is writing 'all.csv'"));
  child.signal(SIGKILL);
  child.finish();
  CHECK(contains(expect(2, folder, second).err, "is the unfinished table of another sweep"));  // the lock ended
}

TEST_CASE("sweep: the table of a model whose file name has a line break is continued") {
  const Folder folder;
  folder.write("two\nlines.toml", oscillator_text());
  const Words words{"sweep", "two\nlines.toml", "--grid", "k=1:9:9", "--out", "all.csv"};
  expect(0, folder, words);
  CHECK(document(folder, words)["resumed"] == 9);
}

TEST_CASE("sweep: runs that cannot start cost no derivation each, at any position") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Json found =
      document(folder, {"sweep", "oscillator.toml", "--grid", "m=-1:1:4001", "--ensemble", "--t-end", "0.01"}, 3);
  CHECK(found["done"] == 2000);
  CHECK(found["failed"] == 2001);
}

TEST_CASE("sweep: memory stores neither rows nor the nodes that runs add to the graph of the model" *
          doctest::skip(sanitized)) {  // would measure the memory of the sanitizers
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const auto peak = [&](const char* samples, const Words& how) {
    const Words words =
        with({"sweep", "oscillator.toml", "--sample", "k=1:9", "--t-end", "0.01", "--statistics", "--samples", samples},
             how);
    expect(0, folder, with(words, {"--out", "first.csv"}));  // compiles
    return expect(0, folder, with(words, {"--out", "second.csv"})).peak_kilobytes;
  };
  // Per run: 24 bytes for a row, 8 for an open run, 9 for a run of an ensemble, 64 for its values during statistics.
  // The row itself has 120.
  for (const Words& how : {Words{"--ensemble", "--jobs", "1"},
                           Words{"--no-error-estimate", "--jobs", "1", "--solver", "rk4", "--step", "0.01"}}) {
    CAPTURE(how.front());
    CHECK(peak("61000", how) - peak("1000", how) < 60 * 160);
  }
}

TEST_CASE("merge: shards give the bytes of the sweep in one call, interrupted or not") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words sweep{"sweep", "oscillator.toml", "--grid", "m=1,2,-1",           "--sample",
                    "k=1:9", "--samples",       "5",      "--no-error-estimate"};
  expect(3, folder, with(sweep, {"--out", "whole.csv"}));
  for (const char* i : {"1", "2", "3", "4"})
    document(folder, with(sweep, {"--out", std::string(i) + ".csv", "--shard", std::string(i) + "/4"}), 3);
  const Json found =
      document(folder, {"merge", "3.csv", "1.csv", "4.csv", "2.csv", "--out", "merged.csv", "--statistics"});
  CHECK(found["runs"] == 15);
  CHECK(found["shards"] == 4);
  CHECK(found["statistics"].size() > 0);
  CHECK(folder.read("merged.csv") == folder.read("whole.csv"));
  // An interrupted shard lacks runs, and its own call computes them.
  const std::string whole = folder.read("2.csv");
  const std::size_t cut = whole.rfind('\n', whole.size() - 2) + 1;
  folder.write("2.csv", whole.substr(0, cut));
  const Words merge{"merge", "1.csv", "2.csv", "3.csv", "4.csv", "--out", "again.csv"};
  const std::string reply = expect(2, folder, merge).err;
  CHECK(contains(reply, "run 13 is missing, and 1 of 15 in all"));
  CHECK(contains(reply, "sweep --shard 2/4"));
  CHECK(document(folder, with(sweep, {"--out", "2.csv", "--shard", "2/4"}), 3)["resumed"] == 3);
  expect(0, folder, merge);
  CHECK(folder.read("again.csv") == folder.read("whole.csv"));
  const auto refused = [&](const Words& words, const std::string& what) {
    CAPTURE(what);
    CHECK(contains(expect(2, folder, words).err, what));
  };
  refused({"merge", "1.csv", "2.csv", "4.csv", "-o", "no.csv"}, "shard 3/4 is missing");
  refused({"merge", "1.csv", "1.csv", "-o", "no.csv"}, "are the same shard");
  refused({"merge", "whole.csv", "-o", "no.csv"}, "is not the table of a shard");
  refused({"merge", "none.csv", "-o", "no.csv"}, "cannot read");
  expect(0, folder, {"sweep", "oscillator.toml", "--grid", "m=1,2", "--out", "other.csv", "--shard", "2/2"});
  refused({"merge", "1.csv", "other.csv", "-o", "no.csv"}, "are of different sweeps");
  CHECK_FALSE(folder.has("no.csv"));
  refused({"sweep", "oscillator.toml", "--grid", "m=1,2", "--shard", "0/2"}, "is no shard");
  refused({"sweep", "oscillator.toml", "--grid", "m=1,2", "--shard", "3/3"}, "has no runs");
  refused({"sweep", "oscillator.toml", "--samples", "3"}, "no --sample names a parameter");
  refused({"sweep", "oscillator.toml", "--sample", "k=1:2"}, "--samples gives no number");
  refused({"sweep", "oscillator.toml", "--sample", "k=1", "--samples", "3"}, "is no range of samples");
  refused({"sweep", "oscillator.toml", "--sample", "k=1:0:normal", "--samples", "3"}, "is not above 0");
  refused({"sweep", "oscillator.toml", "--sample", "k=-1:1:log", "--samples", "3"}, "goes through 0");
  refused({"sweep", "oscillator.toml", "--sample", "k=1:2", "--sample", "k=1:2", "--samples", "3"}, "is sampled twice");
  refused({"sweep", "oscillator.toml", "--sample", "k=1:2", "--samples", "3", "--grid", "k=1,2"},
          "has a grid and is sampled");
  refused({"sweep", "oscillator.toml", "--sample", "k=1:2", "--samples", "3", "--design", "lattice"},
          "choose random, latin or sobol");
}

TEST_CASE("merge: a table that ends in the middle of a line lacks that run; a single shard is a whole sweep") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words sweep{"sweep", "oscillator.toml", "--grid", "k=1:9:7", "--no-error-estimate"};
  for (const char* i : {"1", "2"})
    expect(0, folder, with(sweep, {"--out", std::string(i) + ".csv", "--shard", std::string(i) + "/2"}));
  const std::string second = folder.read("2.csv");
  folder.write("2.csv", second.substr(0, second.size() - 5));
  const Words merge{"merge", "1.csv", "2.csv", "--out", "all.csv"};
  const std::string reply = expect(2, folder, merge).err;
  CHECK(contains(reply, "run 5 is missing, and 1 of 7 in all"));
  folder.write("2.csv", second.substr(0, second.size() - 5) + "\n");
  CHECK(contains(expect(2, folder, merge).err, "a line that is no run of that shard"));
  std::string moved = second;
  moved.replace(moved.find("\n1,") + 3, 1, "7");  // the value of k of run 1
  folder.write("2.csv", moved);
  CHECK(contains(expect(2, folder, merge).err, "was changed"));
  folder.write("2.csv", second + second.substr(offset_after_lines(second, 3)));
  CHECK(contains(expect(2, folder, merge).err, "2 lines are of runs that another line has"));
  folder.write("2.csv", "");
  CHECK(contains(expect(2, folder, merge).err, "is not the table of a shard"));
  expect(0, folder, with(sweep, {"--out", "whole.csv"}));
  expect(0, folder, with(sweep, {"--out", "1of1.csv", "--shard", "1/1"}));
  expect(0, folder, {"merge", "1of1.csv", "--out", "all.csv"});
  CHECK(folder.read("all.csv") == folder.read("whole.csv"));
  CHECK(expect(0, folder, {"merge", "1of1.csv", "--out", "-"}).out == folder.read("whole.csv"));
  CHECK(contains(expect(4, folder, {"merge", "1of1.csv", "--out", "/dev/full"}).err, "No space left"));
}
