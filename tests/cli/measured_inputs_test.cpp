// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs as tables, written in the scene or in a CSV file beside the model, against closed forms.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// m x'' = F(t) with m = 1 kg, from rest at x = 0, until 1.5 s.
std::string cart(const std::string& input) {
  return "format = 1\n[parameters]\nm = \"1 kg\"\n[inputs]\nF = { unit = \"N\" }\n[[particle]]\nname = \"P\"\n"
         "mass = \"m\"\nposition = [\"x\", 0, 0]\n[coordinates]\nx = \"m\"\n[[force]]\non = \"P\"\nforce = \"F*E1\"\n"
         "[scene.default]\nt = [0, 1.5]\ninitial = { x = 0, x_dot = 0 }\ninputs = { F = " +
         input + " }\n";
}

/// Irregular times, in part before the start and after the end of the run.
const std::vector<double> stamps{-0.2, 0.1, 0.13, 0.7, 1.1, 1.2}, forces{1, 3, -8, 2, 2, -5};

std::string csv_text() {
  std::string text = "# from a load cell\r\n\r\nstamp; \"force, raw\" ;temperature\r\n";
  for (std::size_t k = 0; k < stamps.size(); ++k)
    text += std::to_string(1000 * stamps[k]) + "; " + std::to_string(1000 * forces[k]) + ";21.5\r\n";
  return text;
}

const std::string csv =
    "{ csv = \"cell.csv\", time = \"stamp\", value = \"force, raw\", time_unit = \"ms\", unit = "
    "\"mN\"";

double force_at(double t, bool linear) {
  if (t <= stamps.front()) return forces.front();
  std::size_t k = 0;
  while (k + 1 < stamps.size() && stamps[k + 1] <= t) ++k;
  if (!linear || k + 1 == stamps.size()) return forces[k];
  return forces[k] + (t - stamps[k]) / (stamps[k + 1] - stamps[k]) * (forces[k + 1] - forces[k]);
}

/// x and x' at 1.5 s: between two times F is linear, so that x is a cubic.
std::pair<double, double> closed_form(bool linear, double mass = 1) {
  double x = 0, v = 0, from = 0;
  std::vector<double> ends = stamps;
  ends.push_back(1.5);
  for (const double end : ends) {
    if (end <= 0) continue;
    const double h = end - from, before = force_at(from, linear) / mass,
                 after = linear ? force_at(end, true) / mass : before;
    x += v * h + h * h * (2 * before + after) / 6;
    v += h * (before + after) / 2;
    from = end;
  }
  return {x, v};
}

void check_closed_form(const Json& run, bool linear) {
  const auto [x, v] = closed_form(linear);
  CHECK(run["final"]["x"].get<double>() == doctest::Approx(x).epsilon(1e-13));
  CHECK(run["final"]["x_dot"].get<double>() == doctest::Approx(v).epsilon(1e-13));
}

/// The tolerance allows steps across several times of the table: the motion is exact only if steps end there.
const Words loose{"run", "model.toml", "--rtol", "0.1", "--atol", "0.1", "--no-error-estimate"};

}  // namespace

TEST_CASE("columns of a CSV file with units are an input, held or linear, and steps end at its times") {
  const Folder folder;
  folder.write("cell.csv", csv_text());
  for (const char* kind : {"", ", interpolation = \"hold\"", ", interpolation = \"linear\""}) {
    CAPTURE(std::string(kind));
    folder.write("model.toml", cart(csv + kind + " }"));
    const bool linear = contains(kind, "linear");
    check_closed_form(document(folder, loose), linear);
    for (const char* solver : {"dopri5", "radau5", "rodas"})
      check_closed_form(document(folder, with(loose, {"--solver", solver})), linear);
  }
}

TEST_CASE("a table in the scene may be linear") {
  const Folder folder;
  folder.write("model.toml", cart("{ t = [-0.2, 0.1, \"130 ms\", 0.7, 1.1, 1.2], value = [1, 3, -8, 2, 2, \"-5 N\"], "
                                  "interpolation = \"linear\" }"));
  check_closed_form(document(folder, loose), true);
  // The series of taylor holds inputs within a step.
  CHECK(contains(expect(2, folder, {"run", "model.toml", "--solver", "taylor"}).err, "an input varies continuously"));
  CHECK(contains(expect(2, folder, {"bench", "model.toml"}).err, "an input is a table with linear interpolation"));
}

TEST_CASE("the time column is t and the value column has the name of the input, unless the scene names others") {
  const Folder folder;
  std::filesystem::create_directory(folder / "data");
  folder.write("data/run1.csv", "t,F\n0,2\n0.5,4\n");
  folder.write("model.toml", cart("{ csv = \"data/run1.csv\" }"));
  CHECK(document(folder, loose)["final"]["x_dot"].get<double>() == doctest::Approx(5).epsilon(1e-13));
  // The folder is that of the model, whatever the current one is.
  const Folder elsewhere;
  CHECK(document(elsewhere, with({"run", folder / "model.toml"}, {"--no-error-estimate"}))["final"]["x_dot"]
            .get<double>() == doctest::Approx(5).epsilon(1e-13));
  CHECK(document(folder, with(loose, {"--set", "F=2"}))["final"]["x_dot"].get<double>() ==
        doctest::Approx(3).epsilon(1e-13));
}

TEST_CASE("sweep follows a CSV file, and another file is another sweep") {
  const Folder folder;
  folder.write("cell.csv", csv_text());
  folder.write("model.toml", cart(csv + ", interpolation = \"linear\" }"));
  const Words sweep{"sweep", "model.toml", "--grid", "m=1,2,4", "--out", "table.csv", "--rtol", "0.1", "--atol", "0.1"};
  document(folder, sweep);
  const std::string table = folder.read("table.csv");
  for (const double mass : {1.0, 2.0, 4.0}) {
    const std::string digits = fmt::format(",{:.15f}", closed_form(true, mass).first);
    CAPTURE(digits);
    CHECK(contains(table, digits.substr(0, digits.size() - 4)));  // not rounded
  }
  CHECK(document(folder, sweep)["resumed"] == 3);
  folder.write("cell.csv", csv_text() + "2000;1;21\n");
  CHECK(document(folder, sweep)["resumed"] == 0);
}

TEST_CASE("emit --with run: the rows of a CSV file are in the code") {
  const Folder folder;
  folder.write("cell.csv", "t,F\n0,5\n0.75,-3\n");
  folder.write("model.toml", cart("{ csv = \"cell.csv\" }"));
  expect(0, folder, {"emit", "model.toml", "-o", ".", "--target", "c", "--with", "run"});
  CHECK(contains(folder.read("model_run.hpp"), "problem.inputs = {{{}, {0.0, 0.75}, {5.0, -3.0}, {}}};"));
  folder.write("model.toml", cart("{ csv = \"cell.csv\", interpolation = \"linear\" }"));
  expect(0, folder, {"emit", "model.toml", "-o", ".", "--target", "c", "--with", "run"});
  CHECK(contains(folder.read("model_run.hpp"), "problem.inputs = {{{}, {0.0, 0.75}, {5.0, -3.0}, {}, true}};"));
}

TEST_CASE("errors in a CSV file are reported with file, line and column") {
  const Folder folder;
  folder.write("model.toml", cart("{ csv = \"cell.csv\" }"));
  const auto refused = [&](const std::string& text, const std::string& place, const std::string& what) {
    folder.write("cell.csv", text);
    const std::string error = expect(2, folder, {"check", "model.toml"}).err;
    CAPTURE(error);
    CHECK(contains(error, "cell.csv:" + place + "error: " + what));
    CHECK(error.find('\x1b') == std::string::npos);
  };
  refused("", " ", "the file is empty");
  refused("t,F\n# nothing\n", " ", "no line of the file has numbers");
  refused("t,G\n0,1\n", "1:1: ", "there is no column 'F'");
  refused("\n t,F,F\n0,1,2\n", "2:1: ", "there are two columns 'F'");
  refused("t,F\n0,1\n1\n", "3:1: ", "the line has 1 values, and 2 columns have names");
  refused("t,F\n0,1\n1, nan\n", "3:4: ", "'nan' is not a finite number");
  refused("t,F\n0,inf\n", "2:3: ", "'inf' is not a finite number");
  refused("t;F\n0;1,5\n", "2:3: ", "'1,5' is not a finite number");
  refused("t,F\n0,\x1b[31m\n", "2:3: ", "'?[31m' is not a finite number");
  refused("t,F\n0,1e999\n", "2:3: ", "'1e999' is not a finite number");
  refused("t,F\n0,\n", "2:3: ", "a value is missing");
  refused("F,t\n1,0.5\n2,0.25\n", "3:3: ", "'t' does not increase: it is 0.25 after 0.5");
  refused("F,t\n1,0.5\n2,0.5\n", "3:3: ", "'t' does not increase: it is 0.5 after 0.5");
  std::string rows = "t,F\n";
  for (int k = 0; k <= 100000; ++k) rows += std::to_string(k) + ",0\n";
  refused(rows, "100002:1: ", "the file has more than 100000 rows");
}

TEST_CASE("a path that leaves the model's folder, and a unit of another dimension, are refused in the model file") {
  const Folder folder, other;
  other.write("secret.csv", "t,F\n0,1\n");
  std::filesystem::create_directory(folder / "inner");
  folder.write("inner/here.csv", "t,F\n0,1\n");
  const auto refused = [&](const std::string& input, const std::string& what) {
    folder.write("inner/model.toml", cart(input));
    const std::string error = expect(2, folder, {"check", "inner/model.toml"}).err;
    CAPTURE(error);
    CHECK(contains(error, "inner/model.toml:18:"));
    CHECK(contains(error, what));
  };
  const std::string outside = "is not a path inside the model's folder";
  refused("{ csv = \"" + (other / "secret.csv") + "\" }", outside);
  refused("{ csv = \"../secret.csv\" }", outside);
  refused("{ csv = \"\" }", outside);
  refused("{ csv = \"there.csv\" }", "there is no file 'there.csv' in the model's folder");
  refused("{ csv = \".\" }", "there is no file '.' in the model's folder");
  refused("{ csv = \"here.csv\", unit = \"m\" }", "has no values in 'm'");
  refused("{ csv = \"here.csv\", time_unit = \"Hz\" }", "has no values in 'Hz'");
  refused("{ csv = \"here.csv\", t = [0] }", "has no key 't'");
  refused("{ csv = \"here.csv\", interpolation = \"cubic\" }", "there is no interpolation 'cubic'");
  folder.write("inner/large.csv", std::string((std::size_t{1} << 24) + 1, ' '));
  refused("{ csv = \"large.csv\" }", "has more than 16777216 bytes");
}

TEST_CASE("names of columns are no units: a model without units stays one") {
  const Folder folder;
  folder.write("cell.csv", "t [s],F [raw]\n0,2\n");
  folder.write("model.toml",
               "format = 1\n[inputs]\nF = {}\n[coordinates]\nx = {}\n[[particle]]\nname = \"P\"\nmass = 1\nposition = "
               "[\"x\", 0, "
               "0]\n[[force]]\non = \"P\"\nforce = \"F*E1\"\n[scene.default]\nt = [0, 1]\ninitial = { x "
               "= 0 }\ninputs = { F = { csv = \"cell.csv\", time = \"t [s]\", value = \"F [raw]\" } }\n");
  CHECK(document(folder, loose)["final"]["x"].get<double>() == doctest::Approx(1).epsilon(1e-13));
}
