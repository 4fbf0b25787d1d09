// SPDX-License-Identifier: GPL-3.0-or-later
// C in single precision in the hands of compilers.
#include "emit/single_precision.hpp"

#include <doctest/doctest.h>

#include "emit/examples.hpp"
#include "error.hpp"

using namespace eomgen;
using namespace test_systems;

TEST_CASE("single precision: C passes its self test, computes no double, and the verdict tells what it costs") {
  for (Example e : examples()) {
    INFO(e.context.id);
    const std::string in_double = file_named(emit::emit(e.program, e.context, "c"), ".c");
    emit::make_single(e.program, e.context);
    const Folder folder;
    const std::vector<emit::EmittedFile> files = emit::emit(e.program, e.context, "c");
    emit::write_files(folder.path, files);
    const std::string name = emit::mangled_id(e.context.id);
    std::ofstream(folder.path + "/use.c")
        << fmt::format("#include \"{0}.h\"\nint main(void) {{ return {0}_selftest(); }}\n", name);
    const std::vector<std::string> command{EOMGEN_TEST_CC,       "-std=c11", "-O1",
                                           "-Wdouble-promotion", "-o",       folder.path + "/use"};
    CHECK(complaints(command, {folder.path + "/use.c", folder.path + "/" + name + ".c", "-lm"}) == "");
    CHECK(emit::run_process({folder.path + "/use"}).status == 0);
    const std::string text = file_named(files, ".c");
    CHECK(text.find("double ") == std::string::npos);
    CHECK(text.find("in single precision the right-hand side is off by") != std::string::npos);
    // 24 bits: not less than a fraction of their last one, and these systems lose two digits at most.
    REQUIRE(e.context.single_error);
    CHECK(*e.context.single_error > 1e-9);
    CHECK(*e.context.single_error < 1e-5);
    CHECK(in_double.find("float ") == std::string::npos);

    // A wrong digit of the fifth place is found.
    std::string wrong = text;
    const std::size_t at = wrong.rfind("0.5f*") != std::string::npos ? wrong.rfind("0.5f*") : wrong.rfind("2.0f*");
    if (at == std::string::npos) continue;
    wrong.replace(at, 4, wrong[at] == '0' ? "0.5001f" : "2.0004f");
    std::ofstream(folder.path + "/" + name + ".c") << wrong;
    CHECK(complaints(command, {folder.path + "/use.c", folder.path + "/" + name + ".c", "-lm"}) == "");
    CHECK(emit::run_process({folder.path + "/use"}).status != 0);
  }
}

TEST_CASE("single precision: the header of templates holds its self test too, in double precision") {
  Example e = example("two", double_pendulum(), {"a", "b"}, {"m1", "m2", "l1", "l2", "g"});
  const emit::TestVector& first = e.context.tests[0];  // the defaults, which are no numbers of single precision
  e.context.start_time = first.t;
  for (std::size_t i = 0; i < first.p.size(); ++i) e.context.parameters[i].value = first.p[i];
  emit::make_single(e.program, e.context);
  const Folder folder;
  emit::write_files(folder.path, emit::emit(e.program, e.context, "cpp"));
  std::ofstream(folder.path + "/use.cpp") << "#include \"two.hpp\"\nint main() { return eom::two::selftest(); }\n";
  CHECK(complaints({EOMGEN_TEST_CXX, "-std=c++20", "-o", folder.path + "/use"}, {folder.path + "/use.cpp"}) == "");
  CHECK(emit::run_process({folder.path + "/use"}).status == 0);
}

TEST_CASE("single precision: targets that know double precision alone are refused, and numbers beyond it") {
  for (const char* target : {"batch", "python", "javascript"}) CHECK_THROWS_AS(emit::require_single(target), Error);
  for (const char* target : {"c", "cpp", "cuda"}) CHECK_NOTHROW(emit::require_single(target));
  CHECK(emit::single_dialect().value(0.1) == "0.1f");
  CHECK_THROWS_AS(emit::single_dialect().value(1e60), Error);
}
