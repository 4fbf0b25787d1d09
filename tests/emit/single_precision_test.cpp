// SPDX-License-Identifier: GPL-3.0-or-later
// Every target in single precision, run through compilers and interpreters.
#include "emit/single_precision.hpp"

#include <doctest/doctest.h>

#include <random>
#include <set>

#include "emit/target_uses.hpp"
#include "error.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

std::vector<Example> single_examples() {
  std::vector<Example> all = examples();
  for (Example& e : all) emit::convert_to_single(e.program, e.context);
  return all;
}

/// The numbers in the output of a command.
std::vector<double> printed(const std::vector<std::string>& command) {
  const emit::ProcessResult finished = emit::run_process(command);
  CHECK_MESSAGE(finished.status == 0, finished.output);
  std::istringstream words(finished.output);
  std::vector<double> values;
  for (double value = 0; words >> value;) values.push_back(value);
  return values;
}

// Their language has no single precision.
const std::set<std::string> targets_of_doubles = {"casadi", "modelica"};

}  // namespace

TEST_CASE(
    "single precision: every target of languages that have it supports it, passes its self-test, and reports the loss "
    "of accuracy") {
  for (const emit::TargetEntry& target : emit::targets()) {
    INFO(std::string(target.name));
    if (targets_of_doubles.contains(target.name)) {
      for (const Example& e : single_examples())
        CHECK_THROWS_WITH_AS(target.emit(e.program, e.context), doctest::Contains("no single precision"), Error);
      continue;
    }
    const auto use = target_uses().find(target.name);
    REQUIRE((use != target_uses().end()));
    for (const Example& e : single_examples()) {
      INFO(e.context.id);
      const Folder folder;
      const std::vector<emit::EmittedFile> files = target.emit(e.program, e.context);
      emit::write_files(folder.path, files);
      CHECK(use->second(folder.path, e) == "");
      for (const emit::EmittedFile& file : files) {
        if (file.name.ends_with("_simulate.c")) continue;  // no code of the model
        INFO(file.name);
        CHECK(file.text.find("in single precision the right-hand side is off by") != std::string::npos);
      }
    }
  }
}

TEST_CASE("single precision: C uses no doubles and loses few digits, and its self-test detects a wrong digit") {
  for (Example e : examples()) {
    INFO(e.context.id);
    CHECK(file_named(emit::emit(e.program, e.context, "c"), ".c").find("float ") == std::string::npos);
    emit::convert_to_single(e.program, e.context);
    const Folder folder;
    const std::vector<emit::EmittedFile> files = emit::emit(e.program, e.context, "c");
    emit::write_files(folder.path, files);
    const std::string text = file_named(files, ".c");
    CHECK(text.find("double ") == std::string::npos);
    // 24 bits: the error is at least a fraction of the last one, and these systems lose at most two digits.
    REQUIRE(e.context.single_error);
    CHECK(*e.context.single_error > 1e-9);
    CHECK(*e.context.single_error < 1e-5);

    // A wrong fifth digit is detected.
    std::string wrong = text;
    const std::size_t at = wrong.rfind("0.5f*") != std::string::npos ? wrong.rfind("0.5f*") : wrong.rfind("2.0f*");
    if (at == std::string::npos) continue;
    wrong.replace(at, 4, wrong[at] == '0' ? "0.5001f" : "2.0004f");
    std::ofstream(folder.path + "/" + emit::mangled_id(e.context.id) + ".c") << wrong;
    CHECK(wrong_c(folder.path, e) == "its self test");
  }
}

TEST_CASE("single precision: JavaScript gives the bits of C, except for library functions") {
  if (!runs("node")) {
    MESSAGE("skipped: there is no node");
    return;
  }
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> within(-1, 1);
  int without_functions = 0;
  for (const Example& e : single_examples()) {
    INFO(e.context.id);
    const std::string name = emit::mangled_id(e.context.id);
    const std::size_t n = e.program.state_count(), states = 200;
    const Folder folder;
    for (const char* target : {"c", "javascript"})
      emit::write_files(folder.path, emit::emit(e.program, e.context, target));
    std::string numbers;
    for (std::size_t i = 0; i < n * states; ++i)  // not exact as floats: both languages round their inputs
      numbers += fmt::format("{}{:.17g}", i > 0 ? ", " : "", e.context.start[i % n] + within(random));
    std::ofstream(folder.path + "/use.c") << fmt::format(
        "#include <stdio.h>\n#include \"{0}.h\"\nint main(void) {{\n"
        "  static const double numbers[] = {{{1}}};\n  float x[{2}], p[{0}_parameters + 1], dx[{2}];\n  int i, s, "
        "code;\n"
        "  for (s = 0; s < {3}; ++s) {{\n    {0}_defaults(x, p);\n"
        "    for (i = 0; i < {2}; ++i) x[i] = (float)numbers[{2}*s + i];\n"
        "    code = {0}_rhs((float)(0.1*s), x, p, NULL, 0, dx);\n    printf(\"%d\\n\", code);\n"
        "    for (i = 0; i < {2}; ++i) printf(\"%.9g\\n\", code == 0 ? (double)dx[i] : 0.0);\n  }}\n  return 0;\n}}\n",
        name, numbers, n, states);
    REQUIRE(compiler_diagnostics(with(compile_c(), {"-Wno-double-promotion", "-o", folder.path + "/use"}),
                                 {folder.path + "/use.c", folder.path + "/" + name + ".c", "-lm"}) == "");
    std::ofstream(folder.path + "/use.js") << fmt::format(
        "const m = require('./{0}.js'), numbers = [{1}];\n"
        "for (let s = 0; s < {3}; ++s) {{\n  const x = [], p = [], dx = [];\n  m.defaults(x, p);\n"
        "  const code = m.rhs(0.1*s, numbers.slice({2}*s, {2}*s + {2}), p, null, 0, dx);\n  console.log(code);\n"
        "  for (let i = 0; i < {2}; ++i) console.log(code === 0 ? dx[i] : 0);\n}}\n",
        emit::script_name(e.context.id), numbers, n, states);
    const std::vector<double> of_c = printed({folder.path + "/use"}),
                              of_script = printed({"node", folder.path + "/use.js"});
    REQUIRE(of_c.size() == states * (1 + n));
    REQUIRE(of_script.size() == of_c.size());
    // Sines and cosines of both languages may be wrong by a unit in the last place, and each result by the tolerance of
    // the self-test for the largest entry.
    const bool exact = e.program.functions.front().operations.trig + e.program.functions.front().operations.other == 0;
    const double allowed = exact ? 0 : 2e-5;
    without_functions += exact ? 1 : 0;
    for (std::size_t s = 0; s < states; ++s) {
      double largest = 0, off = 0;
      CHECK(of_c[s * (n + 1)] == of_script[s * (n + 1)]);
      for (std::size_t i = s * (n + 1) + 1; i < (s + 1) * (n + 1); ++i) {
        largest = std::max(largest, std::abs(of_c[i]));
        off = std::max(off, std::abs(static_cast<double>(static_cast<float>(of_c[i])) - of_script[i]));
      }
      CHECK(off <= allowed * largest);
    }
  }
  CHECK(without_functions > 0);
}

TEST_CASE("single precision: the template header passes its self-test too, in double precision") {
  Example e = example("two", double_pendulum(), {"a", "b"}, {"m1", "m2", "l1", "l2", "g"});
  const emit::TestVector& first = e.context.tests[0];  // the defaults, which are not exact in single precision
  e.context.start_time = first.t;
  for (std::size_t i = 0; i < first.p.size(); ++i) e.context.parameters[i].value = first.p[i];
  emit::convert_to_single(e.program, e.context);
  const Folder folder;
  emit::write_files(folder.path, emit::emit(e.program, e.context, "cpp"));
  CHECK(wrong_templates(folder.path, e, "two.hpp", "eom::two", " + eom::two::selftest()") == "");
}

TEST_CASE("single precision: underflow gives 0, and states that overflow are not in the self-test") {
  const Example e = example("two", double_pendulum(), {"a", "b"}, {"m1", "m2", "l1", "l2", "g"});
  const auto made = [&e](double factor) {
    emit::EmissionContext context = e.context;
    for (double& x : context.tests[1].x) x *= factor;
    emit::convert_to_single(e.program, context);
    return context;
  };
  CHECK(made(1e-25).tests.size() == e.context.tests.size());  // products of two rates underflow
  CHECK(*made(1e-25).single_error < 1e-5);
  CHECK(made(1e25).tests.size() == e.context.tests.size() - 1);
  CHECK(made(1e60).tests.size() == e.context.tests.size() - 1);
}

TEST_CASE("single precision: every target rejects numbers that overflow") {
  CHECK(emit::single_dialect().value(0.1) == "0.1f");
  CHECK(emit::to_single(0.1) == static_cast<double>(0.1f));
  CHECK_THROWS_AS(emit::single_dialect().value(1e60), Error);
  CHECK_THROWS_AS(emit::to_single(1e-60), Error);
  Example e = examples()[0], other = e;
  emit::convert_to_single(e.program, e.context);
  e.context.parameters[0].value = other.context.parameters[0].value = 1e60;
  CHECK_THROWS_WITH_AS(emit::convert_to_single(other.program, other.context),
                       doctest::Contains("the parameter m = 1e+60 is outside the range of single precision"), Error);
  for (const char* target : {"c", "batch", "python", "javascript", "rust", "octave", "julia"}) {
    INFO(target);
    CHECK_THROWS_AS(emit::emit(e.program, e.context, target), Error);
  }
}
