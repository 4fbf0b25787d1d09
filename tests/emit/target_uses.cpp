// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/target_uses.hpp"

#include "emit/targets.hpp"

using namespace eomgen;

namespace test_systems {

bool runs(const char* program) { return emit::run_process({program, "--version"}).status == 0; }

const std::vector<std::string>& compile_c() {
  static const std::vector<std::string> command{EOMGEN_TEST_CC, "-std=c11", "-O1", "-ffp-contract=off",
                                                "-Wdouble-promotion"};
  return command;
}

std::vector<std::string> with(std::vector<std::string> command, const std::vector<std::string>& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

namespace {

std::string failure_of_c(const std::string& folder, const std::string& name) {
  const std::string use = folder + "/use";
  std::ofstream(use + ".c") << fmt::format("#include \"{0}.h\"\nint main(void) {{ return {0}_selftest(); }}\n", name);
  const std::string said =
      compiler_diagnostics(with(compile_c(), {"-o", use}), {use + ".c", folder + "/" + name + ".c", "-lm"});
  if (!said.empty()) return said;
  return emit::run_process({use}).status == 0 ? "" : "its self test";
}

}  // namespace

// Several targets contain the same C file: it is compiled once.
std::string wrong_c(const std::string& folder, const Example& e) {
  static std::map<std::string, std::string> known;
  const std::string name = emit::mangled_id(e.context.id);
  std::ostringstream text;
  text << std::ifstream(folder + "/" + name + ".h").rdbuf() << std::ifstream(folder + "/" + name + ".c").rdbuf();
  const auto found = known.find(text.str());
  if (found != known.end()) return found->second;
  return known.emplace(text.str(), failure_of_c(folder, name)).first->second;
}

// C++ source that calls the templates of `header` at the start state.
std::string wrong_templates(const std::string& folder, const Example& e, const std::string& header,
                            const std::string& space, const std::string& selftest) {
  std::ofstream(folder + "/use.cpp") << fmt::format(
      "#include \"{0}\"\nint main() {{\n  {3} x[16], p[16], u[4] = {{}}, dx[16];\n  {1}::defaults(x, p);\n"
      "  return {1}::rhs({3}(0), x, p, static_cast<const {3}*>(u), 0, dx){2};\n}}\n",
      header, space, selftest, e.context.single_error ? "float" : "double");
  const std::string said =
      compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-o", folder + "/use_cpp"}, {folder + "/use.cpp"});
  if (!said.empty()) return said;
  return emit::run_process({folder + "/use_cpp"}).status == 0 ? "" : "the templates' self test";
}

std::string failed_test(const std::string& folder, const std::string& file) {
  const emit::ProcessResult built = emit::run_process(
      {"rustc", "--edition", "2021", "-D", "warnings", "--test", "-o", folder + "/run", folder + "/" + file});
  if (built.status != 0) return "rustc: " + built.output;
  const emit::ProcessResult run = emit::run_process({folder + "/run"});
  return run.status == 0 && run.output.find("1 passed") != std::string::npos ? "" : "test: " + run.output;
}

namespace {

std::string wrong_module(const std::string& folder, const Example& e) {
  if (!runs("python3")) return "";
  const std::string c = folder + "/" + emit::mangled_id(e.context.id) + "_simulate.c";
  const std::string said =
      compiler_diagnostics(with(compile_c(), {"-c", "-Wno-double-promotion", "-o", folder + "/c.o"}), {c});
  if (!said.empty()) return said;
  const ScopedEnvironmentVariable cache("EOMGEN_CACHE_DIR", folder);
  const emit::ProcessResult finished = emit::run_process(
      {"python3", "-c",
       fmt::format("import sys; sys.dont_write_bytecode = True; sys.path.insert(0, '{}'); import {} as m\n"
                   "import ctypes\n"
                   "is_single = m.info.get('real') == 'float'; assert is_single == {}\n"
                   "def fits(values): return not is_single or all(ctypes.c_float(v).value == v for v in values)\n"
                   "dx = m.rhs(0, m.defaults['x']); assert len(dx) == len(m.states) and fits(dx), dx\n"
                   "motion = m.simulate(m.defaults['t'] + 1e-3, samples=5); assert motion.outcome == 'done'\n"
                   "assert all(fits(row) for row in motion.x) and is_single != fits(motion.t)\n"
                   "for wrong in (dict(x0=[1e60] * len(m.states)), dict(rtol=1e-9)) if is_single else ():\n"
                   "    try: m.simulate(m.defaults['t'] + 1e-3, **wrong)\n"
                   "    except ValueError: continue\n"
                   "    raise AssertionError(wrong)\n",
                   folder, emit::module_name(e.context.id), e.context.single_error ? "True" : "False")});
  return finished.status == 0 ? "" : finished.output;
}

std::string wrong_script(const std::string& folder, const Example& e) {
  if (!runs("node")) return "";
  const emit::ProcessResult finished = emit::run_process(
      {"node", "-e",
       fmt::format("const assert = require('assert'), m = require('{}/{}.js'); assert.strictEqual(m.selftest(), 0); "
                   "assert.strictEqual(m.info.real ?? 'double', '{}')",
                   folder, emit::script_name(e.context.id), e.context.single_error ? "float" : "double")});
  return finished.status == 0 ? "" : finished.output;
}

std::string wrong_crate(const std::string& folder, const Example& e) {
  return runs("rustc") ? failed_test(folder, emit::rust_name(e.context.id) + ".rs") : "";
}

std::string wrong_script_of_octave(const std::string& folder, const Example& e) {
  if (!runs("octave-cli")) return "";
  const emit::ProcessResult finished =
      emit::run_process({"octave-cli", "--norc", "--no-history", "--path", folder, "--eval",
                         fmt::format("m = {}(); assert(m.selftest(), 0)", emit::octave_name(e.context.id))});
  return finished.status == 0 && finished.output.find("warning") == std::string::npos ? "" : finished.output;
}

/// Runs Python with the evaluators of tests/emit. Failed statements are the description of the failure.
std::string failure_of_evaluation(const std::string& statements) {
  if (!runs("python3")) return "";
  const emit::ProcessResult finished =
      emit::run_process({"python3", "-c",
                         fmt::format("import sys; sys.dont_write_bytecode = True; sys.path.insert(0, '{}')\n"
                                     "from evaluators import julia, modelica\n{}",
                                     EOMGEN_TEST_EVALUATORS, statements)});
  return finished.status == 0 ? "" : finished.output;
}

std::string wrong_module_of_julia(const std::string& folder, const Example& e) {
  if (runs("julia")) {
    const std::string name = emit::julia_name(e.context.id);
    const emit::ProcessResult finished = emit::run_process(
        {"julia", "--startup-file=no", "-e",
         fmt::format("include(\"{0}/{1}.jl\"); {1}.selftest() == 0 || error(\"self test\")", folder, name)});
    if (finished.status != 0) return finished.output;
  }
  return failure_of_evaluation(
      fmt::format("m = julia('{}/{}.jl')\nassert m['selftest']() == 0, m['selftest']()\n"
                  "assert len(m['STATES']) == {}",
                  folder, emit::julia_name(e.context.id), e.context.start.size()));
}

std::string python_list(const std::vector<double>& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

std::string wrong_flat_model(const std::string& folder, const Example& e) {
  std::string statements = fmt::format("m = modelica('{}/{}.mo')\n", folder, emit::modelica_name(e.context.id));
  for (const emit::TestVector& test : e.context.tests)
    statements += fmt::format(
        "dx, code = m.derivatives({}, {}, {}, {})\nassert code == 0\n"
        "assert all(abs(a - b) <= {} for a, b in zip(dx, {}, strict=True)), dx\n",
        test.t, python_list(test.x), python_list(test.p), python_list(test.u), test.functions[0].tolerances[0],
        python_list(test.functions[0].values[0]));
  return failure_of_evaluation(statements);
}

std::string wrong_external(const std::string& folder, const Example& e) {
  const std::string of_c = wrong_c(folder, e), c = folder + "/" + emit::mangled_id(e.context.id) + "_casadi.c";
  return of_c.empty() ? compiler_diagnostics(with(compile_c(), {"-c", "-o", folder + "/casadi.o"}), {c}) : of_c;
}

const std::map<std::string, TargetUse> uses = {
    {"c", wrong_c},
    {"batch",  // batch_test.cpp tests the values of lanes
     [](const std::string& folder, const Example& e) {
       const std::string of_c = wrong_c(folder, e), c = folder + "/" + emit::mangled_id(e.context.id) + "_batch.c";
       return of_c.empty() ? compiler_diagnostics(with(compile_c(), {"-c", "-o", folder + "/batch.o"}), {c}) : of_c;
     }},
    {"cpp",
     [](const std::string& folder, const Example& e) {
       const std::string name = emit::mangled_id(e.context.id), of_c = wrong_c(folder, e);
       return of_c.empty()
                  ? wrong_templates(folder, e, name + ".hpp", "eom::" + name, " + eom::" + name + "::selftest()")
                  : of_c;
     }},
    {"cuda",
     [](const std::string& folder, const Example& e) {
       const std::string name = emit::mangled_id(e.context.id);
       return wrong_templates(folder, e, name + ".cuh", "eom::" + name + "::device", "");
     }},
    {"python",
     [](const std::string& folder, const Example& e) {
       const std::string of_c = wrong_c(folder, e);
       return of_c.empty() ? wrong_module(folder, e) : of_c;
     }},
    {"javascript", wrong_script},
    {"rust", wrong_crate},
    {"octave", wrong_script_of_octave},
    {"julia", wrong_module_of_julia},
    {"modelica", wrong_flat_model},
    {"casadi", wrong_external}};

}  // namespace

const std::map<std::string, TargetUse>& target_uses() { return uses; }

}  // namespace test_systems
