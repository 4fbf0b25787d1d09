// SPDX-License-Identifier: GPL-3.0-or-later
// Target julia: through Julia if installed, and through an evaluator of its statements (evaluators.py).
// tests/models/languages_test.cpp compares shipped models with their C code.
#include <doctest/doctest.h>

#include "emit/target_uses.hpp"
#include "emit/targets.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

std::string julia_text(const Example& e) {
  const auto files = emit::emit(e.program, e.context, "julia");
  REQUIRE(files.size() == 1);
  CHECK(files[0].name == emit::julia_name(e.context.id) + ".jl");
  for (const char letter : files[0].text)
    CHECK((static_cast<unsigned char>(letter) < 0x7f && (letter >= ' ' || letter == '\n')));
  return files[0].text;
}

/// The failure of the module's self-test, or empty.
std::string failure_of_module(const Example& e, const std::string& text) {
  const Folder folder;
  emit::write_files(folder.path, {{emit::julia_name(e.context.id) + ".jl", text}});
  return target_uses().at("julia")(folder.path, e);
}

}  // namespace

TEST_CASE("target julia: every function agrees with its high-precision values") {
  for (const Example& e : examples()) {
    INFO(e.context.id);
    const std::string text = julia_text(e);
    CHECK(text.find("function rhs!(dx, ") != std::string::npos);
    CHECK(text.find("function jac!(dfdx, ") != std::string::npos);
    CHECK(failure_of_module(e, text) == "");
  }
}

TEST_CASE("target julia: its self-test detects a wrong value and entries that are never written") {
  if (!runs("python3")) return;
  const Example e = example("eom", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"});
  const std::string text = julia_text(e);
  REQUIRE(failure_of_module(e, text) == "");
  for (const char* statement : {"  dx[1] = ", "  dfdx[9] = "}) {
    const std::size_t begin = text.find(statement);
    REQUIRE(begin != std::string::npos);
    CHECK(failure_of_module(e, text.substr(0, begin) + text.substr(text.find('\n', begin))) != "");
  }
}

TEST_CASE("target julia: names of Julia and of the module, and hostile texts, cause no harm") {
  for (const char* id : {"end", "module", "Base", "rhs", "START"}) {
    INFO(id);
    auto e = example(id, cart_pendulum(), {"u", "dfdt"}, {"mode", "zeros", "p", "fill", "STATES"}, {"x"});
    e.context.title = "\"\"\" $(run(`false`)) =# ' \n exit(8)";
    e.context.parameters[0].note = "$(exit(9)) \" ; exit(9)";
    e.context.parameters[1].unit = "\\\" exit(10) # \xff";
    const std::string text = julia_text(e);
    for (std::size_t at = 0; (at = text.find('$', at)) != std::string::npos; ++at)
      CHECK((text[at - 1] == '\\' || text.rfind('#', at) > text.rfind('\n', at)));
    CHECK(failure_of_module(e, text) == "");
  }
}
