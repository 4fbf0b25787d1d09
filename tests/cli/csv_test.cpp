// SPDX-License-Identifier: GPL-3.0-or-later
// The table written by --out.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <sstream>

#include "program.hpp"

using namespace eomgen::test;

TEST_CASE("columns: t, every coordinate and its rate in declared order, then the requested outputs") {
  const Folder folder;
  expect(0, folder, {"run", "P7_moving_sphere", "--out", "a.csv"});
  const Table table = read_table(folder.read("a.csv"));
  CHECK(table.columns == Words{"t", "R", "R_dot", "phi", "phi_dot", "theta", "theta_dot", "energy", "reaction.sphere"});
  CHECK(table.outcome == "done");
  CHECK(table.rows.front()[0] == 0);
  CHECK(table.rows.back()[0] == 10);
  // The eliminated coordinate is the function of time given by the constraint.
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    CHECK(table.at(i, "R") == doctest::Approx(1 + 0.1 * std::sin(2 * table.rows[i][0])).epsilon(1e-15));
    CHECK(table.at(i, "R_dot") == doctest::Approx(0.2 * std::cos(2 * table.rows[i][0])).epsilon(1e-15));
  }
  expect(0, folder, {"run", "P7_moving_sphere", "--out", "a.csv", "--output", "potential,theta,kinetic,energy"});
  CHECK(read_table(folder.read("a.csv")).columns ==
        Words{"t", "R", "R_dot", "phi", "phi_dot", "theta", "theta_dot", "potential", "kinetic", "energy"});
  expect(0, folder, {"run", "P7_moving_sphere", "--out", "a.csv", "--output", "all"});
  CHECK(read_table(folder.read("a.csv")).columns.size() > 12);
  CHECK(folder.names() == Words{"a.csv"});
}

TEST_CASE("numbers have 17 significant digits: the table has the exact values of the run") {
  const Folder folder;
  const Json run = document(folder, {"run", "S5_double_pendulum", "--out", "a.csv"});
  const std::string text = folder.read("a.csv");
  const Table table = read_table(text);
  for (const auto& [name, value] : run["final"].items()) {
    if (std::find(table.columns.begin(), table.columns.end(), name) == table.columns.end()) continue;
    CHECK(table.at(table.rows.size() - 1, name) == value.get<double>());
  }
  std::istringstream lines(text);
  std::string line, cell;
  std::getline(lines, line);
  for (int k = 0; std::getline(lines, line) && line[0] != '#'; ++k) {
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) {
      char again[40];
      std::snprintf(again, sizeof again, "%.17g", std::strtod(cell.c_str(), nullptr));
      if (cell != again) FAIL_CHECK(cell << " is not " << again);
    }
  }
}

TEST_CASE("rows: from t0 to t1 every DT, and the end even if it is off the grid") {
  const Folder folder;
  expect(0, folder, {"run", "P2_planar_pendulum", "--out", "a.csv", "--every", "0.3", "--t-end", "1"});
  const Table table = read_table(folder.read("a.csv"));
  REQUIRE(table.rows.size() == 5);
  for (std::size_t i = 0; i < 4; ++i) CHECK(table.rows[i][0] == static_cast<double>(i) * 0.3);
  CHECK(table.rows[4][0] == 1);
  // With an interval longer than the run, both ends remain.
  expect(0, folder, {"run", "P2_planar_pendulum", "--out", "a.csv", "--every", "50", "--t-end", "1"});
  CHECK(read_table(folder.read("a.csv")).rows.size() == 2);
  folder.write("late.toml", pendulum_text("[scene.default]\nt = [5, 6]\ninitial = { x = 1, y = 0, x_dot = 0 }\n"));
  expect(0, folder, {"run", "late.toml", "--out", "b.csv", "--every", "0.25"});
  const Table late = read_table(folder.read("b.csv"));
  REQUIRE(late.rows.size() == 5);
  CHECK(late.rows.front()[0] == 5);
  CHECK(late.rows.back()[0] == 6);
}

TEST_CASE("rows between steps are as accurate as those at their ends, and satisfy the constraint") {
  const Folder folder;
  folder.write(
      "rod.toml",
      pendulum_text("[scene.default]\nt = [0, 4]\ninitial = { x = 1, y = 0, x_dot = 0 }\noutputs = [\"energy\"]\n"));
  expect(0, folder, {"run", "rod.toml", "--out", "a.csv", "--every", "0.01"});
  const Table table = read_table(folder.read("a.csv"));
  CHECK(table.rows.size() == 401);
  double psi = 0, energy = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    psi = std::max(psi, std::abs(std::hypot(table.at(i, "x"), table.at(i, "y")) - 1));
    energy = std::max(energy, std::abs(table.at(i, "energy")));  // it starts at rest at the height of the pivot
  }
  CHECK(psi < 1e-6);
  CHECK(energy < 1e-5);
}

TEST_CASE("an existing table is replaced when the new one is complete") {
  const Folder folder;
  folder.write("a.csv", "old");
  expect(2, folder, {"run", "P2_planar_pendulum", "--out", "a.csv", "--scene", "nosuch"});
  CHECK(folder.read("a.csv") == "old");
  expect(0, folder, {"run", "P2_planar_pendulum", "--out", "a.csv"});
  CHECK(folder.read("a.csv").starts_with("t,r,r_dot,"));
  CHECK(folder.names() == Words{"a.csv"});
}

TEST_CASE("a plot is one SVG, and the table is the same as without it") {
  const Folder folder;
  expect(0, folder, {"run", "P2_planar_pendulum", "--out", "a.csv"});
  expect(0, folder, {"run", "P2_planar_pendulum", "--out", "b.csv", "--plot", "b.svg"});
  CHECK(folder.read("a.csv") == folder.read("b.csv"));
  CHECK(contains(folder.read("b.svg"), "<svg"));
  CHECK(contains(folder.read("b.svg"), "theta"));
}
