// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted code has only what is needed: requests and models that differ in one need differ in that symbol or operation.
#include <doctest/doctest.h>

#include <set>
#include <sstream>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// Callable functions and operations of the right-hand side of emitted code.
struct Emitted {
  std::set<std::string> functions;  // without NAME_
  std::string source;
  Json report;

  int operations() const {
    int sum = 0;
    for (const auto& [kind, count] : report["operations"].items()) sum += count.get<int>();
    return sum;
  }
  std::string function(const std::string& name) const {  // its text with that of its helper functions
    const std::size_t begin = source.find("_" + name + "_from(") != std::string::npos
                                  ? source.find("_" + name + "_from(")
                                  : source.find("_" + name + "(");
    return source.substr(begin, source.find("\n}\n", begin) - begin);
  }
};

Emitted emitted(const std::string& model, const Words& more = {}) {
  const Folder folder;
  Words words{"emit", model, "-o", ".", "--target", "c"};
  std::string name = model;
  if (contains(model, "\n")) {
    name = "model";
    folder.write("model.toml", model);
    words[1] = "model.toml";
  }
  words.insert(words.end(), more.begin(), more.end());
  Emitted result;
  result.report = document(folder, words);
  result.source = folder.read(name + ".c");
  REQUIRE(run_child({{"cc", "-std=c11", "-O2", "-c", name + ".c"}, folder.path()}).status == 0);
  const ChildResult symbols = run_child({{"nm", "-g", "--defined-only", name + ".o"}, folder.path()});
  REQUIRE(symbols.status == 0);
  std::istringstream lines(symbols.out);
  for (std::string address, type, symbol; lines >> address >> type >> symbol;) {
    REQUIRE(symbol.starts_with(name + "_"));
    result.functions.insert(symbol.substr(name.size() + 1));
  }
  return result;
}

using Names = std::set<std::string>;
Names joined(Names names, const Names& more) {
  names.insert(more.begin(), more.end());
  return names;
}

const Names always{"abi", "info", "defaults", "rhs", "selftest"};
const Names prepared{"prepare", "rhs_prepared"};

std::string cart(const std::string& input, const std::string& force) {
  return "format = 1\n[parameters]\nM = \"2 kg\"\nk = \"3 N/m\"\n" + input +
         "[coordinates]\ns = \"m\"\n[energy]\nkinetic = \"M/2*s_dot^2\"\npotential = \"k/2*s^2\"\n" + force +
         "[scene.default]\nt = [0, 1]\ninitial = { s = 1 }\n";
}

}  // namespace

TEST_CASE("needs: a requested function adds its symbol and does not change the right-hand side") {
  const Emitted bare = emitted("P7_moving_sphere");
  CHECK(bare.functions == joined(always, bare.report["hoisted"].is_null() ? Names{} : prepared));
  CHECK_FALSE(contains(bare.source, "lambda"));
  for (const auto& [words, function] : {std::pair<Words, std::string>{{"--with", "reactions"}, "reactions"},
                                        {{"--with", "jac"}, "jac"},
                                        {{"--with", "jac_p"}, "jac_p"},
                                        {{"--with", "jac_u"}, "jac_u"},
                                        {{"--with", "jvp"}, "jvp"},
                                        {{"--with", "vjp"}, "vjp"},
                                        {{"--with", "adjoint"}, "adjoint"},
                                        {{"--with", "hvp"}, "hvp"},
                                        {{"--with", "inverse"}, "inverse"},
                                        {{"--with", "regressor"}, "regressor"},
                                        {{"--with", "momentum"}, "momentum"},
                                        {{"--with", "coriolis"}, "coriolis"},
                                        {{"--with", "gravity"}, "gravity"},
                                        {{"--with", "mass"}, "mass"},
                                        {{"--with", "energy_gradients"}, "energy_gradients"},
                                        {{"--with", "frames"}, "frames"},
                                        {{"--with", "constraints"}, "constraints"},
                                        {{"--output", "energy"}, "outputs"}}) {
    const auto& shown = function;
    CAPTURE(shown);
    const Emitted more = emitted("P7_moving_sphere", words);
    CHECK(more.functions == joined(bare.functions, {function}));
    CHECK(more.function("rhs") == bare.function("rhs"));
    CHECK(more.report["operations"] == bare.report["operations"]);
  }
}

TEST_CASE("needs: derivatives of outputs and reactions come with their values") {
  const Emitted bare = emitted("P7_moving_sphere");
  const auto functions = [](const Words& words) { return emitted("P7_moving_sphere", words).functions; };
  for (const std::string suffix : {"", "_p", "_u"}) {
    CAPTURE(suffix);
    CHECK(functions({"--with", "reactions_jac" + suffix}) ==
          joined(bare.functions, {"reactions", "reactions_jac" + suffix}));
    CHECK(functions({"--with", "outputs_jac" + suffix, "--output", "energy"}) ==
          joined(bare.functions, {"outputs", "outputs_jac" + suffix}));
  }
}

TEST_CASE("needs: fixed parameters are not read, and expressions of them are numbers") {
  const Emitted open = emitted("S5_double_pendulum"), fixed = emitted("S5_double_pendulum", {"--fix", "m1,m2,L1,L2,g"});
  CHECK(open.functions == joined(always, prepared));
  CHECK(fixed.functions == always);  // no function `prepare` remains
  CHECK(fixed.operations() < open.operations());
  CHECK(contains(open.function("rhs"), " = p["));
  CHECK_FALSE(contains(fixed.function("rhs"), " = p["));
  CHECK(fixed.report["hoisted"].is_null());
}

TEST_CASE("needs: prepared values are not computed again") {
  const Emitted open = emitted("S5_double_pendulum");
  const auto cost = [](const Json& operations) {
    return operations["add"].get<int>() + operations["mul"].get<int>() + operations["div"].get<int>();
  };
  CHECK(cost(open.report["hoisted"]["rhs_prepared"]) < cost(open.report["operations"]));
  CHECK(cost(open.report["hoisted"]["prepare"]) > 0);
}

TEST_CASE("needs: without an input, none is read and its operation disappears") {
  const Emitted driven =
      emitted(cart("[inputs]\nF = { unit = \"N\", default = 0 }\n", "[[force]]\ngeneralized = { s = \"F\" }\n"));
  const Emitted free = emitted(cart("", ""));
  CHECK(driven.functions == free.functions);
  CHECK(contains(driven.function("rhs"), "u ? u[0]"));
  CHECK_FALSE(contains(free.function("rhs"), "u ?"));
  CHECK(driven.operations() == free.operations() + 1);
}

TEST_CASE("needs: singularity is tested only for charts that have one, and only before a division") {
  const Emitted spherical = emitted("G1_spherical"), cartesian = emitted("G1_cartesian");
  CHECK(contains(spherical.function("rhs"), "return 1;"));
  CHECK_FALSE(contains(cartesian.function("rhs"), "return 1;"));
  CHECK(cartesian.operations() == 0);  // a diagonal mass matrix of equal masses: no solve at all
}

TEST_CASE("needs: a kernel for sines is used for two angles, not for one") {
  const Emitted one = emitted("S6_chain_1"), two = emitted("S6_chain_2");
  CHECK_FALSE(contains(one.source, "sincos"));
  CHECK_FALSE(contains(one.source, "string.h"));
  CHECK(contains(two.source, "S6_chain_2_sincos("));
  CHECK(contains(one.function("rhs"), " sin("));
}

TEST_CASE("needs: second charts are in the code only on request, and never for a model without exchangeable charts") {
  const Emitted own = emitted("R1_free_body"), both = emitted("R1_free_body", {"--with", "charts"});
  CHECK_FALSE(contains(own.source, "chart"));
  CHECK(both.functions == joined(own.functions, {"chart"}));
  CHECK(both.report["operations"] == own.report["operations"]);  // of the first chart: nothing is added
  CHECK(contains(both.source, "own_rhs("));
  CHECK(contains(both.source, "chart1_rhs("));
  const std::string kernel = "static inline void R1_free_body_sincos_lanes(";
  CHECK(both.source.find(kernel) == both.source.rfind(kernel));  // used by both
  const Emitted mass = emitted("R1_free_body", {"--with", "charts,mass"});
  CHECK(mass.functions == joined(both.functions, {"mass", "mass_in"}));
  const Folder folder;
  const ChildResult refused =
      eomgen::test::eomgen(folder, {"emit", "R14_sliding_cylinder", "-o", ".", "--with", "charts"});
  CHECK(refused.status == 2);
  CHECK(contains(refused.err, "the coordinate 'psi' is named by constraint 'level'"));
  CHECK(contains(refused.err, "this model has no chart that can be exchanged"));
  CHECK_FALSE(contains(emitted("R14_sliding_cylinder").source, "chart"));
}
