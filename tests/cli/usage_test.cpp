// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong words on the command line: exit code 2 before any work, and what to do instead.
#include <doctest/doctest.h>

#include "program.hpp"

using namespace eomgen::test;

namespace {

struct Wrong {
  Words words;
  std::string says, remedy;
};

void refuse(const std::vector<Wrong>& table) {
  const Folder folder;
  for (const Wrong& wrong : table) {
    const ChildResult result = expect(2, folder, wrong.words);
    CAPTURE(wrong.says);
    CAPTURE(result.err);
    CHECK(result.out.empty());
    CHECK(contains(result.err, wrong.says));
    CHECK(contains(result.err, "remedy: " + wrong.remedy));
    CHECK(result.seconds < 1.0);
  }
  CHECK(folder.names().empty());
}

const std::string P2 = "P2_planar_pendulum";

}  // namespace

TEST_CASE("commands and options that are not there: the nearest one is told") {
  refuse({
      {{}, "a command is missing", "eomgen --help"},
      {{"dervie", P2}, "there is no command 'dervie'", "did you mean 'derive'?"},
      {{"run"}, "MODEL is required", "eomgen run --help"},
      {{"emit", P2}, "-o is required", "eomgen emit --help"},
      {{"run", P2, "--rotl", "1e-3"}, "there is no option '--rotl'", "did you mean '--rtol'?"},
      {{"run", P2, "another"}, "'another' is one word too many", "eomgen run --help"},
      {{"check", P2, "--quick"}, "there is no option '--quick'", "eomgen check --help"},
  });
}

TEST_CASE("names that are not there: the nearest one is told") {
  refuse({
      {{"check", "P7"}, "P7: error: there is no such model file", "did you mean P7_moving_sphere?"},
      {{"check", "P2_planar_pendulums"}, "there is no such model file", "did you mean P2_planar_pendulum?"},
      {{"check", "nothing_like_it"}, "there is no such model file", "eomgen new NAME writes a starter model"},
      {{"check", "/"}, "/: error: this is a directory", "name a model file"},
      {{"check", ""}, "there is no such model file", "eomgen new NAME"},
      {{"run", P2, "--scene", "defualt"}, "there is no scene 'defualt'", "did you mean 'default'?"},
      {{"run", P2, "--solver", "dop835"}, "there is no solver 'dop835'", "did you mean 'dop853'?"},
      {{"run", P2, "--solver", "variational2"}, "solver 'variational2' takes steps of a fixed size, and none is given", "give --step H"},
      {{"run", P2, "--output", "enrgy"}, "there is no output 'enrgy'", "choose from: energy, "},
      {{"run", P2, "--set", "LL=1"}, "there is no parameter 'LL' to set", "did you mean 'L'?"},
      {{"run", P2, "--set", "nosuch=1"}, "there is no parameter 'nosuch' to set", "the parameters are m, g, L"},
      {{"run", P2, "--approach", "III"}, "there is no approach 'III'", "choose auto, I or II"},
      {{"emit", P2, "-o", "out", "--fix", "LL"}, "there is no parameter 'LL' to fix", "did you mean 'L'?"},
      {{"emit", P2, "-o", "out", "--with", "jacc"}, "there is no function 'jacc'", "did you mean 'jac'?"},
      {{"emit", P2, "-o", "out", "--with", "jac,rhs_batch"}, "the function rhs_batch is not supported yet", "choose from: jac"},
      {{"emit", P2, "-o", "out", "--target", "ccp"}, "there is no target 'ccp'", "did you mean 'cpp'?"},
      {{"emit", P2, "-o", "out", "--form", "multiplier"}, "there is no form 'multiplier'",
       "choose auto, multipliers, nullspace or chaplygin"},
      {{"emit", P2, "-o", "out", "--form", "routh"}, "form 'routh' is not supported yet", "choose auto"},
      {{"emit", P2, "-o", "out", "--form", "nullspace"},
       "form 'nullspace' is one of constraints that keep multipliers, and this model has none", "leave --form out"},
      {{"derive", P2, "--show", "equatons"}, "there is nothing called 'equatons' to show", "did you mean 'equations'?"},
      {{"derive", P2, "--show", "linear"}, "the linearised equations are not supported yet", "eomgen linearize"},
      {{"derive", P2, "--format", "tex"}, "there is no format 'tex'", "did you mean 'text'?"},
  });
}

TEST_CASE("values that cannot be are refused") {
  refuse({
      {{"run", P2, "--rtol", "-1"}, "--rtol: '-1' is not a number, 0 or greater", "eomgen run --help"},
      {{"run", P2, "--rtol", "nan"}, "--rtol: 'nan' is not a number", "eomgen run --help"},
      {{"run", P2, "--atol", "1e999"}, "--atol: '1e999' is not a number", "eomgen run --help"},
      {{"run", P2, "--rtol", "0", "--atol", "0"}, "tolerances must not be negative, nor both zero", "give rtol"},
      {{"run", P2, "--rtol", "1e-3x"}, "--rtol: '1e-3x' is not a number", "eomgen run --help"},
      {{"run", P2, "--step", "0"}, "--step: '0' is not a number greater than 0", "eomgen run --help"},
      {{"run", P2, "--every", "0"}, "--every: '0' is not a number greater than 0", "eomgen run --help"},
      {{"run", P2, "--t-end", "inf"}, "--t-end: 'inf' is not a number", "eomgen run --help"},
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

TEST_CASE("places that cannot be written to are told before any work is done") {
  refuse({
      {{"run", P2, "--out", "nowhere/a.csv"}, "--out nowhere/a.csv: there is no folder nowhere", "make the folder first"},
      {{"run", P2, "--out", "/"}, "this is a folder, not a file", "name a file in it"},
      {{"run", P2, "--plot", "nowhere/a.svg"}, "--plot nowhere/a.svg: there is no folder nowhere", "make the folder first"},
      {{"emit", P2, "-o", "/proc/nowhere"}, "cannot make the folder /proc/nowhere", "choose a folder that you may write to"},
  });
}

TEST_CASE("a list takes one word each time, so that MODEL may stand after it") {
  const Folder folder;
  const Json run = document(folder, {"run", "--set", "m=2", "--set", "L=4", "--output", "kinetic,potential", P2});
  CHECK(run["final"]["r"] == 4.0);
  CHECK(run["final"].contains("potential"));
  expect(0, folder, {"derive", "--show", "equations,metric", P2});
  expect(0, folder, {"emit", "--with", "jac", "--fix", "m", "-o", "out", P2});
}
