// SPDX-License-Identifier: GPL-3.0-or-later
// Target octave through Octave, if installed. tests/models/languages_test.cpp compares shipped models with their C
// code.
#include <doctest/doctest.h>

#include "emit/examples.hpp"
#include "emit/single_precision.hpp"
#include "emit/targets.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

bool has_octave() {
  const emit::ProcessResult tried = emit::run_process({"octave-cli", "--norc", "--no-history", "--eval", "1;"});
  if (tried.started && tried.status == 0) return true;
  MESSAGE("skipped: there is no octave-cli");
  return false;
}

emit::ProcessResult octave(const std::string& folder, const std::string& script) {
  return emit::run_process({"octave-cli", "--norc", "--no-history", "--path", folder, "--eval", script});
}

std::string emitted(const Example& e) {
  const auto files = emit::emit(e.program, e.context, "octave");
  REQUIRE(files.size() == 1);
  CHECK(files[0].name == emit::octave_name(e.context.id) + ".m");
  for (const char letter : files[0].text)
    CHECK((static_cast<unsigned char>(letter) < 0x7f && (letter >= ' ' || letter == '\n')));
  return files[0].text;
}

/// Loads the model, runs its self-test, and then `more`.
void loads_octave(const Example& e, const std::string& more = "") {
  const Folder folder;
  const std::string name = emit::octave_name(e.context.id);
  emit::write_files(folder.path, {{name + ".m", emitted(e)}});
  if (!has_octave()) return;
  const emit::ProcessResult finished =
      octave(folder.path, fmt::format("m = {}(); assert(m.selftest(), 0); assert(numel(m.states), {}); {}", name,
                                      e.context.start.size(), more));
  CHECK_MESSAGE(finished.status == 0, finished.output);
  CHECK(finished.output.find("warning") == std::string::npos);
}

}  // namespace

TEST_CASE("target octave: every function agrees with its high-precision values") {
  for (const Example& e : examples()) {
    INFO(e.context.id);
    loads_octave(e, "[dx, code] = m.rhs(0, m.x); assert(code, 0); assert(size(dx), size(m.x));");
  }
}

TEST_CASE("target octave: MATLAB reads the file too: no syntax of Octave alone, no name longer than 63 characters") {
  const std::string letters(64, 'a');
  const Example e = example(std::string(64, 'm'), double_pendulum(), {letters, letters.substr(1) + "b"},
                            {letters + "1", letters + "2", "l1", "l2", letters + "3"});
  const std::string text = emitted(e);
  CHECK(emit::octave_name(e.context.id).size() == 63);
  CHECK(emit::octave_name(std::string(63, 'm') + "a") != emit::octave_name(std::string(63, 'm') + "b"));
  std::string word;
  bool quoted = false, comment = false;
  for (const char c : text) {
    if (c == '\n') comment = quoted = false;
    if (!comment && c == '\'') quoted = !quoted;
    if (!quoted && c == '%') comment = true;
    const bool part = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    if (part && !quoted && !comment) {
      word += c;
      continue;
    }
    CHECK(word.size() <= 63);
    for (const char* own : {"endif", "endfunction", "endwhile", "printf", "unwind_protect"}) CHECK(word != own);
    word.clear();
    if (quoted || comment) continue;
    for (const char only : {'#', '!', '"'}) CHECK(c != only);
  }
  for (const char* operation : {"+=", "-=", "**", "++", "--"}) {
    const std::string code = text.substr(text.find("model = struct();"));
    INFO(std::string(operation));
    std::istringstream lines(code);
    for (std::string line; std::getline(lines, line);) {
      if (line.find('\'') == std::string::npos && line.find('%') == std::string::npos)
        CHECK(line.find(operation) == std::string::npos);
    }
  }
  loads_octave(e);
}

TEST_CASE("target octave: its self-test detects a wrong value, wrong defaults and entries that are never written") {
  Example e = example("eom", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"});
  const emit::TestVector& first = e.context.tests.front();
  e.context.start_time = first.t;
  for (std::size_t i = 0; i < first.p.size(); ++i) e.context.parameters[i].value = first.p[i];
  if (!has_octave()) return;
  const Folder folder;
  const auto first_wrong = [&folder](const std::string& text) {
    emit::write_files(folder.path, {{emit::octave_name("eom") + ".m", text}});
    return octave(folder.path, fmt::format("m = {}(); exit(m.selftest())", emit::octave_name("eom"))).status;
  };
  const std::string text = emitted(e);
  REQUIRE(first_wrong(text) == 0);
  for (const char* statement : {"  dx(1) = ", "  dfdx(9) = "}) {
    const std::size_t begin = text.find(statement);
    REQUIRE(begin != std::string::npos);
    CHECK(first_wrong(text.substr(0, begin) + text.substr(text.find('\n', begin))) == 1);
  }
  std::string wrong = text;
  wrong.replace(wrong.find("  p = [") + 7, 1, "9");
  CHECK(first_wrong(wrong) == 1);
  e.context.tests[1].functions[0].values[0].back() *= 1 + 1e-9;
  CHECK(first_wrong(emitted(e)) == 2);
}

TEST_CASE("target octave: names of Octave, and hostile texts, cause no harm") {
  for (const char* id : {"function", "end", "ode45", "struct", "eval"}) {
    INFO(id);
    auto e = example(id, cart_pendulum(), {"end", "nargin"}, {"NaN", "zeros", "choose", "pi", "side"}, {"isempty"});
    e.context.title = "'; exit(7); %{ ' \" ... \\n \n exit(8)";
    e.context.parameters[0].note = "'];\nexit(9)";
    e.context.parameters[1].unit = "'); exit(10) % \xff";
    loads_octave(e,
                 "assert(m.parameters, {'NaN', 'zeros', 'choose', 'pi', 'side'}); "
                 "assert(jsondecode(m.info).title(1:3), \"'; \");");
  }
}

TEST_CASE("target octave: single precision passes its self-test, and results are single") {
  Example e = examples()[1];
  emit::convert_to_single(e.program, e.context);
  loads_octave(e, "assert(class(m.rhs(0, m.x)), 'single');");
}

TEST_CASE("target octave: ode45 and lsode integrate the model") {
  const Example e = example("pendulum", pendulum(), {"theta"}, {"m", "l", "g"});
  loads_octave(e,
               "o = odeset('RelTol', 1e-8, 'AbsTol', 1e-10); [t, x] = ode45(@(t, x) m.rhs(t, x), [0, 1], m.x, o); "
               "lsode_options('relative tolerance', 1e-9); y = lsode(@(x, t) m.rhs(t, x), m.x, [0, 1]); "
               "assert(x(end, :), y(end, :), 1e-5);");
}
