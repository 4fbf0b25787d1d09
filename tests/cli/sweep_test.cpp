// SPDX-License-Identifier: GPL-3.0-or-later
// Command sweep: table against single runs, continuation after an interruption, refusals.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "program.hpp"

using namespace eomgen::test;

namespace {

// x'' = k x^2 from x = 1.
const char* const diverging =
    "format = 1\n[parameters]\nk = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n"
    "potential = \"-k*x^3/3\"\n[scene.default]\nt = [0, 10]\ninitial = { x = 1 }\n";

std::vector<Words> rows(const std::string& text) {
  std::vector<Words> result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    result.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) result.back().push_back(field);
  }
  return result;
}

}  // namespace

TEST_CASE("sweep: every point of the grid equals the corresponding run, the last parameter fastest") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Json found = document(folder, {"sweep", "oscillator.toml", "--grid", "m=1,2", "--grid", "k=1:100:log:3",
                                       "--rtol", "1e-11", "--jobs", "3"});
  CHECK(found["runs"] == 6);
  CHECK(found["done"] == 6);
  CHECK(found["failed"] == 0);
  CHECK(found["file"] == "oscillator_sweep.csv");
  const std::vector<Words> table = rows(folder.read("oscillator_sweep.csv"));
  REQUIRE(table.size() == 8);
  CHECK(table[1] == Words{"run", "m", "k", "outcome", "t", "steps", "rhs_evaluations", "x", "x_dot", "energy",
                          "error_estimate", "detail", "checksum"});
  const double m[] = {1, 1, 1, 2, 2, 2}, k[] = {1, 10, 100, 1, 10, 100};
  for (std::size_t i = 0; i < 6; ++i) {
    const Words& row = table[i + 2];
    CHECK(std::stoul(row[0]) == i);
    CHECK(std::stod(row[1]) == m[i]);
    CHECK(std::stod(row[2]) == doctest::Approx(k[i]).epsilon(1e-15));
    CHECK(row[3] == "done");
    const double w = std::sqrt(k[i] / m[i]);
    CHECK(std::abs(std::stod(row[7]) - std::cos(w)) < 1e-9);  // a few hundred tolerances of a step
    CHECK(std::abs(std::stod(row[8]) + w * std::sin(w)) < 1e-8);
  }
  CHECK_FALSE(folder.has("oscillator_sweep.csv.partial"));
}

TEST_CASE("sweep: initial values are varied like parameters, in processes and in an ensemble") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words sweep{"sweep",       "oscillator.toml", "--grid", "x=1,2",  "--grid",
                    "x_dot=0:3:2", "--grid",          "k=4",    "--rtol", "1e-11"};
  document(folder, sweep);
  const std::vector<Words> table = rows(folder.read("oscillator_sweep.csv"));
  REQUIRE(table.size() == 6);
  CHECK(Words(table[1].begin(), table[1].begin() + 5) == Words{"run", "initial(x)", "initial(x_dot)", "k", "outcome"});
  for (std::size_t i = 2; i < table.size(); ++i) {
    const double x = std::stod(table[i][1]), v = std::stod(table[i][2]);
    CHECK(std::abs(std::stod(table[i][8]) - (x * std::cos(2.0) + v / 2 * std::sin(2.0))) < 1e-9);
  }
  Words lanes = sweep;
  for (const char* word : {"--ensemble", "-o", "lanes.csv"}) lanes.emplace_back(word);
  document(folder, lanes);
  Words plain = sweep;
  for (const char* word : {"--no-error-estimate", "-o", "plain.csv", "--solver", "dop853"}) plain.emplace_back(word);
  document(folder, plain);
  const std::vector<Words> side = rows(folder.read("lanes.csv")), alone = rows(folder.read("plain.csv"));
  REQUIRE(side.size() == alone.size());
  for (std::size_t i = 1; i < side.size(); ++i) CHECK(side[i] == alone[i]);
  CHECK(contains(expect(2, folder, {"sweep", "oscillator.toml", "--grid", "xdot=1,2"}).err, "x_dot"));
  CHECK(contains(expect(2, folder, {"sweep", "oscillator.toml", "--grid", "x=1,2", "--set", "x=1"}).err,
                 "'x' is varied, and has a value by --set"));
  CHECK(document(folder, {"run", "oscillator.toml", "--set", "x=3", "--t-end", "0"})["final"]["x"] == 3);
}

TEST_CASE("sweep: inputs are varied like parameters, in processes and in an ensemble") {
  const Folder folder;
  folder.write("cart.toml",
               "format = 1\n[inputs]\nF = { default = 2 }\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n"
               "[[force]]\ngeneralized = { x = \"F\" }\n[scene.default]\nt = [0, 2]\n");
  for (const Words& more : {Words{}, Words{"--ensemble"}}) {
    Words words{"sweep", "cart.toml", "--grid", "F=0,1,3", "-o", more.empty() ? "a.csv" : "b.csv"};
    words.insert(words.end(), more.begin(), more.end());
    document(folder, words);
    const std::vector<Words> table = rows(folder.read(words[5]));
    REQUIRE(table.size() == 5);
    const auto x = static_cast<std::size_t>(std::find(table[1].begin(), table[1].end(), "x") - table[1].begin());
    for (std::size_t i = 2; i < table.size(); ++i)
      CHECK(std::abs(std::stod(table[i].at(x)) - 2 * std::stod(table[i][1])) < 1e-9);
  }
}

TEST_CASE("sweep: continues from existing rows and gives the same bytes") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words words{"sweep", "oscillator.toml", "--grid", "k=1:9:5", "--out", "all.csv"};
  expect(0, folder, words);
  const std::string whole = folder.read("all.csv");
  CHECK(document(folder, words)["resumed"] == 5);
  // The first two lines, two rows, and a truncated row.
  std::size_t at = 0;
  for (int line = 0; line < 4; ++line) at = whole.find('\n', at) + 1;
  folder.write("all.csv.partial", whole.substr(0, at + 7));
  folder.write("all.csv", "something else");
  CHECK(document(folder, words)["resumed"] == 2);
  CHECK(folder.read("all.csv") == whole);
  // Another sweep does not take it over.
  folder.write("all.csv.partial", whole.substr(0, at));
  const ChildResult other = expect(2, folder, {"sweep", "oscillator.toml", "--grid", "k=1:9:4", "--out", "all.csv"});
  CHECK(contains(other.err, "unfinished table of another sweep"));
  CHECK(folder.read("all.csv.partial") == whole.substr(0, at));
}

TEST_CASE("sweep: runs that cannot start or that fail are stored and counted") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Json found = document(folder, {"sweep", "oscillator.toml", "--grid", "m=-1,1,0"}, 3);
  CHECK(found["done"] == 1);
  CHECK(found["failed"] == 2);
  const std::vector<Words> table = rows(folder.read("oscillator_sweep.csv"));
  CHECK(table[2][2] == "refused");
  CHECK(contains(folder.read("oscillator_sweep.csv"), "\"parameter 'm' is declared positive, and its value is -1\","));
  CHECK(table[3][2] == "done");
  folder.write("diverging.toml", diverging);
  CHECK(document(folder, {"sweep", "diverging.toml", "--grid", "k=0,1"}, 3)["failed"] == 1);
  const ChildResult none = expect(2, folder, {"sweep", "oscillator.toml", "--grid", "m=-1,-2"});
  CHECK(contains(none.err, "no run of the grid can begin"));
}

TEST_CASE("sweep: errors of a grid are reported") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const auto refused = [&](const Words& more, const std::string& what) {
    CAPTURE(what);
    CHECK(contains(expect(2, folder, with({"sweep", "oscillator.toml"}, more)).err, what));
    CHECK(folder.names() == Words{"oscillator.toml"});
  };
  refused({}, "nothing is to be varied");
  refused({"--grid", "kk=1,2"}, "did you mean 'k'?");
  refused({"--grid", "k"}, "names no parameter");
  refused({"--grid", "k=1:2"}, "is no range of values");
  refused({"--grid", "k=1:2:1"}, "whole number of at least 2");
  refused({"--grid", "k=1:2:2.5"}, "whole number of at least 2");
  refused({"--grid", "k=-1:2:log:3"}, "goes through 0");
  refused({"--grid", "k=1:2:cubic:3"}, "lin or log");
  refused({"--grid", "k=1,x"}, "no decimal number");
  refused({"--grid", "k=1,2", "--grid", "k=3,4"}, "two grids");
  refused({"--grid", "k=1,2", "--set", "k=3"}, "'k' is varied, and has a value by --set");
  refused({"--sample", "k=1:2", "--samples", "3", "--set", "k=3"}, "'k' is varied, and has a value by --set");
  refused({"--sample", "k=-1:2:log", "--samples", "3"}, "goes through 0");
  refused({"--sample", "k=1:-1:normal", "--samples", "3"}, "a deviation that is not above 0");
  refused({"--sample", "k=1e-200:1e200:log", "--samples", "3"}, "leaves the range of binary64");
  refused({"--sample", "k=1e-400:1:log", "--samples", "3"}, "leaves the range of binary64");
  refused({"--sample", "k=-1e308:1e308", "--samples", "3"}, "leaves the range of binary64");
  refused({"--grid", "k=1:2:10000", "--grid", "m=1:2:1001"}, "no more than 10000000 points, and these are 10010000");
  refused({"--grid", "k=1:2:1000000", "--grid", "m=1:2:1000001"}, "more than 1000000000000 points");
  refused({"--grid", "k=1:2:3", "--design", "latin"}, "--design is of samples, and there are none");
  refused({"--grid", "k=1:2:3", "--set", "mm=3"}, "there is no parameter 'mm' to set");
}

TEST_CASE(
    "sweep: an ensemble gives the same bytes as separate runs, for any number of threads, and continues from existing "
    "rows") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  folder.write("stepped.toml", oscillator_text() + "step = 0.01\n");
  folder.write("diverging.toml", diverging);
  folder.write("pushed.toml",
               "format = 1\n[parameters]\nm = 1\nc = 0.5\n[inputs]\nF = { unit = \"N\" }\n[coordinates]\nx = "
               "{}\n[energy]\nkinetic = \"m*x_dot^2/2\"\n"
               "[[force]]\nname = \"push\"\ngeneralized = { x = \"F - c*x_dot\" }\n[scene.default]\nt = [0, "
               "3]\ninitial = { x = 1 }\ninputs = { F = \"2*m\" }\n");
  // Some runs end at a wall after several passages of the middle; others never reach it.
  const auto watched = [&](const std::string& file, const std::string& force) {
    folder.write(file,
                 "format = 1\n[parameters]\nm = 1\nk = 9\nc = 0.1\n[coordinates]\nx = {}\ny = {}\n[energy]\nkinetic = "
                 "\"m*(x_dot^2 + y_dot^2)/2\"\npotential = \"k*x^2/2 + k*y^2/3 + x^2*y + c*x\"\n" +
                     force +
                     "[[event]]\nname = \"middle\"\nwhen = \"x\"\n[[event]]\nname = \"wall\"\nwhen = \"y - 0.5*m + "
                     "0.2\"\ndirection = \"up\"\n"
                     "[scene.default]\nt = [0, 4]\ninitial = { x = 1, y = -0.5 }\nstop = [\"wall\"]\n");
  };
  watched("watched.toml", "[[force]]\nname = \"drag\"\ngeneralized = { x = \"-c*x_dot\", y = \"-c*y_dot\" }\n");
  watched("watched_energy.toml", "");
  const auto rows_of = [&](const std::string& file) {
    const std::string text = folder.read(file);
    return text.substr(text.find('\n'));  // the first line identifies the sweep
  };
  struct Case {
    const char* model;
    Words options;
    int status;
  };
  for (const Case& c :
       {Case{"S5_double_pendulum",
             {"--grid", "L1=0.5:2:5", "--grid", "g=1,9.81,30", "--t-end", "3", "--solver", "dop853"},
             0},
        Case{"S6_chain_2", {"--grid", "L=0.5:2:9", "--solver", "tsit5", "--rtol", "1e-7", "--output", "all"}, 0},
        Case{"oscillator.toml",
             {"--grid", "m=1,-1,2,0", "--grid", "k=1:100:log:4", "--solver", "rk4", "--step", "0.01"},
             3},
        Case{"diverging.toml", {"--grid", "k=0:1:7", "--solver", "dopri5"}, 3},
        Case{"stepped.toml", {"--grid", "k=1:9:5"}, 0},
        Case{"pushed.toml", {"--grid", "m=1:3:7", "--solver", "dop853"}, 0},
        Case{"watched.toml", {"--grid", "m=1:3:40", "--sample", "x=0.5:1", "--samples", "2", "--solver", "dop853"}, 0},
        Case{"watched.toml", {"--grid", "m=1:3:20", "--solver", "tsit5", "--rtol", "1e-6"}, 0},
        Case{"pushed.toml", {"--grid", "m=1:3:7", "--solver", "rodas"}, 0},
        Case{"watched.toml", {"--grid", "m=1:3:20", "--solver", "rodas", "--rtol", "1e-6"}, 0},
        Case{"watched.toml", {"--grid", "m=1:3:20", "--solver", "taylor"}, 0},
        Case{"watched_energy.toml", {"--grid", "m=1:3:20", "--solver", "rodas", "--rtol", "1e-6"}, 0},
        Case{"watched_energy.toml", {"--grid", "m=1:3:20", "--solver", "taylor"}, 0},
        Case{"watched.toml", {"--grid", "m=1:3:7", "--solver", "radau"}, 0},
        Case{"S6_chain_2", {"--grid", "L=0.5:2:5", "--solver", "taylor"}, 0}}) {
    CAPTURE(std::string(c.model));
    const auto sweep = [&](const Words& more) {
      expect(c.status, folder, with(with({"sweep", c.model}, c.options), more));
    };
    sweep({"--no-error-estimate", "--out", "alone.csv"});
    sweep({"--ensemble", "--jobs", "1", "--out", "one.csv"});
    sweep({"--ensemble", "--jobs", "3", "--out", "three.csv"});
    CHECK(rows_of("one.csv") == rows_of("alone.csv"));
    CHECK(folder.read("three.csv") == folder.read("one.csv"));
  }
  // The rows of some runs exist.
  const Words words{"sweep", "oscillator.toml", "--grid", "k=1:9:50", "--ensemble", "--out", "all.csv"};
  expect(0, folder, words);
  const std::string whole = folder.read("all.csv");
  std::size_t at = 0;
  for (int line = 0; line < 22; ++line) at = whole.find('\n', at) + 1;
  folder.write("all.csv.partial", whole.substr(0, at + 7));
  folder.write("all.csv", "something else");
  CHECK(document(folder, words)["resumed"] == 20);
  CHECK(folder.read("all.csv") == whole);
}

TEST_CASE("sweep: --basins counts the runs that end at each equilibrium, with angles modulo turns, and elsewhere") {
  const Folder folder;
  // Two wells, at a = -1 and 1, and an angle that comes to rest hanging, also after a full turn.
  folder.write("wells.toml",
               "format = 1\n[parameters]\nc = 2\n[coordinates]\na = {}\nphi = {}\n[energy]\nkinetic = \"(a_dot^2 + "
               "phi_dot^2)/2\"\npotential = \"a^4/4 - a^2/2 - 9*cos(phi)\"\n[[force]]\nname = \"drag\"\ngeneralized = "
               "{ a = \"-c*a_dot\", phi = \"-c*phi_dot\" }\n[scene.default]\nt = [0, 40]\ninitial = { a = 0.5, phi = 1 "
               "}\n");
  const Words words{"sweep", "wells.toml", "--grid", "a=-2,-1.5,-1,-0.5,0.5,1", "--grid", "phi=0.5,7.5", "--ensemble"};
  const Json found = document(folder, with(words, {"--basins", "1e-3"}));
  const Json& basins = found["basins"];
  CHECK(basins["elsewhere"] == 0);
  std::map<double, std::size_t> runs;
  for (const Json& goal : basins["reached"]) {
    if (goal["stability"] == "stable") {
      CHECK(goal["values"]["phi"].get<double>() == doctest::Approx(0));
      runs[goal["values"]["a"].get<double>()] = goal["runs"].get<std::size_t>();
    } else {
      CHECK(goal["runs"] == 0);
    }
  }
  CHECK(runs == std::map<double, std::size_t>{{-1, 8}, {1, 4}});
  CHECK(contains(expect(0, folder, with(words, {"--basins", "1e-3"})).out, "8 runs at a = -1 phi = 0 (stable)"));
  CHECK(document(folder, with(words, {"--basins", "1e-3", "--t-end", "0.1"}))["basins"]["elsewhere"].get<int>() >= 8);
  const std::string reply = expect(2, folder, {"sweep", "wells.toml", "--grid", "c=1,2", "--basins", "1e-3"}).err;
  CHECK(contains(reply, "these move with 'c'"));
}

TEST_CASE("sweep: features without support in an ensemble are reported") {
  const Folder folder;
  const auto refused = [&](const Words& more, const std::string& what) {
    CAPTURE(what);
    const std::string reply = expect(2, folder, with(with({"sweep"}, more), {"--ensemble"})).err;
    CHECK(contains(reply, what));
  };
  refused({"stick_slip_belt", "--grid", "m=1,2"}, "contacts with friction");
  refused({"bouncing_ball", "--grid", "m=1,2"}, "cannot be made side by side");
  refused({"R1_free_body", "--grid", "m=1,2"}, "cannot be made side by side");
  folder.write("morse.toml",
               "format = 1\n[parameters]\nD = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = "
               "\"D*(1 - exp(-x))^2\"\n[scene.default]\nt = [0, 1]\ninitial = { x = 1 }\n");
  refused({"morse.toml", "--grid", "D=1,2"}, "a force that is narrow");
}

namespace {

std::vector<double> column(const std::string& table, const std::string& name) {
  const std::vector<Words> lines = rows(table);
  const auto place = static_cast<std::size_t>(std::find(lines[1].begin(), lines[1].end(), name) - lines[1].begin());
  std::vector<double> values;
  for (std::size_t i = 2; i < lines.size(); ++i) values.push_back(std::stod(lines[i].at(place)));
  return values;
}

/// Number of parts out of `parts` equal parts of [0, 1) that contain exactly one value.
std::size_t count_parts_with_one_value(const std::vector<double>& values, std::size_t parts) {
  std::vector<int> held(parts);
  for (const double value : values) ++held[static_cast<std::size_t>(value * static_cast<double>(parts))];
  return static_cast<std::size_t>(std::count(held.begin(), held.end(), 1));
}

}  // namespace

TEST_CASE("sweep: samples follow their design and the seed, and are combined with every point of the grid") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const auto table = [&](const Words& more) {
    Words words{"sweep", "oscillator.toml", "--solver", "rk4",   "--step",   "0.5",   "--no-error-estimate",
                "--out", "s.csv",           "--sample", "m=1:2", "--sample", "k=0:1", "--samples",
                "64"};
    expect(0, folder, with(words, more));
    return folder.read("s.csv");
  };
  for (const char* design : {"random", "latin", "sobol"}) {
    CAPTURE(std::string(design));
    const std::string text = table({"--design", design}), again = table({"--design", design, "--jobs", "2"}),
                      other = table({"--design", design, "--seed", "7"});
    CHECK(text == again);
    CHECK(text != other);
    std::vector<double> m = column(text, "m"), k = column(text, "k");
    REQUIRE(m.size() == 64);
    for (double& value : m) value -= 1;
    const bool even = std::string(design) != "random";
    CHECK((count_parts_with_one_value(m, 64) == 64) == even);
    CHECK((count_parts_with_one_value(k, 64) == 64) == even);
    if (std::string(design) != "sobol") continue;
    std::vector<double> squares;  // 8 by 8 squares: a net has one point in each
    for (std::size_t i = 0; i < 64; ++i) squares.push_back((std::floor(8 * m[i]) + std::floor(8 * k[i]) / 8) / 8);
    CHECK(count_parts_with_one_value(squares, 64) == 64);
  }
  expect(0, folder,
         {"sweep", "oscillator.toml", "--grid", "m=1,2,3", "--sample", "k=1:100:log", "--samples", "5", "--out",
          "both.csv"});
  const std::vector<double> k = column(folder.read("both.csv"), "k"), m = column(folder.read("both.csv"), "m");
  REQUIRE(k.size() == 15);
  for (std::size_t i = 0; i < 15; ++i) {
    CHECK(m[i] == 1 + static_cast<double>(i / 5));
    CHECK(k[i] == k[i % 5]);
    CHECK((k[i] >= 1 && k[i] < 100));
  }
  expect(0, folder,
         {"sweep", "oscillator.toml", "--sample", "k=1e-200:1e-190:log", "--samples", "5", "--t-end", "0", "--out",
          "small.csv"});
  for (const double small : column(folder.read("small.csv"), "k")) CHECK((small >= 1e-200 && small < 1e-190));
}

TEST_CASE("sweep: Sobol' points fill every axis of ten evenly") {
  const Folder folder;
  std::string model = "format = 1\n[parameters]\n";
  Words words{"sweep", "many.toml", "--solver",  "rk4", "--step",   "1",    "--no-error-estimate",
              "--out", "s.csv",     "--samples", "128", "--design", "sobol"};
  for (int i = 0; i < 10; ++i) {
    model += "a" + std::to_string(i) + " = 1\n";
    words.insert(words.end(), {"--sample", "a" + std::to_string(i) + "=0:1"});
  }
  folder.write("many.toml",
               model + "[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n[scene.default]\nt = [0, 1]\n");
  expect(0, folder, words);
  const std::string text = folder.read("s.csv");
  std::vector<std::vector<double>> axes;
  for (int i = 0; i < 10; ++i) {
    axes.push_back(column(text, "a" + std::to_string(i)));
    CHECK(count_parts_with_one_value(axes.back(), 128) == 128);
    for (int j = 0; j < i; ++j) CHECK(axes[static_cast<std::size_t>(j)] != axes.back());
  }
  words.insert(words.end(), {"--sample", "b=0:1"});
  CHECK(contains(expect(2, folder, words).err, "at most 10 parameters"));
}

TEST_CASE("sweep: statistics agree with the columns of the table") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Json found = document(folder, {"sweep", "oscillator.toml", "--sample", "m=10:2:normal", "--samples", "400",
                                       "--design", "latin", "--t-end", "0", "--statistics", "--grid", "k=1,-1"});
  const auto of = [&](const std::string& name) {
    for (const Json& column : found["statistics"]) {
      if (column["column"] == name) return column;
    }
    return Json();
  };
  CHECK(of("x")["count"] == 800);
  CHECK(of("x")["mean"] == 1);
  CHECK(of("x")["deviation"] == 0);
  CHECK(of("energy")["mean"].get<double>() == 0);  // k/2 with both signs
  CHECK(of("energy")["min"] == -0.5);
  CHECK(of("energy")["max"] == 0.5);
  CHECK(of("energy")["deviation"].get<double>() == doctest::Approx(0.5 * std::sqrt(800.0 / 799)).epsilon(1e-14));
  CHECK(of("energy")["quantiles"][0]["value"] == -0.5);
  CHECK(of("detail").is_null());
  // The samples are normal; a Latin hypercube reproduces their moments closely.
  std::vector<double> m = column(folder.read("oscillator_sweep.csv"), "m");
  double mean = 0, square = 0;
  for (const double value : m) mean += value / 800, square += (value - 10) * (value - 10) / 800;
  CHECK(std::abs(mean - 10) < 0.02);
  CHECK(std::abs(square - 4) < 0.2);
  std::sort(m.begin(), m.end());
  CHECK(std::abs(m[671] - 12) < 0.06);  // 84.1 % are below one standard deviation
}
