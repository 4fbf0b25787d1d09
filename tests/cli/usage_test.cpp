// SPDX-License-Identifier: GPL-3.0-or-later
// Errors on the command line: exit code 2 before any work, with a remedy.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "program.hpp"

using namespace eomgen::test;

namespace {

struct UsageError {
  Words words;
  std::string expected_message, remedy;
};

void refuse(const std::vector<UsageError>& table) {
  const Folder folder;
  for (const UsageError& wrong : table) {
    const ChildResult result = expect(2, folder, wrong.words);
    CAPTURE(wrong.expected_message);
    CAPTURE(result.err);
    CHECK(result.out.empty());
    CHECK(contains(result.err, wrong.expected_message));
    CHECK(contains(result.err, "remedy: " + wrong.remedy));
    CHECK(result.seconds < 1.0);
  }
  CHECK(folder.names().empty());
}

const std::string P2 = "P2_planar_pendulum";

}  // namespace

TEST_CASE("unknown commands and options: the nearest one is suggested") {
  refuse({
      {{}, "a command is missing", "eomgen --help"},
      {{"dervie", P2}, "there is no command 'dervie'", "did you mean 'derive'?"},
      {{"run"}, "MODEL is required", "eomgen run --help"},
      {{"emit", P2}, "-o is required", "eomgen emit --help"},
      {{"run", P2, "--rotl", "1e-3"}, "there is no option '--rotl'", "did you mean '--rtol'?"},
      {{"run", P2, "another"}, "unexpected argument 'another'", "eomgen run --help"},
      {{"simulate", P2}, "there is no command 'simulate'", "did you mean 'run'?"},
      {{"Run", P2}, "there is no command 'Run'", "did you mean 'run'?"},
      {{"init", "p"}, "there is no command 'init'", "did you mean 'new'?"},
      {{"pendulum.toml"},
       "a command is missing before 'pendulum.toml'",
       "eomgen check pendulum.toml describes the model"},
      {{"run", P2, "-v"}, "there is no option '-v'", "did you mean 'eomgen --version'?"},
      {{"run", P2, "--version"}, "there is no option '--version'", "did you mean 'eomgen --version'?"},
      {{"run", P2, "-s", "x"}, "there is no option '-s'", "did you mean '--s"},
      {{"check", P2, "--quick"}, "there is no option '--quick'", "eomgen check --help"},
  });
}

TEST_CASE("unknown names: the nearest one is suggested") {
  refuse({
      {{"check", "P7"}, "P7: error: there is no such model file", "did you mean P7_moving_sphere?"},
      {{"check", "P2_planar_pendulums"}, "there is no such model file", "did you mean P2_planar_pendulum?"},
      {{"check", "nothing_like_it"}, "there is no such model file", "eomgen new NAME writes a starter model"},
      {{"check", "/"}, "/: error: this is a directory", "name a model file"},
      {{"check", ""}, "there is no such model file", "eomgen new NAME"},
      {{"run", P2, "--scene", "defualt"}, "there is no scene 'defualt'", "did you mean 'default'?"},
      {{"run", P2, "--solver", "dop835"}, "there is no solver 'dop835'", "did you mean 'dop853'?"},
      {{"run", P2, "--solver", "variational2"},
       "solver 'variational2' takes steps of a fixed size, and none is given",
       "give --step H"},
      {{"run", P2, "--output", "enrgy"}, "there is no output 'enrgy'", "choose from: energy, "},
      {{"run", P2, "--set", "LL=1"}, "there is no parameter 'LL' to set", "did you mean 'L'?"},
      {{"run", P2, "--set", "nosuch=1"}, "there is no parameter 'nosuch' to set", "the parameters are m, g, L"},
      {{"run", P2, "--approach", "III"}, "there is no approach 'III'", "did you mean 'II'? choose from: auto, I, II"},
      {{"emit", P2, "-o", "out", "--fix", "LL"}, "there is no parameter 'LL' to fix", "did you mean 'L'?"},
      {{"emit", P2, "-o", "out", "--with", "jacc"}, "there is no function 'jacc'", "did you mean 'jac'?"},
      {{"emit", P2, "-o", "out", "--with", "jac,rhs_batch"},
       "there is no function 'rhs_batch'",
       "--target batch writes batches of rhs"},
      {{"emit", P2, "-o", "out", "--target", "ccp"}, "there is no target 'ccp'", "did you mean 'cpp'?"},
      {{"emit", P2, "-o", "out", "--form", "multiplier"},
       "there is no form 'multiplier'",
       "did you mean 'multipliers'? choose from: auto, multipliers, nullspace, chaplygin"},
      {{"emit", P2, "-o", "out", "--form", "routh"}, "there is no form 'routh'", "choose from: auto"},
      {{"emit", P2, "-o", "out", "--form", "nullspace"},
       "form 'nullspace' needs constraints that keep multipliers, and this model has none",
       "leave --form out"},
      {{"derive", P2, "--show", "equatons"}, "there is nothing called 'equatons' to show", "did you mean 'equations'?"},
      {{"derive", P2, "--format", "tex"}, "there is no format 'tex'", "did you mean 'text'?"},
  });
}

TEST_CASE("invalid values are refused") {
  refuse({
      {{"run", P2, "--rtol", "-1"}, "--rtol: '-1' is not a number, 0 or greater", "eomgen run --help"},
      {{"run", P2, "--rtol", "nan"}, "--rtol: 'nan' is not a number", "eomgen run --help"},
      {{"run", P2, "--atol", "1e999"}, "--atol: '1e999' is not a number", "eomgen run --help"},
      {{"run", P2, "--rtol", "0", "--atol", "0"}, "tolerances must not be negative, nor both zero", "give rtol"},
      {{"run", P2, "--rtol", "1e-3x"}, "--rtol: '1e-3x' is not a number", "eomgen run --help"},
      {{"run", P2, "--step", "0"}, "--step: '0' is not a number greater than 0", "eomgen run --help"},
      {{"run", P2, "--every", "0"}, "--every: '0' is not a number greater than 0", "eomgen run --help"},
      {{"run", P2, "--t-end", "inf"}, "--t-end: 'inf' is not a number", "eomgen run --help"},
      {{"bench", P2, "--t-end", "0"}, "the run would end at t = 0, at its start", "give a later --t-end"},
      {{"run", P2, "--t-end", "0", "--sensitivity", "L"},
       "there are no derivatives of the end",
       "give a later --t-end"},
      {{"run", P2, "--t-end", "-1"}, "the run would end at t = -1, before its start at t = 0", "give a later --t-end"},
      {{"run", P2, "--solver", "rk4", "--out", "a.csv"}, "solver 'rk4' takes steps of a fixed size", "give --step H"},
      {{"run", P2, "--set", "m=abc"}, "'m=abc' has no decimal number", "write it as 9.81"},
      {{"run", P2, "--set", "m=1e999"}, "'m=1e999' has no decimal number", "write it as 9.81"},
      {{"run", P2, "--set", "m"}, "'m' sets nothing", "write --set NAME=VALUE"},
      {{"run", P2, "--set", "=2"}, "'=2' sets nothing", "write --set NAME=VALUE"},
      {{"run", P2, "--set", "m=0"}, "the mass of 'P' is 0 here", "a mass is greater than 0"},
      {{"run", P2, "--set", "L=-1"}, "'L' is declared positive", "give it a positive value"},
      {{"run", P2, "--seed", "-1"}, "--seed: '-1' is not a whole number", "eomgen run --help"},
      {{"verify", P2, "--digits", "5"}, "--digits: '5' is not a whole number from 20 to 300", "eomgen verify --help"},
      {{"verify", P2, "--points", "0"}, "--points: '0' is not a whole number from 1 to", "eomgen verify --help"},
      {{"verify", P2, "--points", "2.5"}, "--points: '2.5' is not a whole number", "eomgen verify --help"},
  });
}

TEST_CASE("unwritable paths are reported before any work") {
  refuse({
      {{"run", P2, "--out", "nowhere/a.csv"},
       "--out nowhere/a.csv: there is no folder nowhere",
       "make the folder first"},
      {{"run", P2, "--out", "/"}, "this is a folder, not a file", "name a file in it"},
      {{"run", P2, "--plot", "nowhere/a.svg"},
       "--plot nowhere/a.svg: there is no folder nowhere",
       "make the folder first"},
      {{"emit", P2, "-o", "/proc/nowhere"},
       "cannot make the folder /proc/nowhere",
       "choose a folder that you may write to"},
  });
}

TEST_CASE("a list option takes one word each time, so MODEL may follow it") {
  const Folder folder;
  const Json run = document(folder, {"run", "--set", "m=2", "--set", "L=4", "--output", "kinetic,potential", P2});
  CHECK(run["final"]["r"] == 4.0);
  CHECK(run["final"].contains("potential"));
  expect(0, folder, {"derive", "--show", "equations,metric", P2});
  expect(0, folder, {"emit", "--with", "jac", "--fix", "m", "-o", "out", P2});
}

TEST_CASE("help: three examples, new first, and the path of the documentation; help is a command too") {
  const Folder folder;
  const std::string help = expect(0, folder, {"--help"}).out;
  CHECK(help.starts_with("Examples:\n  eomgen new "));
  const std::size_t examples = help.substr(0, help.find("\n\n")).size();
  CHECK(std::count(help.begin(), help.begin() + static_cast<std::ptrdiff_t>(examples), '\n') == 3);
  CHECK(expect(0, folder, {"help"}).out == help);
  CHECK(expect(0, folder, {"help", "run"}).out == expect(0, folder, {"run", "--help"}).out);
  CHECK(contains(expect(2, folder, {"help", "simulate"}).err, "did you mean 'run'?"));
  const std::size_t at = help.find("Documentation: ") + 15;
  const std::string page = help.substr(at, help.find(';', at) - at);
  CHECK(page.ends_with("/commands.md"));
  CHECK(std::filesystem::is_regular_file(page));
}

TEST_CASE("a file name one letter away is suggested; messages name the page of the documentation") {
  const Folder folder;
  folder.write("pendulum.toml", pendulum_text(""));
  for (const char* typed : {"pendulum.tml", "pendulun.toml", "pendulun", "Pendulum.toml", "./pendulm.toml"}) {
    CAPTURE(typed);
    const ChildResult result = expect(2, folder, {"run", typed});
    CHECK(contains(result.err, "did you mean "));
    CHECK(contains(result.err, "pendulum.toml?"));
  }
  folder.write("none.toml", "format = \n");
  const std::string reply = expect(2, folder, {"check", "none.toml"}).err;
  const std::size_t begin = reply.find("docs/model-format.md is ") + 24;
  CHECK(std::filesystem::is_regular_file(reply.substr(begin, reply.find('\n', begin) - begin)));
}

TEST_CASE("-o and --out are the same option in every command that writes") {
  const Folder folder;
  folder.write("p.toml", pendulum_text("[scene.default]\nt = [0, 0.1]\ninitial = { x = 1, y = 0, x_dot = 0 }\n"));
  for (const char* option : {"-o", "--out"}) {
    CAPTURE(option);
    expect(0, folder, {"run", "p.toml", option, "run.csv"});
    expect(0, folder, {"sweep", "p.toml", "--grid", "m=1,2", option, "sweep.csv"});
    expect(0, folder, {"report", "p.toml", option, "page.html"});
    expect(0, folder, {"emit", "p.toml", option, "code", "--target", "c"});
    CHECK(folder.names() == Words{"code", "p.toml", "page.html", "run.csv", "sweep.csv"});
    for (const char* made : {"code", "page.html", "run.csv", "sweep.csv"}) std::filesystem::remove_all(folder / made);
  }
  CHECK(expect(0, folder, {"emit", "p.toml", "--print-name"}).out == "p\n");
  CHECK(folder.names() == Words{"p.toml"});
}

TEST_CASE("emit: --print-name prints the name of the files for every target; --help and messages list all targets") {
  const Folder folder;
  const Json targets = document(folder, {"list"})["targets"];
  const std::string help = expect(0, folder, {"emit", "--help"}).out;
  REQUIRE(targets.size() >= 6);
  for (const char* id : {"p", "numpy", "Math"}) {
    const std::string file = std::string(id) + ".toml";
    folder.write(file, pendulum_text("[scene.default]\nt = [0, 0.1]\ninitial = { x = 1, y = 0, x_dot = 0 }\n"));
    for (const Json& target : targets) {
      const std::string target_name = target["name"];
      CAPTURE(id);
      CAPTURE(target_name);
      CHECK(contains(help, target_name));
      std::string reply = expect(0, folder, {"emit", file, "--target", target_name, "--print-name"}).out;
      REQUIRE(reply.ends_with('\n'));
      reply.pop_back();
      const Json files = document(folder, {"emit", file, "--target", target_name, "-o", target_name})["files"];
      CHECK(std::any_of(files.begin(), files.end(), [&](const Json& written) {
        return std::filesystem::path(written.get<std::string>()).stem() == reply;
      }));
    }
  }
  const ChildResult wrong = expect(2, folder, {"emit", "p.toml", "--target", "cobol", "--print-name"});
  CHECK(contains(wrong.err, "there is no target 'cobol'"));
  for (const Json& target : targets) CHECK(contains(wrong.err, target["name"].get<std::string>()));
}

TEST_CASE("a run of zero length gives the state, accelerations and reactions at the start") {
  const Folder folder;
  folder.write("p.toml",
               pendulum_text("[scene.default]\nt = [2, 3]\ninitial = { x = 0, y = -1, x_dot = 3, y_dot = 0 }\n"));
  const Json run = document(folder, {"run", "p.toml", "--t-end", "2", "--out", "a.csv"});
  CHECK(run["outcome"] == "done");
  CHECK(run["t"] == 2.0);
  CHECK(run["steps"] == 0);
  CHECK(run["final"]["x_dot"] == 3.0);
  CHECK(run["final"]["y_ddot"].get<double>() == doctest::Approx(9).epsilon(1e-14));  // v^2/L
  CHECK(run["final"]["x_ddot"].get<double>() == doctest::Approx(0));
  CHECK(2 * std::abs(run["final"]["reaction.rod"].get<double>()) == doctest::Approx(9.81 + 9).epsilon(1e-14));
  CHECK(read_table(folder.read("a.csv")).rows.size() == 1);
  CHECK(contains(expect(0, folder, {"run", "p.toml", "--t-end", "2"}).out, "y_ddot"));
  // Also at the poles of an exchanged chart, and for a coordinate fixed by a constraint.
  const Json fixed = document(folder, {"run", "P7_moving_sphere", "--t-end", "0"});
  CHECK(fixed["final"]["R_ddot"].get<double>() == doctest::Approx(0));  // d0 + a sin(w t)
  expect(0, folder, {"run", "R1_free_body", "--t-end", "0"});
  expect(0, folder, {"run", "P4_rough_cone", "--t-end", "0"});
}

TEST_CASE("accelerations are outputs like any other") {
  const Folder folder;
  folder.write(
      "p.toml",
      pendulum_text(
          "[scene.default]\nt = [0, 1]\ninitial = { x = 1, y = 0, x_dot = 0 }\noutputs = [\"y_ddot\", \"x_ddot\"]\n"));
  const Json run = document(folder, {"run", "p.toml", "--out", "a.csv", "--every", "0.001", "--rtol", "1e-11"});
  const Table table = read_table(folder.read("a.csv"));
  CHECK(table.at(0, "y_ddot") == doctest::Approx(-9.81));
  CHECK(table.at(table.rows.size() - 1, "x_ddot") == run["final"]["x_ddot"].get<double>());
  for (std::size_t i = 1; i + 1 < table.rows.size(); i += 50) {  // against differences of the rates
    const double by_rates = (table.at(i + 1, "x_dot") - table.at(i - 1, "x_dot")) / 0.002;
    CHECK(table.at(i, "x_ddot") == doctest::Approx(by_rates).epsilon(1e-4));
  }
  CHECK(document(folder, {"run", "p.toml", "--output", "y_ddot"})["final"].contains("y_ddot"));
  CHECK(contains(expect(2, folder, {"run", "p.toml", "--output", "z_ddot"}).err, "there is no output 'z_ddot'"));
  expect(0, folder, {"emit", "p.toml", "-o", "code", "--output", "x_ddot"});
  CHECK(document(folder, {"run", "R1_free_body", "--output", "all", "--t-end", "0.1"})["outcome"] == "done");
}

TEST_CASE("a scene without initial values reports where it starts") {
  const Folder folder;
  folder.write("free.toml",
               "format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = \"-x\"\n");
  CHECK(contains(expect(0, folder, {"run", "free.toml"}).out,
                 "no initial values: all coordinates and rates start at 0\n"));
}

TEST_CASE("check lists inputs; --set gives an input a constant value, in runs and equilibria") {
  const Folder folder;
  folder.write("cart.toml",
               "format = 1\n[parameters]\nm = \"1 kg\"\n[inputs]\nF = { unit = \"N\", default = 2 }\nG = { unit = "
               "\"N\" }\n[coordinates]\nx = \"m\"\n"
               "[energy]\nkinetic = \"m*x_dot^2/2\"\npotential = \"0\"\n[[force]]\ngeneralized = { x = \"F + G\" }\n");
  const Json found = document(folder, {"check", "cart.toml"});
  REQUIRE(found["inputs"].size() == 2);
  CHECK(found["inputs"][0] == Json({{"name", "F"}, {"unit", "N"}, {"default", "2"}}));
  CHECK(found["inputs"][1]["default"] == "0");
  CHECK(contains(expect(0, folder, {"check", "cart.toml"}).out, "inputs\n  F "));
  // x = (F + G) t^2/2, with F = 2 without --set.
  const auto end = [&](const Words& set) {
    Words words{"run", "cart.toml", "--t-end", "2"};
    words.insert(words.end(), set.begin(), set.end());
    return document(folder, words)["final"]["x"].get<double>();
  };
  CHECK(std::abs(end({}) - 4) < 1e-9);
  CHECK(std::abs(end({"--set", "F=3"}) - 6) < 1e-9);
  CHECK(std::abs(end({"--set", "F=1kN", "--set", "G=-1000"})) < 1e-9);
  CHECK(contains(expect(2, folder, {"run", "cart.toml", "--set", "F=3kg"}).err, "'F' is set in kg"));
  CHECK(contains(expect(2, folder, {"run", "cart.toml", "--set", "H=3"}).err, "there is no parameter 'H' to set"));
  CHECK_FALSE(document(folder, {"equilibria", "cart.toml", "--set", "G=-2"})["points"].empty());
}

TEST_CASE("report: plots fit a hundred coordinates, and the page stays below 1 MB") {
  const Folder folder;
  std::string text = "format = 1\n[coordinates]\n", kinetic = "0", potential = "0", start;
  for (int k = 1; k <= 100; ++k) {
    const std::string x = "x" + std::to_string(k);
    text += x + " = {}\n";
    kinetic += " + " + x + "_dot^2/2";
    potential += " + " + std::to_string(k) + "*" + x + "^2/2";
    start += (k > 1 ? ", " : "") + x + " = " + std::to_string(k / 7.0);
  }
  folder.write("many.toml", text + "[energy]\nkinetic = \"" + kinetic + "\"\npotential = \"" + potential +
                                "\"\n[scene.default]\nt = [0, 3]\ninitial = { " + start + " }\n");
  for (const Words& words : {Words{"report", "many.toml"}, Words{"run", "many.toml", "--plot", "a.svg"}}) {
    ChildCommand call = command(folder, words);
    call.limit = 120;
    const ChildResult result = run_child(call);
    CAPTURE(result.err);
    CHECK(result.status == 0);
  }
  CHECK(contains(folder.read("a.svg"), "x100"));
  CHECK(folder.read("report.html").size() < 1000000);
}

TEST_CASE("a constraint without real solution is reported as such") {
  const Folder folder;
  std::string text = pendulum_text("");
  text.replace(text.find("x^2 + y^2 - L^2"), 15, "x^2 + y^2 + L^2");
  folder.write("none.toml", text);
  const std::string reply = expect(2, folder, {"run", "none.toml"}).err;
  CHECK(contains(reply, "the start breaks constraint 'rod'"));
  CHECK(contains(reply, "no real solution"));
  CHECK_FALSE(contains(reply, "fix  by itself"));
  text.replace(text.find("x^2 + y^2 + L^2"), 15, "(y + L)^2");
  folder.write("square.toml", text);
  CHECK(contains(expect(2, folder, {"check", "square.toml"}).err, "write \"y + L\""));
}
