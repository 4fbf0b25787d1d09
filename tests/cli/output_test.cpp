// SPDX-License-Identifier: GPL-3.0-or-later
// Output of results: protection of the model file, links and devices, reported sizes.
#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <utility>

#include "program.hpp"

using namespace eomgen::test;
namespace fs = std::filesystem;

namespace {

const char* const oscillator =
    "format = 1\n[parameters]\nm = 1\nk = 4\n[coordinates]\nx = {}\n"
    "[energy]\nkinetic = \"m*x_dot^2/2\"\npotential = \"k*x^2/2\"\n[scene.default]\nt = [0, 1]\ninitial = { x = 1 }\n";

/// Runs a shell, to test redirections.
ChildResult shell(const Folder& folder, const std::string& line) {
  ChildCommand call = command(folder, {});
  const std::string program = call.arguments.front();
  call.arguments = {"/bin/sh", "-c", line};
  call.environment["EOMGEN"] = program;
  return run_child(call);
}

}  // namespace

TEST_CASE("no option overwrites the model file, under any of its names") {
  const Folder folder;
  folder.write("p.toml", oscillator);
  fs::create_symlink("p.toml", folder / "link.csv");
  fs::create_hard_link(folder / "p.toml", folder / "hard.svg");
  for (const Words& words :
       {Words{"run", "p.toml", "--out", "link.csv"}, Words{"run", "p.toml", "-o", "./p.toml"},
        Words{"run", "p", "--plot", "hard.svg"}, Words{"run", "link.csv", "--out", "link.csv"},
        Words{"report", "p.toml", "-o", "p.toml"}, Words{"sweep", "p.toml", "--grid", "k=1,2", "--out", "link.csv"},
        Words{"inverse", "p.toml", "--out", "link.csv"}, Words{"bench", "p.toml", "--csv", "link.csv"},
        Words{"bench", "p.toml", "--svg", "hard.svg"}}) {
    const ChildResult result = expect(2, folder, words);
    CAPTURE(result.err);
    CHECK((contains(result.err, "this is the model's own file") || contains(result.err, "the name ends with toml")));
    CHECK(folder.read("p.toml") == oscillator);
  }
  folder.write("model.c", oscillator);
  const ChildResult emitted = expect(2, folder, {"emit", "model.c", "-o", "."});
  CHECK(contains(emitted.err, "model.c is the model's own file"));
  CHECK(folder.read("model.c") == oscillator);
  fs::create_symlink("nowhere", folder / "new.toml");
  CHECK(contains(expect(2, folder, {"new", "new"}).err, "this file exists already"));
}

TEST_CASE("links are followed, devices and pipes are written directly, - is standard output") {
  const Folder folder;
  folder.write("p.toml", oscillator);
  fs::create_directories(folder / "far");
  fs::create_symlink("far/table.csv", folder / "a.csv");
  expect(0, folder, {"run", "p.toml", "--out", "a.csv", "--plot", "a.svg"});
  CHECK(fs::is_symlink(folder / "a.csv"));
  const std::string table = folder.read("far/table.csv");
  CHECK(read_table(table).outcome == "done");
  for (const char* place : {"-", "/dev/stdout", "/dev/fd/1"}) {
    CAPTURE(place);
    const ChildResult result = expect(0, folder, {"run", "p.toml", "--out", place});
    CHECK(result.out == table);
    CHECK(contains(result.err, "outcome           done"));  // the report goes to standard error
    CHECK_FALSE(folder.has("-"));
  }
  CHECK(shell(folder, "$EOMGEN run p.toml --out /dev/stdout >to.csv 2>/dev/null").status == 0);
  CHECK(folder.read("to.csv") == table);
  CHECK(shell(folder, "mkfifo pipe; cat pipe >from.csv & $EOMGEN run p.toml --out pipe >/dev/null; wait").status == 0);
  CHECK(folder.read("from.csv") == table);
  CHECK(fs::is_fifo(folder / "pipe"));
  expect(0, folder, {"run", "p.toml", "--out", "/dev/null"});
  CHECK(fs::is_character_file("/dev/null"));
  const std::string drawn = expect(0, folder, {"run", "p.toml", "--plot", "-"}).out;  // as text, for a terminal
  CHECK(contains(drawn, "*"));
  CHECK_FALSE(contains(drawn, "<svg"));
  CHECK(expect(0, folder, {"run", "p.toml", "--plot", "/dev/stdout"}).out.starts_with("<svg"));
  CHECK(contains(expect(0, folder, {"report", "p.toml", "-o", "-"}).out, "<!DOCTYPE html>"));
  expect(0, folder, {"sweep", "p.toml", "--grid", "k=1,2", "--out", "s.csv"});
  CHECK(expect(0, folder, {"sweep", "p.toml", "--grid", "k=1,2", "--out", "-"}).out == folder.read("s.csv"));
  for (const std::string& name : folder.names()) CHECK_FALSE(contains(name, ".partial"));
}

TEST_CASE("invalid paths, and two results for one path, are refused before any work") {
  const Folder folder;
  folder.write("p.toml", oscillator);
  fs::create_symlink("a.csv", folder / "b.csv");
  const auto refused = [&](const Words& words, const std::string& what) {
    const ChildResult result = expect(2, folder, words);
    CAPTURE(result.err);
    CHECK(contains(result.err, what));
    CHECK(contains(result.err, "remedy: "));
  };
  refused({"run", "p.toml", "--out", "a.csv", "--plot", "a.csv"}, "--out writes to the same place");
  refused({"run", "p.toml", "--out", "a.out", "--plot", "./a.out"}, "--out writes to the same place");
  refused({"run", "p.toml", "--out", "-", "--plot", "-"}, "--out writes to the same place");
  refused({"run", "p.toml", "--out", "-", "--json"}, "standard output has the JSON document");
  refused({"run", "p.toml", "--out", ""}, "names no file");
  refused({"report", "p.toml", "--out", ""}, "names no file");
  refused({"run", "p.toml", "--out", "x.png"}, "this option writes csv, and the name ends with png");
  refused({"run", "p.toml", "--plot", "x.PS"}, "this option writes svg, png or pdf, and the name ends with ps");
  refused({"run", "p.toml", "--plot", "x.data"}, "this option writes svg, png or pdf, and the name ends with data");
  refused({"bench", "p.toml", "--plot", "x.eps"}, "this option writes svg, png or pdf, and the name ends with eps");
  refused({"stress", "p.toml", "--plot", "x.csv"}, "this option writes svg, png or pdf, and the name ends with csv");
  refused({"report", "p.toml", "-o", "x.pdf"}, "this option writes html, and the name ends with pdf");
  refused({"sweep", "p.toml", "--grid", "k=1,2", "-o", "x.json"}, "this option writes csv");
  refused({"bench", "p.toml", "--csv", "x.svg"}, "this option writes csv, and the name ends with svg");
  refused({"emit", "p.toml", "-o", "x.c"}, "a folder is required, and the name ends with c");
  refused({"emit", "p.toml", "--out", "p.toml"}, "this is a file, and a folder is asked");
  refused({"run", "p.toml", "--out", std::string(300, 'x')}, "at most 255");
  CHECK(folder.names() == Words{"b.csv", "p.toml"});
  expect(0, folder, {"run", "p.toml", "--out", "rows.out"});  // an extension without meaning
}

TEST_CASE("a model name of 240 letters works or is reported") {
  const Folder folder;
  const std::string name(240, 'n');
  folder.write(name + ".toml", oscillator);
  const ChildResult sweep =
      expect(2, folder, {"sweep", name + ".toml", "--grid", "k=1,2", "--out", "s.txt", "--set", "k=2"});
  CHECK(contains(sweep.err, "is varied, and has a value by --set"));
  expect(0, folder, {"sweep", name + ".toml", "--grid", "k=1,2"});
  CHECK(folder.has(name + "_sweep.csv"));
  folder.write(std::string(250, 'n') + ".toml", oscillator);
  const ChildResult longer = expect(2, folder, {"sweep", std::string(250, 'n') + ".toml", "--grid", "k=1,2"});
  CHECK(contains(longer.err, "the name has 260 bytes"));
  CHECK_FALSE(contains(longer.err, "internal"));
}

TEST_CASE("run: rows follow the steps, so that a table shows a swing of 16 s over an hour") {
  const Folder folder;
  folder.write("swing.toml",
               "format = 1\n[parameters]\ng = \"9.81 m/s^2\"\nL = \"63.6 m\"\n[coordinates]\ntheta = \"rad\"\n"
               "[[particle]]\nname = \"P\"\nmass = \"1 kg\"\nposition = [\"L*sin(theta)\", \"-L*cos(theta)\", 0]\n"
               "[[force]]\ngravity = \"-g*E2\"\n[scene.default]\nt = [0, 3600]\ninitial = { theta = 0.5 }\n");
  const auto table = [&](const Words& more) {
    Words words{"run", "swing.toml", "--out", "a.csv", "--no-error-estimate"};
    words.insert(words.end(), more.begin(), more.end());
    expect(0, folder, words);
    std::vector<std::pair<double, double>> rows;
    std::istringstream lines(folder.read("a.csv"));
    for (std::string line; std::getline(lines, line);) {
      double t = 0, theta = 0;
      if (std::sscanf(line.c_str(), "%lf,%lf", &t, &theta) == 2) rows.emplace_back(t, theta);
    }
    return rows;
  };
  const std::vector<std::pair<double, double>> rows = table({});
  std::size_t steep = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) steep += std::abs(rows[i].second - rows[i - 1].second) > 0.3 ? 1 : 0;
  CHECK(rows.size() > 3000);
  CHECK(rows.size() < 16010);
  CHECK(steep < 5);  // of an amplitude of 0.5, beyond the first steps
  CHECK(rows.back().first == 3600);
  CHECK(table({"--every", "7.2"}).size() == 501);
  CHECK(table({"--step", "0.5"}).size() == 501);
}

TEST_CASE("run reports files and sizes; large sizes are announced, or refused unless confirmed") {
  const Folder folder;
  folder.write("p.toml", oscillator);
  const ChildResult reply = expect(0, folder, {"run", "p.toml", "--out", "a.csv", "--plot", "a.svg"});
  CHECK(contains(reply.out, "wrote             a.csv (501 rows, "));
  CHECK(contains(reply.out, "wrote             a.svg ("));
  const Json run = document(folder, {"run", "p.toml", "--out", "a.csv", "--plot", "a.svg"});
  CHECK(run["files"][0]["path"] == "a.csv");
  CHECK(run["files"][0]["rows"] == 501);
  CHECK(run["files"][0]["bytes"] == folder.read("a.csv").size());
  CHECK(run["files"][1]["bytes"] == folder.read("a.svg").size());
  for (const Words& words : {Words{"run", "p.toml", "--out", "b.csv", "--every", "1e-9"},
                             Words{"run", "p.toml", "--plot", "b.svg", "--every", "1e-9"}}) {
    const ChildResult refused = expect(2, folder, words);
    CHECK(contains(refused.err, "asks for 1e+09 rows"));
    CHECK(contains(refused.err, "with --yes they are written"));
  }
  CHECK(contains(expect(2, folder, {"run", "p.toml", "--out", "b.csv", "--every", "1e-300", "--yes"}).err,
                 "lost in the rounding of t"));
  CHECK_FALSE(folder.has("b.csv"));
  const ChildResult many =
      expect(0, folder,
             {"run", "p.toml", "--out", "/dev/null", "--plot", "b.svg", "--every", "0.9e-6", "--no-error-estimate"});
  CHECK(contains(many.err, "asks for 1.11e+06 rows, about"));
  CHECK(fs::file_size(folder / "b.svg") < 30'000'000);  // a plot limits its points
}

TEST_CASE("a closed or full standard error loses only messages") {
  const Folder folder;
  std::string warned = oscillator;
  warned.insert(warned.find("[coordinates]"), "unused = 3\n");
  folder.write("p.toml", warned);
  CHECK(contains(expect(0, folder, {"check", "p.toml"}).err, "warning"));
  const std::string plain = expect(0, folder, {"check", "p.toml"}).out;
  for (const char* closed : {"2>&-", "2>/dev/full"}) {
    CAPTURE(closed);
    const ChildResult check = shell(folder, std::string("$EOMGEN check p.toml ") + closed);
    CHECK(check.status == 0);
    CHECK(check.out == plain);
    CHECK(shell(folder, std::string("$EOMGEN check nosuch ") + closed).status == 2);
    CHECK(shell(folder, std::string("$EOMGEN run p.toml --out a.csv ") + closed).status == 0);
    CHECK(read_table(folder.read("a.csv")).outcome == "done");  // and no warning in it
  }
  shell(folder, "{ sleep 0.3; $EOMGEN check p.toml >/dev/null; echo $? >code; } 2>&1 | true");  // without reader
  CHECK(folder.read("code") == "0\n");
  shell(folder, "{ sleep 0.3; $EOMGEN check p.toml 2>err; echo $? >code; } | true");
  CHECK(folder.read("code") == "4\n");
  CHECK(contains(folder.read("err"), "the program that reads standard output ended"));
  CHECK_FALSE(contains(folder.read("err"), "disk"));
  shell(folder, "{ sleep 0.3; $EOMGEN run p.toml --out - 2>err; echo $? >code; } | true");
  CHECK(folder.read("code") == "4\n");
  CHECK(contains(folder.read("err"), "let the program that reads it read to the end"));
  const ChildResult lost = shell(folder, "$EOMGEN check p.toml >&-");
  CHECK(lost.status == 4);
  CHECK(contains(lost.err, "standard output could not be written"));
  const ChildResult all = shell(folder, "$EOMGEN derive p.toml --show all --json >/dev/full");
  CHECK(all.status == 4);
  CHECK_FALSE(contains(all.err, "internal"));
}

TEST_CASE("a full disk is reported by every command that writes") {
  if (!fs::exists("/dev/full")) return;
  const Folder folder;
  folder.write("p.toml", oscillator);
  for (const Words& words :
       {Words{"run", "p.toml", "--out", "/dev/full"}, Words{"run", "p.toml", "--plot", "/dev/full"},
        Words{"report", "p.toml", "-o", "/dev/full"},
        Words{"sweep", "p.toml", "--grid", "k=1,2", "--out", "/dev/full"}}) {
    const ChildResult result = expect(4, folder, words);
    CAPTURE(result.err);
    CHECK(contains(result.err, "/dev/full"));
  }
}
