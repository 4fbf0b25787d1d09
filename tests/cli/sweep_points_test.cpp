// SPDX-License-Identifier: GPL-3.0-or-later
// Sweeps over the lines of a file; histograms of their columns.
#include <doctest/doctest.h>

#include <numeric>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// Without the first line, which identifies the sweep.
std::string text_of_rows(const std::string& text) { return text.substr(text.find('\n')); }

}  // namespace

TEST_CASE("sweep: the lines of a file are points, alone and with a grid") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  folder.write(
      "points.csv",
      "\xef\xbb\xbf# made elsewhere\r\n k , m\r\n1,1\r\n\r\n2.5, 1e0\n0.1,3");  // the last line has no line break
  expect(0, folder, {"sweep", "oscillator.toml", "--points", "points.csv", "--out", "points_sweep.csv"});
  const std::string table = folder.read("points_sweep.csv");
  CHECK(contains(table, "\nrun,k,m,outcome,"));
  for (const char* row : {"\n0,1,1,done,", "\n1,2.5,1,done,", "\n2,0.10000000000000001,3,done,"})
    CHECK(contains(table, row));
  // The same points by a grid give identical results.
  folder.write("grid.csv", "k\n1\n2\n9.3\n");
  expect(0, folder, {"sweep", "oscillator.toml", "--grid", "m=1,2", "--points", "grid.csv", "--out", "a.csv"});
  expect(0, folder, {"sweep", "oscillator.toml", "--grid", "m=1,2", "--grid", "k=1,2,9.3", "--out", "b.csv"});
  CHECK(text_of_rows(folder.read("a.csv")) == text_of_rows(folder.read("b.csv")));
  // Another file is another sweep.
  folder.write("grid.csv", "k\n1\n2\n9.4\n");
  CHECK(document(folder, {"sweep", "oscillator.toml", "--grid", "m=1,2", "--points", "grid.csv", "--out",
                          "a.csv"})["resumed"] == 0);
}

TEST_CASE("sweep: values of a parameter that the model states in degrees are radians, with a warning") {
  const Folder folder;
  folder.write("slope.toml",
               "format = 1\n[parameters]\nm = \"1 kg\"\nal = \"30 deg\"\ng = \"9.81 m/s^2\"\n[coordinates]\nx = \"m\"\n"
               "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x*cos(al)\", 0, \"x*sin(al)\"]\n"
               "[[force]]\ngravity = \"-g*E3\"\n[scene.default]\nt = [0, 1]\ninitial = { x = 1 }\n");
  const std::string warning = "the model states al in deg, and sweep takes its values as rad";
  CHECK(contains(expect(0, folder, {"sweep", "slope.toml", "--grid", "al=0.1,0.2", "--out", "a.csv"}).err, warning));
  CHECK_FALSE(contains(expect(0, folder, {"sweep", "slope.toml", "--grid", "m=1,2", "--out", "b.csv"}).err, warning));
}

TEST_CASE("sweep: values with units are those in SI units, of the dimension that the model states") {
  const Folder folder;
  folder.write("slope.toml",
               "format = 1\n[parameters]\nm = \"1 kg\"\nal = \"30 deg\"\ng = \"9.81 m/s^2\"\n[coordinates]\nx = \"m\"\n"
               "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x*cos(al)\", 0, \"x*sin(al)\"]\n"
               "[[force]]\ngravity = \"-g*E3\"\n[scene.default]\nt = [0, 1]\ninitial = { x = 1 }\n");
  const auto rows = [&](const Words& axes) {
    const auto done = expect(0, folder, with(with({"sweep", "slope.toml"}, axes), {"--out", "a.csv", "--seed", "1"}));
    CHECK_FALSE(contains(done.err, "takes its values"));
    return text_of_rows(folder.read("a.csv"));
  };
  const std::string quarter = "1.5707963267948966";
  CHECK(rows({"--grid", "al=0deg:90deg:3"}) == rows({"--grid", "al=0:" + quarter + "rad:3"}));
  CHECK(rows({"--grid", "x=5mm,1m", "--grid", "x_dot=0,36km/h"}) ==
        rows({"--grid", "x=0.005,1", "--grid", "x_dot=0,10"}));
  CHECK(rows({"--sample", "al=0:90deg", "--samples", "3"}) ==
        rows({"--sample", "al=0:" + quarter + "rad", "--samples", "3"}));
  const auto refused = [&](const std::string& option, const std::string& axis, const std::string& what) {
    const Words more = option == "--sample" ? Words{"--samples", "3"} : Words{};
    CAPTURE(axis);
    CHECK(contains(expect(2, folder, with({"sweep", "slope.toml", option, axis}, more)).err, what));
  };
  refused("--grid", "al=10:30deg:3", "mixes deg with other units");
  refused("--grid", "x=1m,2kg", "mixes m with other units");
  refused("--sample", "al=10deg:20", "mixes deg with other units");
  refused("--grid", "x=1kg,2kg", "'x' is set in kg, and the model has it in m");
  refused("--sample", "m=1m:2m", "'m' is set in m, and the model has it in kg");
  refused("--grid", "x=1furlong:2:3", "which is no unit");
}

TEST_CASE("sweep: errors in a file of points are reported with their line") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const auto refused = [&](const std::string& text, const std::string& what, const Words& more = {}) {
    folder.write("points.csv", text);
    CAPTURE(what);
    CHECK(contains(expect(2, folder, with({"sweep", "oscillator.toml", "--points", "points.csv"}, more)).err, what));
  };
  refused("", "no line has values");
  refused("k\n", "no line has values");
  refused("k,m\n1,2\n3\n", "line 3: 1 values, and 2 parameters are named");
  refused("k,,m\n1,2,3\n", "line 1: a column has no name");
  refused("k,k\n1,2\n", "comes twice");
  refused("k\n1\nnan\n", "line 3");
  refused("k\n\"1\"\n", "line 2");
  refused("k\n1e399\n", "leaves the range of binary64");
  refused(std::string("k\n1\0002\n", 6), "line 2");
  refused("kk\n1\n", "did you mean 'k'?");
  refused("k\n1\n", "has a grid and is a column of --points", {"--grid", "k=1,2"});
  refused("k\n1\n", "--sample and --points both", {"--sample", "m=1:2", "--samples", "3"});
  CHECK(contains(expect(2, folder, {"sweep", "oscillator.toml", "--points", "none.csv"}).err, "there is no such file"));
  CHECK(
      contains(expect(2, folder, {"sweep", "oscillator.toml", "--points", "/dev/zero"}).err, "there is no such file"));
  CHECK(folder.names() == Words{"oscillator.toml", "points.csv"});
}

TEST_CASE("sweep: histograms count every value once, in equal bins from the least to the greatest") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Json found =
      document(folder, {"sweep", "oscillator.toml", "--grid", "k=0:40:41", "--t-end", "0", "--statistics"});
  for (const Json& column : found["statistics"]) {
    const auto counts = column["histogram"].get<std::vector<std::size_t>>();
    CHECK(std::accumulate(counts.begin(), counts.end(), std::size_t{0}) == column["count"].get<std::size_t>());
    if (column["column"] == "energy") {  // k/2 = 0, 0.5, .. 20: two per bin, and the greatest in the last
      REQUIRE(counts.size() == 20);
      for (std::size_t i = 0; i < 20; ++i) CHECK(counts[i] == (i == 19 ? 3u : 2u));
    }
    if (column["column"] == "x") CHECK(counts == std::vector<std::size_t>{41});
  }
}
