// SPDX-License-Identifier: GPL-3.0-or-later
// Target javascript through Node, if installed. tests/models/javascript_test.cpp compares shipped models with their C
// code.
#include <doctest/doctest.h>

#include "emit/examples.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

bool has_node() {
  const emit::ProcessResult tried = emit::run_process({"node", "--version"});
  return tried.started && tried.status == 0;
}

/// Loads the module, runs its self-test, and then `more`.
void loads(const Example& e, const std::string& more = "") {
  const Folder folder;
  const auto files = emit::emit(e.program, e.context, "javascript");
  REQUIRE(files.size() == 1);
  CHECK(files[0].name == emit::script_name(e.context.id) + ".js");
  for (const char letter : files[0].text)
    CHECK((static_cast<unsigned char>(letter) < 0x7f && (letter >= ' ' || letter == '\n')));
  CHECK(files[0].text.find("</") == std::string::npos);
  CHECK(files[0].text.find("<!") == std::string::npos);
  if (!has_node()) {
    MESSAGE("skipped: there is no node");
    return;
  }
  emit::write_files(folder.path, files);
  const emit::ProcessResult finished = emit::run_process(
      {"node", "-e",
       fmt::format("const assert = require('assert'), m = require('{}/{}'); assert.strictEqual(m.selftest(), 0); "
                   "assert.strictEqual(m.info.states.length, {}); {}",
                   folder.path, files[0].name, e.context.start.size(), more)});
  CHECK_MESSAGE(finished.status == 0, finished.output);
}

}  // namespace

TEST_CASE("target javascript: every function agrees with its high-precision values") {
  for (const Example& e : examples()) {
    INFO(e.context.id);
    loads(e);
  }
}

TEST_CASE("target javascript: its self-test detects a wrong value") {
  Example e = examples()[1];
  e.context.tests[1].functions[0].values[0].back() *= 1 + 1e-9;
  if (!has_node()) return;
  const Folder folder;
  const auto files = emit::emit(e.program, e.context, "javascript");
  emit::write_files(folder.path, files);
  CHECK(emit::run_process(
            {"node", "-e", fmt::format("process.exit(require('{}/{}').selftest())", folder.path, files[0].name)})
            .status == 2);
}

TEST_CASE("target javascript: its self-test detects wrong defaults and entries that are never written") {
  if (!has_node()) return;
  // Without inputs, whose default values the reference values of `mass` contain.
  Example e = example("two", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"});
  const emit::TestVector& first = e.context.tests.front();
  e.context.start_time = first.t;
  for (std::size_t i = 0; i < first.p.size(); ++i) e.context.parameters[i].value = first.p[i];
  const std::string text = emit::emit(e.program, e.context, "javascript").front().text;
  const auto status = [](const std::string& script) {
    const Folder folder;
    emit::write_files(folder.path, {{"two.js", script}});
    return emit::run_process({"node", "-e", fmt::format("process.exit(require('{}/two.js').selftest())", folder.path)})
        .status;
  };
  REQUIRE(status(text) == 0);
  for (const char* statement : {"  p[1] = ", "  x[1] = ", "  dx[0] = "}) {
    CAPTURE(std::string(statement));
    const std::size_t begin = text.find(statement);
    REQUIRE(begin != std::string::npos);
    CHECK(status(text.substr(0, begin) + text.substr(text.find('\n', begin))) == 1);
  }
}

TEST_CASE("target javascript: names of JavaScript and browsers, and hostile texts, cause no harm") {
  for (const char* id : {"function", "document", "module", "window", "json", "Math"}) {
    INFO(id);
    auto e =
        example(id, cart_pendulum(), {"let", "arguments"}, {"rhs", "import", "Math", "eval", "var"}, {"undefined"});
    e.context.title = "</script><script>throw 1</script> <!-- */ \" ' ` ${process.exit(7)} \\u2028";
    e.context.parameters[0].note = "\nprocess.exit(8)";
    e.context.parameters[1].unit = "\"); process.exit(9) // \xff";
    loads(e,
          "assert.deepStrictEqual(m.info.parameters, ['rhs', 'import', 'Math', 'eval', 'var']); "
          "assert(m.info.title.startsWith('</script>'));");
  }
}
