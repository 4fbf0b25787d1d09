// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted code through compilers.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "emit/examples.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

void compiles_everywhere(const Example& e) {
  const Folder folder;
  const auto files = emit::emit(e.program, e.context);
  emit::write_files(folder.path, files);
  const std::string name = emit::mangled_id(e.context.id);
  const std::string c = folder.path + "/" + name + ".c", cpp = folder.path + "/use.cpp";
  std::ofstream(cpp) << fmt::format(
      "#include \"{0}.hpp\"\n#include \"{0}.h\"\n"
      "int main() {{ return eom::{0}::selftest() + {0}_selftest(); }}\n",
      name);
  const std::string object = folder.path + "/object.o", program = folder.path + "/use";
  CHECK(compiler_diagnostics({EOMGEN_TEST_CC, "-std=c11", "-O2", "-c", "-o", object}, {c}) == "");
  CHECK(compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-x", "c++", "-c", "-o", program + ".o"}, {c}) == "");
  CHECK(compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-O2", "-o", program}, {cpp, object, "-lm"}) == "");
  if (emit::run_process({"clang", "--version"}).started) {
    CHECK(compiler_diagnostics({"clang", "-std=c11", "-c", "-o", program + ".o"}, {c}) == "");
    CHECK(compiler_diagnostics({"clang", "-std=c++20", "-x", "c++", "-c", "-o", program + ".o"}, {cpp}) == "");
  }
  CHECK(emit::run_process({program}).status == 0);
}

}  // namespace

TEST_CASE("emitted code: no warnings under strict flags as C and as C++, and its self-tests pass") {
  for (const Example& e : examples()) {
    INFO(e.context.id);
    compiles_everywhere(e);
  }
}

TEST_CASE("emitted code: right-hand sides and series with thousands of operations are split into correct parts") {
  constexpr std::uint32_t n = 22;
  std::vector<std::string> coordinates, parameters;
  for (std::uint32_t i = 1; i <= n; ++i) coordinates.push_back(fmt::format("theta{}", i));
  for (const char* of : {"m", "l"}) {
    for (std::uint32_t i = 1; i <= n; ++i) parameters.push_back(fmt::format("{}{}", of, i));
  }
  parameters.push_back("g");
  const Example e = example("long_chain", chain(n), coordinates, parameters, {}, {"taylor"});
  REQUIRE(e.program.functions[0].code.size() > 3000);
  const Folder folder;
  emit::write_files(folder.path, emit::emit(e.program, e.context));
  const std::string c = folder.path + "/long_chain.c", use = folder.path + "/use.cpp",
                    object = folder.path + "/object.o", program = folder.path + "/use";
  std::ifstream written(c);
  const std::string text{std::istreambuf_iterator<char>(written), {}};
  CHECK(text.find("long_chain_rhs_part2(") != std::string::npos);
  CHECK(text.find("long_chain_taylor_start_part2(") != std::string::npos);
  REQUIRE(e.program.taylor->next.code.size() > 3000);
  CHECK(text.find("long_chain_taylor_next_part2(") != std::string::npos);
  std::ofstream(use) << "#include \"long_chain.hpp\"\n#include \"long_chain.h\"\n"
                        "int main() { return eom::long_chain::selftest() + long_chain_selftest(); }\n";
  CHECK(compiler_diagnostics({EOMGEN_TEST_CC, "-std=c11", "-O1", "-c", "-o", object}, {c}) == "");
  CHECK(compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-o", program}, {use, object, "-lm"}) == "");
  CHECK(emit::run_process({program}).status == 0);
}

TEST_CASE("emitted code: hostile names and texts cause no harm") {
  auto e = example("int", cart_pendulum(), {"I", "NULL"}, {"unix", "linux", "M_PI", "main", "dx"}, {"fabs"});
  e.context.title = "*/ int evil; /* ?\?/ \\";
  e.context.parameters[0].note = "ends in a backslash \\\n#error injected";
  e.context.parameters[1].unit = "\"; system(\"x\"); //*/";
  e.context.verdict = "?\?/?\?'\xff\xfe \xe2\x80\xae";
  e.context.singular = {"%s%n", "// \\"};
  compiles_everywhere(e);
  const auto files = emit::emit(e.program, e.context);
  CHECK(files[0].name == "int_.hpp");
  for (const auto& file : files) {
    for (const char c : file.text)
      CHECK_MESSAGE((static_cast<unsigned char>(c) < 0x7f && (c >= ' ' || c == '\n')), file.name);
    CHECK(file.text.find("??") == std::string::npos);
    CHECK(file.text.find("\\\n") == std::string::npos);
  }
  compiles_everywhere(example("template", double_pendulum(), {"class", "sin"}, {"v1", "v2", "Real", "State", "std"}));
  compiles_everywhere(example("9 lives-%", double_pendulum(), {"x", "x_"}, {"p", "u", "mode", "INT_MAX", "errno"}));
  compiles_everywhere(
      example("eom", cart_pendulum(), {"M", "h"}, {"rhs", "finite", "M_11", "sin_theta", "lambda"}, {"selftest"}));
  compiles_everywhere(example("two", double_pendulum(), {"two_sincos", "sincos"},
                              {"angle", "sine", "eom_sincos", "eom_lanes", "two_bits"}));
}

TEST_CASE("emitted code: no model name collides with a name of the runtime") {
  // Every word of the runtime's headers as the name of a model: if it is unchanged, it can be a namespace next to them.
  const std::filesystem::path lib = EOMGEN_TEST_LIB;
  std::set<std::string> words, headers;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(lib / "eom")) {
    if (entry.path().extension() != ".hpp") continue;
    headers.insert(std::filesystem::relative(entry.path(), lib).string());
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      std::string word;
      for (const char c : line.substr(0, line.find("//")) + " ") {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_')
          word += c;
        else if (!word.empty())
          words.insert(std::exchange(word, ""));
      }
    }
  }
  REQUIRE(words.contains("integrate"));
  std::string text;
  for (const std::string& header : headers) text += "#include \"" + header + "\"\n";
  for (const std::string& word : words) {
    if (std::isdigit(static_cast<unsigned char>(word[0])) == 0 && emit::mangled_id(word) == word)
      text += "namespace eom { using " + word + " = int; }\n";
  }
  // The first error ends the compilation, and the last line is one: no integrator is instantiated for nothing.
  const std::string end = "this line is reached";
  text += "static_assert(false, \"" + end + "\");\n";
  const Folder folder;
  std::ofstream(folder.path + "/use.cpp") << text;
  const std::string said =
      compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-fsyntax-only", "-Wfatal-errors", "-DEOM_COMPILED_RUNTIME",
                            "-I", lib.string(), "-isystem", EOMGEN_TEST_EIGEN},
                           {folder.path + "/use.cpp"});
  CAPTURE(said);
  CHECK(said.find("error: static assertion failed: " + end) != std::string::npos);
  CHECK(said.find("warning:") == std::string::npos);
}

TEST_CASE("emitted code: df/dt may be omitted from the Jacobian, in C and in C++") {
  const Folder folder;
  const Example e = examples()[3];  // its support moves
  emit::write_files(folder.path, emit::emit(e.program, e.context));
  std::ofstream(folder.path + "/use.cpp") << R"(
#include "spherical.hpp"
#include "spherical.h"
int main() {
  double x[6], p[5], all[36], dfdt[6], without[36];
  spherical_defaults(x, p);
  if (spherical_jac(0.5, x, p, nullptr, 0, all, dfdt) != 0 || spherical_jac(0.5, x, p, nullptr, 0, without, nullptr) != 0) return 1;
  for (int i = 0; i < 36; ++i) if (all[i] != without[i]) return 2;
  if (eom::spherical::jac<double>(0.5, x, p, nullptr, 0, without, nullptr) != 0) return 3;
  for (int i = 0; i < 36; ++i) if (!(std::fabs(all[i] - without[i]) <= 1e-12*(1 + std::fabs(all[i])))) return 4;
  return 0;
}
)";
  const std::string object = folder.path + "/object.o", program = folder.path + "/use";
  CHECK(compiler_diagnostics({EOMGEN_TEST_CC, "-std=c11", "-O2", "-c", "-o", object}, {folder.path + "/spherical.c"}) ==
        "");
  CHECK(compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-o", program},
                             {folder.path + "/use.cpp", object, "-lm"}) == "");
  CHECK(emit::run_process({program}).status == 0);
}

TEST_CASE("emitted code: its self test detects entries that are never written, also those that are 0") {
  const Example e = example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"});
  const std::vector<emit::EmittedFile> files = emit::emit(e.program, e.context, "c");
  const std::string code = file_named(files, ".c"), zero = "] = 0.0;";
  const auto status = [&](const std::string& text) {
    const Folder folder;
    emit::write_files(folder.path, {{"cart.c", text}, {"cart.h", file_named(files, ".h")}});
    std::ofstream(folder.path + "/use.c") << "#include \"cart.h\"\nint main(void) { return cart_selftest(); }\n";
    REQUIRE(emit::run_process({EOMGEN_TEST_CC, "-O2", "-o", folder.path + "/use", folder.path + "/use.c",
                               folder.path + "/cart.c", "-lm"})
                .status == 0);
    return emit::run_process({folder.path + "/use"}).status;
  };
  REQUIRE(status(code) == 0);
  std::size_t zeros = 0;
  for (std::size_t at = code.find(zero); at != std::string::npos; at = code.find(zero, at + 1), ++zeros) {
    const std::size_t begin = code.rfind('\n', at), end = code.find('\n', at);
    CAPTURE(code.substr(begin, end - begin));
    CHECK(status(code.substr(0, begin) + code.substr(end)) == 1);
  }
  CHECK(zeros > 2);
}

TEST_CASE("emitted code: -ffast-math is rejected") {
  const Folder folder;
  const Example e = examples()[0];
  emit::write_files(folder.path, emit::emit(e.program, e.context));
  for (const char* flag : {"-ffast-math", "-ffinite-math-only"}) {
    const auto said = compiler_diagnostics({EOMGEN_TEST_CC, "-std=c11", flag, "-c", "-o", folder.path + "/o"},
                                           {folder.path + "/pendulum.c"});
    CHECK(said.find("without -ffast-math") != std::string::npos);
  }
}

TEST_CASE("emitted header: float, long double and a user-defined number type") {
  const Folder folder;
  const Example e = examples()[2];
  emit::write_files(folder.path, emit::emit(e.program, e.context));
  std::ofstream(folder.path + "/use.cpp") << R"(
#include "cart.hpp"
struct Dual {  // a + b eps, eps^2 = 0
  double a = 0, b = 0;
  Dual() = default;
  explicit Dual(double value) : a(value) {}
  Dual(double value, double derivative) : a(value), b(derivative) {}
};
Dual operator+(Dual x, Dual y) { return {x.a + y.a, x.b + y.b}; }
Dual operator-(Dual x, Dual y) { return {x.a - y.a, x.b - y.b}; }
Dual operator-(Dual x) { return {-x.a, -x.b}; }
Dual operator*(Dual x, Dual y) { return {x.a * y.a, x.a * y.b + x.b * y.a}; }
Dual operator/(Dual x, Dual y) { return {x.a / y.a, (x.b - x.a / y.a * y.b) / y.a}; }
bool operator==(Dual x, Dual y) { return x.a == y.a; }
bool operator<=(Dual x, Dual y) { return x.a <= y.a; }
Dual sin(Dual x) { return {std::sin(x.a), std::cos(x.a) * x.b}; }
Dual cos(Dual x) { return {std::cos(x.a), -std::sin(x.a) * x.b}; }
Dual abs(Dual x) { return x.a < 0 ? -x : x; }

namespace model = eom::cart;
template <class Real>
bool agrees(double tolerance) {
  double x[4], p[5], dx[4];
  model::defaults(x, p);
  if (model::rhs<double>(0, x, p, nullptr, 0, dx) != 0) return false;
  Real X[4], P[5], DX[4];
  model::defaults(X, P);
  if (model::rhs<Real>(Real(0), X, P, nullptr, 0, DX) != 0) return false;
  for (std::size_t i = 0; i < model::state_count; ++i) {
    if (!(std::fabs(static_cast<double>(DX[i]) - dx[i]) <= tolerance * (1 + std::fabs(dx[i])))) return false;
  }
  return true;
}
int main() {
  if (!agrees<float>(1e-5) || !agrees<long double>(1e-13)) return 1;
  double x[4], p[5], dfdx[16], dfdt[4];
  model::defaults(x, p);
  model::jac<double>(0, x, p, nullptr, 0, dfdx, dfdt);
  for (std::size_t j = 0; j < 4; ++j) {  // the Jacobian by dual numbers
    Dual X[4], P[5], DX[4];
    model::defaults(X, P);
    X[j].b = 1;
    if (model::rhs<Dual>(Dual(0), X, P, nullptr, 0, DX) != 0) return 2;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!(std::fabs(DX[i].b - dfdx[i + 4 * j]) <= 1e-12)) return 3;
    }
  }
  const model::Prepared<double> prepared(p);
  double dx[4], again[4];
  if (model::rhs<double>(0, x, p, nullptr, 0, dx) != 0 || prepared(0, x, nullptr, 0, again) != 0) return 5;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(std::fabs(dx[i] - again[i]) <= 1e-12 * (1 + std::fabs(dx[i])))) return 6;
  }
  p[model::Parameter::l] = 0;
  if (model::Prepared<double>(p)(0, x, nullptr, 0, again) != 1) return 7;
  return x[model::State::theta_dot] == x[3] ? 0 : 4;
}
)";
  const std::string program = folder.path + "/use";
  CHECK(compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-o", program}, {folder.path + "/use.cpp"}) == "");
  CHECK(emit::run_process({program}).status == 0);
}

TEST_CASE(
    "emitted code: Taylor series compile cleanly, and the header's agree with the C function's, in long double too") {
  auto list = {example("chain3", chain(3), {"k", "x", "w"}, {"m1", "a", "b", "l1", "z", "dx", "g"}, {}, {"taylor"}),
               example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"}, {"taylor", "mass"})};
  for (const Example& e : list) {
    INFO(e.context.id);
    compiles_everywhere(e);
    const Folder folder;
    emit::write_files(folder.path, emit::emit(e.program, e.context));
    std::ofstream(folder.path + "/use.cpp") << fmt::format(R"(
#include "{0}.hpp"
#include "{0}.h"
namespace model = eom::{0};
int main() {{
  constexpr int order = 20, n = model::state_count;
  double x[n], p[model::parameter_count], c[n*(order + 1)], d[n*(order + 1)], dx[n];
  long double X[n], P[model::parameter_count], C[n*(order + 1)];
  model::defaults(x, p);
  model::defaults(X, P);
  if ({0}_taylor(0, x, p, nullptr, 0, order, c) != 0 || model::taylor<double>(0, x, p, nullptr, 0, order, d) != 0) return 1;
  if (model::taylor<long double>(0, X, P, nullptr, 0, order, C) != 0 || model::rhs<double>(0, x, p, nullptr, 0, dx) != 0) return 2;
  for (int k = 0; k <= order; ++k) {{
    double largest = 1e-300;  // largest magnitude of one order
    for (int i = 0; i < n; ++i) largest = std::fmax(largest, std::fabs(c[n*k + i]));
    for (int i = 0; i < n; ++i) {{
      if (!(std::fabs(c[n*k + i] - d[n*k + i]) <= 1e-12*largest)) return 3;
      if (!(std::fabs(c[n*k + i] - static_cast<double>(C[n*k + i])) <= 1e-10*largest)) return 4;
    }}
  }}
  for (int i = 0; i < n; ++i) if (x[i] != c[i] || !(std::fabs(c[n + i] - dx[i]) <= 1e-13*(1 + std::fabs(dx[i])))) return 5;
  if ({0}_taylor(0, x, p, nullptr, 0, {0}_taylor_order + 1, c) != 6 || {0}_taylor(0, x, p, nullptr, 0, 0, c) != 0) return 6;
  x[n - 1] = 1e300;
  return {0}_taylor(0, x, p, nullptr, 0, order, c) == 5 ? 0 : 7;
}}
)",
                                                           e.context.id);
    const std::string object = folder.path + "/object.o", program = folder.path + "/use";
    CHECK(compiler_diagnostics({EOMGEN_TEST_CC, "-std=c11", "-O2", "-c", "-o", object},
                               {folder.path + "/" + e.context.id + ".c"}) == "");
    CHECK(compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-o", program},
                               {folder.path + "/use.cpp", object, "-lm"}) == "");
    CHECK(emit::run_process({program}).status == 0);
  }
}

TEST_CASE("emitted code: codes 1 and 5 distinguish singular from not finite") {
  const Folder cache;
  const ScopedEnvironmentVariable setting("EOMGEN_CACHE_DIR", cache.path);
  const Example e = examples()[1];
  const auto files = emit::emit(e.program, e.context, "c");
  const auto compiled = emit::compile_and_load(files[0].text, files[1].text, "double_pendulum");
  double x[4] = {0.3, 0.3, 0.1, 0.2}, p[5] = {1, 1, 1, 1, 9.81}, dx[4];
  CHECK(compiled.model.rhs(0, x, p, nullptr, 0, dx) == 0);
  p[0] = 0;
  CHECK(compiled.model.rhs(0, x, p, nullptr, 0, dx) == 1);
  p[0] = 1;
  p[2] = 0;
  CHECK(compiled.model.rhs(0, x, p, nullptr, 0, dx) == 1);
  p[2] = 1;
  x[2] = std::nan("");
  CHECK(compiled.model.rhs(0, x, p, nullptr, 0, dx) == 5);
  x[1] = 1;
  x[2] = 1e200;
  CHECK(compiled.model.rhs(0, x, p, nullptr, 0, dx) == 5);
}

TEST_CASE("emitted code: compiled functions agree with the interpreter in 50 digits") {
  const Folder cache;
  const ScopedEnvironmentVariable setting("EOMGEN_CACHE_DIR", cache.path);
  for (const Example& e : examples()) {
    INFO(e.context.id);
    const auto files = emit::emit(e.program, e.context, "c");
    const auto compiled = emit::compile_and_load(files[0].text, files[1].text, e.context.id);
    const auto& m = compiled.model;
    const auto& test = e.context.tests[1];
    const double* u = test.u.empty() ? nullptr : test.u.data();
    program::Arguments<cln::cl_R> exact{numeric::exact(test.t), {}, {}, {}};
    for (const double value : test.x) exact.x.push_back(numeric::exact(value));
    for (const double value : test.p) exact.p.push_back(numeric::exact(value));
    for (const double value : test.u) exact.u.push_back(numeric::exact(value));
    for (const auto& function : e.program.functions) {
      auto arguments = exact;
      if (function.name == "rhs_prepared")
        arguments.w = program::interpret(e.program.functions.rbegin()[1], exact, 60).results[0];
      const bool no_inputs = function.name == "mass" || function.name == "constraints";
      for (std::size_t i = 0; i < arguments.u.size() && no_inputs; ++i)
        arguments.u[i] = numeric::exact(e.context.inputs[i].value);
      const auto expected = program::interpret(function, arguments, 50).results;
      std::vector<std::vector<double>> got;
      for (const auto& list : expected) got.emplace_back(list.size() + 1);
      std::vector<double> w(e.program.prepared_count() + 1);
      abi::CallArguments given;
      given.t = test.t, given.x = test.x.data(), given.p = test.p.data(), given.u = u, given.w = w.data();
      for (std::size_t r = 0; r < got.size(); ++r) given.results[r] = got[r].data();
      if (function.name == "rhs_prepared") CHECK(m.prepare(given.p, w.data()) == 0);
      CHECK(m.call(function.name, given) == 0);
      for (std::size_t r = 0; r < expected.size(); ++r) {
        for (std::size_t i = 0; i < expected[r].size(); ++i) {
          const double value = cln::double_approx(expected[r][i]);
          CHECK(std::abs(got[r][i] - value) <= tolerances::unrolled_solve * (1 + std::abs(value)));
        }
      }
    }
  }
}

TEST_CASE("emitted code: right-hand sides at angles after ten thousand revolutions, and at infinite angles") {
  const Folder cache;
  const ScopedEnvironmentVariable setting("EOMGEN_CACHE_DIR", cache.path);
  const Example e = examples()[1];
  const auto files = emit::emit(e.program, e.context, "c");
  const auto compiled = emit::compile_and_load(files[0].text, files[1].text, e.context.id);
  program::Arguments<cln::cl_R> exact{numeric::exact(0), {}, {}, {}};
  for (const double value : e.context.tests[0].p) exact.p.push_back(numeric::exact(value));
  for (const auto& [first, second] : {std::pair{70000.25, 0.5}, {0.5, -3e5}, {1e9, 65536.5}, {1e15, -1e15}}) {
    const double x[4] = {first, second, 0.25, -0.5};
    exact.x.clear();
    for (const double value : x) exact.x.push_back(numeric::exact(value));
    double dx[4];
    CHECK(compiled.model.rhs(0, x, e.context.tests[0].p.data(), nullptr, 0, dx) == 0);
    const auto expected = program::interpret(e.program.functions[0], exact, 60).results[0];
    for (std::size_t i = 0; i < 4; ++i) {
      const double value = cln::double_approx(expected[i]);
      CHECK(std::abs(dx[i] - value) <= tolerances::unrolled_solve * (1 + std::abs(value)));
    }
  }
  const double x[4] = {0.5, std::numeric_limits<double>::infinity(), 0.25, -0.5};
  double dx[4];
  CHECK(compiled.model.rhs(0, x, e.context.tests[0].p.data(), nullptr, 0, dx) == 5);
}
