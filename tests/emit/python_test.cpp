// SPDX-License-Identifier: GPL-3.0-or-later
// Target python: its C code through compilers, its module through Python if installed. examples/python,
// examples/python_run and examples/scipy compare the results of the module with `eomgen run`.
#include <doctest/doctest.h>

#include "abi/functions.hpp"
#include "emit/examples.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

void compiles_and_imports(const Example& e, const std::string& more = "pass") {
  const Folder folder;
  const ScopedEnvironmentVariable cache("EOMGEN_CACHE_DIR", folder.path);
  const auto files = emit::emit(e.program, e.context, "python");
  emit::write_files(folder.path, files);
  const std::string name = emit::mangled_id(e.context.id), module = emit::module_name(e.context.id),
                    c = folder.path + "/" + name + "_simulate.c";
  CHECK(compiler_diagnostics({EOMGEN_TEST_CC, "-std=c11", "-O2", "-c", "-o", folder.path + "/c.o"}, {c}) == "");
  CHECK(compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-x", "c++", "-c", "-o", folder.path + "/cpp.o"}, {c}) ==
        "");
  for (const auto& file : files) {
    for (const char letter : file.text)
      CHECK_MESSAGE((static_cast<unsigned char>(letter) < 0x7f && (letter >= ' ' || letter == '\n')), file.name);
  }
  if (emit::run_process({"python3", "--version"}).status != 0) return;
  const std::string use = fmt::format(
      "import sys; sys.dont_write_bytecode = True; sys.path.insert(0, '{0}'); import {1} as m; "
      "assert len(m.rhs(0, m.defaults['x'])) == len(m.states) == {2}; assert len(m.params) == {3}; "
      "assert m.simulate(m.defaults['t'] + 1e-3).outcome == 'done'; {4}",
      folder.path, module, e.context.start.size(), e.context.parameters.size(), more);
  const emit::ProcessResult finished = emit::run_process({"python3", "-c", use});
  CHECK_MESSAGE(finished.status == 0, finished.output);
}

}  // namespace

TEST_CASE("target python: the C code has no warnings under strict flags, and the module imports and integrates") {
  for (const Example& e : examples()) {
    INFO(e.context.id);
    compiles_and_imports(e);
  }
}

TEST_CASE("target python: momenta and series are there if they were emitted, and named if not") {
  compiles_and_imports(example("two", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"}, {},
                               {"mass", "momenta", "taylor"}),
                       "x = m.defaults['x']; M, h = m.mass_matrix(0, x); P, rates = m.momenta(0, x); "
                       "assert all(abs(P[i] - sum(M[i][j]*x[2 + j] for j in range(2))) < 1e-12 for i in range(2)); "
                       "c, dx = m.taylor(0, x), m.rhs(0, x); "
                       "assert all(c[i][0] == x[i] and abs(c[i][1] - dx[i]) < 1e-12 for i in range(4)); "
                       "assert len(m.taylor(0, x, order=3)[0]) == 4");
  if (emit::run_process({"python3", "--version"}).status != 0) return;
  compiles_and_imports(example("two", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"}),
                       "\n"
                       "for f in (m.momenta, m.taylor):\n"
                       "  try: f(0, m.defaults['x'])\n"
                       "  except NotImplementedError as e: assert '--with ' + f.__name__ in str(e)\n"
                       "  else: raise AssertionError(f)\n");
}

TEST_CASE("target python: the module wraps every optional function of the ABI") {
  const Example e = examples()[0];
  const std::string module = emit::emit(e.program, e.context, "python").back().text;
  for (const std::string& name : abi::optional_functions())
    CHECK_MESSAGE(module.find(fmt::format("_{0} = _function(\"{0}\"", name)) != std::string::npos, name);
}

TEST_CASE("target python: the sign of a number whose comparisons cannot be subtracted, as those of NumPy") {
  compiles_and_imports(examples()[0],
                       "\n"
                       "class Truth:\n"
                       "  def __init__(self, of): self.of = of\n"
                       "  def __bool__(self): return self.of\n"
                       "class Number(float):\n"
                       "  def __gt__(self, other): return Truth(float(self) > other)\n"
                       "  def __lt__(self, other): return Truth(float(self) < other)\n"
                       "assert [m._sign(Number(v)) for v in (-2, 0, 3)] == [-1, 0, 1]\n");
}

TEST_CASE("target python: simulate ends with the outcomes of eomgen run") {
  compiles_and_imports(examples()[0],
                       "assert m._ERRORS == {1: 'singular_mass_matrix', 2: 'chart_left', 3: 'friction_no_solution', "
                       "4: 'friction_many_solutions', 5: 'not_finite', 10: 'step_too_small', 11: 'max_steps', "
                       "12: 'diverged'}; assert m.simulate(m.defaults['t'] + 100, max_steps=3).outcome == 'max_steps'");
}

TEST_CASE("target python: inputs that are functions are refused, with what takes them") {
  compiles_and_imports(example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"}),
                       "\n"
                       "for u in (lambda t: [t], {'F': lambda t: t}, [lambda t: t]):\n"
                       "  for call in (lambda: m.simulate(1, u=u), lambda: m.rhs(0, m.defaults['x'], u=u)):\n"
                       "    try: call()\n"
                       "    except TypeError as e: assert 'solve_ivp' in str(e), e\n"
                       "    else: raise AssertionError(u)\n"
                       "assert m.simulate(m.defaults['t'] + 1e-3, u={'F': 2}).outcome == 'done'\n");
}

TEST_CASE("target python: simulate warns of inputs that vary in the scene and are not given") {
  auto e = example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"});
  e.context.varying_inputs = {"F"};
  compiles_and_imports(
      e,
      "\n"
      "import warnings\n"
      "for u, warned in ((None, 1), ({}, 1), ({'F': 2}, 0), ([2], 0)):\n"
      "  with warnings.catch_warnings(record=True) as found:\n"
      "    warnings.simplefilter('always')\n"
      "    m.simulate(m.defaults['t'] + 1e-3, u=u)\n"
      "  assert len([w for w in found if 'vary' in str(w.message) and 'F' in str(w.message)]) == warned, u\n");
}

TEST_CASE("target python: hostile names and texts cause no harm") {
  auto e = example("int", cart_pendulum(), {"I", "lambda"}, {"rhs", "import", "numpy", "main", "None"}, {"class"});
  e.context.title = "\"\"\" + exit(7) #\n%s {} \\";
  e.context.parameters[0].note = "\nexit(8)";
  e.context.parameters[1].unit = "'); exit(9)  # \xff";
  compiles_and_imports(e);
}

TEST_CASE("target python: a dict of parameters also changes dependent parameters, whatever their names") {
  auto e =
      example("dependent", cart_pendulum(), {"I", "lambda"}, {"rhs", "import", "numpy", "main", "None"}, {"class"});
  e.context.parameters[0].expression = "import^2 + if(numpy < 3, main, sqrt(4))";
  e.context.parameters[1].expression = "2*None";
  compiles_and_imports(e,
                       "p = m._parameters({'None': 1.5, 'numpy': 1, 'main': 5}); assert list(p[:2]) == [14, 3], p; "
                       "p = m._parameters({'import': 7, 'numpy': 4}); assert list(p[:2]) == [51, 7], p; "
                       "p = m._parameters([1, 2, 3, 4, 5]); assert list(p) == [1, 2, 3, 4, 5], p");
}

TEST_CASE("target python: compiled code is cached and loaded only in folders that no other user can write to") {
  if (emit::run_process({"python3", "--version"}).status != 0) return;
  const Folder folder, shared;
  const Example e = examples()[0];
  emit::write_files(folder.path, emit::emit(e.program, e.context, "python"));
  const std::string use = fmt::format(
      "import sys; sys.dont_write_bytecode = True; sys.path.insert(0, '{}'); import {} as m; print(m._library._name)",
      folder.path, emit::mangled_id(e.context.id));
  const ScopedEnvironmentVariable cache("EOMGEN_CACHE_DIR", shared.path);
  CHECK(emit::run_process({"python3", "-c", use}).output.starts_with(shared.path));
  CHECK(emit::run_process({"python3", "-c", use}).output.starts_with(shared.path));
  std::filesystem::permissions(shared.path, std::filesystem::perms::all);
  CHECK(emit::run_process({"python3", "-c", use}).output.starts_with(folder.path));
}

TEST_CASE("target python: models named like Python keywords and modules can be imported") {
  for (const char* id : {"json", "numpy", "lambda", "None"}) {
    INFO(id);
    auto e = example(id, pendulum(), {"theta"}, {"m", "l", "g"});
    compiles_and_imports(e, "import json; assert json.loads('[1]') == [1]");
  }
}
