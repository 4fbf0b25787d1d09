// SPDX-License-Identifier: GPL-3.0-or-later
// Target rust through rustc, if installed: as a module of a crate without the standard library, and its own test.
// tests/models/languages_test.cpp compares shipped models with their C code.
#include <doctest/doctest.h>

#include "emit/single_precision.hpp"
#include "emit/target_uses.hpp"
#include "emit/targets.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

bool has_rustc() {
  const emit::ProcessResult tried = emit::run_process({"rustc", "--version"});
  if (tried.started && tried.status == 0) return true;
  MESSAGE("skipped: there is no rustc");
  return false;
}

void compiles_and_passes(const Example& e) {
  const Folder folder;
  const auto files = emit::emit(e.program, e.context, "rust");
  REQUIRE(files.size() == 1);
  CHECK(files[0].name == emit::rust_name(e.context.id) + ".rs");
  for (const char letter : files[0].text)
    CHECK((static_cast<unsigned char>(letter) < 0x7f && (letter >= ' ' || letter == '\n')));
  emit::write_files(folder.path, files);
  if (!has_rustc()) return;
  CHECK(failed_test(folder.path, files[0].name) == "");
  std::ofstream(folder.path + "/lib.rs") << fmt::format("#![no_std]\npub mod {};\n", emit::rust_name(e.context.id));
  const emit::ProcessResult library =
      emit::run_process({"rustc", "--edition", "2021", "-D", "warnings", "--crate-type", "lib", "--emit", "metadata",
                         "-o", folder.path + "/lib.rmeta", folder.path + "/lib.rs"});
  CHECK_MESSAGE(library.status == 0, library.output);
}

}  // namespace

TEST_CASE("target rust: the module has no warnings, needs no standard library, and agrees with high-precision values") {
  for (const Example& e : examples()) {
    INFO(e.context.id);
    compiles_and_passes(e);
  }
}

TEST_CASE("target rust: its test detects a wrong value, wrong defaults and entries that are never written") {
  Example e = example("eom", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"});
  const emit::TestVector& first = e.context.tests.front();
  e.context.start_time = first.t;
  for (std::size_t i = 0; i < first.p.size(); ++i) e.context.parameters[i].value = first.p[i];
  const auto files = emit::emit(e.program, e.context, "rust");
  const std::string text = files.front().text;
  if (!has_rustc()) return;
  const Folder folder;
  for (const char* statement : {"  p[1] = ", "  x[1] = ", "  dx[0] = "}) {
    CAPTURE(std::string(statement));
    const std::size_t begin = text.find(statement);
    REQUIRE(begin != std::string::npos);
    emit::write_files(folder.path, {{"wrong.rs", text.substr(0, begin) + text.substr(text.find('\n', begin))}});
    const std::string failure = failed_test(folder.path, "wrong.rs");
    CHECK(failure.starts_with("test: "));
  }
  e.context.tests[1].functions[0].values[0].back() *= 1 + 1e-9;
  emit::write_files(folder.path, emit::emit(e.program, e.context, "rust"));
  const std::string failure = failed_test(folder.path, emit::rust_name("eom") + ".rs");
  CHECK((failure.find("left: 2") != std::string::npos || failure.find("left: `2`") != std::string::npos));
}

TEST_CASE("target rust: names of Rust, names of 64 letters, and hostile texts cause no harm") {
  for (const char* id : {"match", "std", "f64", "self", "Real", "crate"}) {
    INFO(id);
    auto e = example(id, cart_pendulum(), {"let", "None"},
                     {"STATES", "fn", std::string(64, 'a').c_str(), "Some", "libm"}, {std::string(64, 'b')});
    e.context.title = "*/ }}} \" ' ` #![feature(x)] \\u{202e} \n#![no_core]";
    e.context.parameters[0].note = "\ncompile_error!(\"no\");";
    e.context.parameters[1].unit = "\"); compile_error!(\"no\"); // \xff";
    compiles_and_passes(e);
  }
}

TEST_CASE("target rust: the self test of single precision passes") {
  Example e = examples()[1];
  emit::convert_to_single(e.program, e.context);
  compiles_and_passes(e);
}
