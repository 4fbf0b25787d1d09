// SPDX-License-Identifier: GPL-3.0-or-later
// Target casadi: its functions called by their interface (casadi_harness.c), without CasADi.
#include <doctest/doctest.h>

#include "emit/examples.hpp"
#include "emit/single_precision.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

/// Compiles the sources with the harness and runs it; the output if something is wrong.
std::string failure(const Example& e, bool derivatives) {
  const Folder folder;
  emit::write_files(folder.path, emit::emit(e.program, e.context, "casadi"));
  const std::string name = emit::mangled_id(e.context.id), path = folder.path + "/" + name;
  std::string said =
      compiler_diagnostics({EOMGEN_TEST_CC, "-std=c11", "-O1", "-c", "-o", folder.path + "/c.o"}, {path + "_casadi.c"});
  if (said.empty())
    said = compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-x", "c++", "-c", "-o", folder.path + "/cpp.o"},
                                {path + "_casadi.c"});
  if (!said.empty()) return said;
  std::vector<std::string> command{EOMGEN_TEST_CC,
                                   "-std=c11",
                                   "-g",
                                   "-fsanitize=address,undefined",
                                   "-DMODEL=" + name + "_ode",
                                   "-DSCENE=" + name + "_scene",
                                   "-o",
                                   folder.path + "/use",
                                   EOMGEN_TEST_CASADI_HARNESS,
                                   path + "_casadi.c",
                                   path + ".c",
                                   "-lm"};
  if (derivatives) command.insert(command.begin() + 2, "-DDERIVATIVES");
  const emit::ProcessResult built = emit::run_process(command);
  if (built.status != 0) return built.output;
  const emit::ProcessResult run = emit::run_process({folder.path + "/use"});
  return run.status == 0 ? "" : fmt::format("status {}: {}", run.status, run.output);
}

}  // namespace

TEST_CASE("target casadi: patterns, work vectors and derivatives are those of the interface") {
  const std::vector<std::string> with = {"jac", "jac_p", "jac_u"};
  CHECK(failure(example("pendulum", pendulum(), {"theta"}, {"m", "l", "g"}, {}, with), true) == "");
  CHECK(failure(example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"}, with), true) == "");
  CHECK(failure(example("two", double_pendulum(), {"a", "b"}, {"m1", "m2", "l1", "l2", "g"}, {}, with), true) == "");
}

TEST_CASE("target casadi: entries that are always zero are not in the pattern") {
  const Example e =
      example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"}, {"jac", "jac_p", "jac_u"});
  const std::string text = file_named(emit::emit(e.program, e.context, "casadi"), "_casadi.c");
  // Nothing depends on x; the first two rates depend on the other two alone.
  CHECK(text.find("[] = {4, 4, 0, 0, 2,") != std::string::npos);
  CHECK(text.find("[] = {4, 1, 0, 2, 2, 3};") != std::string::npos);  // by F
}

TEST_CASE("target casadi: without all Jacobians there are no derivatives, and the file names the option") {
  const Example e = example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"}, {"jac"});
  const std::string text = file_named(emit::emit(e.program, e.context, "casadi"), "_casadi.c");
  CHECK(text.find("--with jac,jac_p,jac_u") != std::string::npos);
  CHECK(text.find("jac_cart_ode") == std::string::npos);
  CHECK(failure(e, false) == "");
}

TEST_CASE("target casadi: hostile texts and long names cause no harm") {
  auto e = example(std::string(64, 'm'), cart_pendulum(), {"arg", "res"}, {"iw", "mem", std::string(64, 'w'), "g", "c"},
                   {"casadi_int"}, {"jac", "jac_p", "jac_u"});
  e.context.title =
      "*/ #error no\n\\ ?"
      "?/";
  e.context.parameters[0].note = "\n#error no";
  CHECK(failure(e, true) == "");
}

TEST_CASE("target casadi: single precision is refused, because CasADi computes with doubles") {
  Example e = examples()[0];
  emit::convert_to_single(e.program, e.context);
  CHECK_THROWS_WITH_AS(emit::emit(e.program, e.context, "casadi"), doctest::Contains("no single precision"), Error);
}
