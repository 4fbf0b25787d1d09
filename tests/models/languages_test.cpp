// SPDX-License-Identifier: GPL-3.0-or-later
// Targets outside the C family compute the same values as the C code of the same program. Each language of the table
// writes a program that prints the largest difference of each model.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "emit/shared_library/process.hpp"
#include "emit/targets.hpp"
#include "emit/write_files.hpp"
#include "models/function_calls.hpp"
#include "numeric/numbers.hpp"
#include "pipeline/start_description.hpp"
#include "support/temporary_folder.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

bool is_installed(const std::vector<std::string>& version) {
  const emit::ProcessResult tried = emit::run_process(version);
  if (tried.started && tried.status == 0) return true;
  MESSAGE("skipped: there is no ", version.front());
  return false;
}

constexpr double allowed_between_languages = 1e-12;  // of the largest entry of an array

/// Numbers with 17 digits in this separation; what is not finite is `none`.
std::string listed(const std::vector<double>& values, const char* separator) {
  std::string text;
  for (const double value : values) {
    text += text.empty() ? "" : separator;
    text += std::isfinite(value) ? fmt::format("{:.17e}", value) : "0.0";
  }
  return text;
}

std::string rust_program(const std::vector<ComparedModel>& models) {
  std::string text = R"(fn off(got: &[f64], expected: &[f64]) -> f64 {
  let largest = expected.iter().fold(1e-300f64, |most, value| most.max(value.abs()));
  got.iter().zip(expected).fold(0.0, |most, (a, b)| {
    let d = (a - b).abs() / largest;
    if d <= most { most } else if d.is_nan() { 1.0 } else { d }
  })
}
)";
  std::string body;
  for (const ComparedModel& model : models) {
    const std::string name = emit::rust_name(model.context.id);
    text += fmt::format("mod {};\n", name);
    body += fmt::format("  let mut most: f64 = {}::selftest() as f64;\n", name);
    for (const FunctionCall& call : model.calls) {
      const abi::Function& function = *abi::find(call.name);
      std::vector<double> mode(call.at->mode.begin(), call.at->mode.end());
      std::string arguments, arrays, comparisons;
      for (const abi::Input input : function.inputs) {
        arguments += arguments.empty() ? "" : ", ";
        if (input == abi::Input::time) arguments += fmt::format("{:.17e}", call.at->t);
        if (input == abi::Input::state) arguments += fmt::format("&[{}]", listed(call.at->x, ", "));
        if (input == abi::Input::parameters) arguments += fmt::format("&[{}]", listed(call.at->p, ", "));
        if (input == abi::Input::inputs)
          arguments += call.at->u.empty() ? "None" : fmt::format("Some(&[{}])", listed(call.at->u, ", "));
        if (input == abi::Input::mode)
          arguments += mode.empty() ? "None" : fmt::format("Some(&[{}])", fmt::join(call.at->mode, ", "));
        if (abi::is_vector(input)) arguments += fmt::format("&[{}]", listed(call.v, ", "));
      }
      for (std::size_t r = 0; r < call.results.size(); ++r) {
        arrays += fmt::format("let mut y{} = [0f64; {}]; ", r, call.results[r].size());
        arguments +=
            function.results[r].may_be_null ? fmt::format(", Some(&mut y{})", r) : fmt::format(", &mut y{}", r);
        if (call.code == 0)
          comparisons += fmt::format("most = most.max(off(&y{}, &[{}])); ", r, listed(call.results[r], ", "));
      }
      body += fmt::format("  {{ {}if {}::{}({}) != {} {{ most = 1.0; }} {}}}\n", arrays, name, call.name, arguments,
                          call.code, comparisons);
    }
    body += fmt::format("  println!(\"{} {{:e}}\", most);\n", name);
  }
  return text + "fn main() {\n" + body + "}\n";
}

std::string octave_program(const std::vector<ComparedModel>& models) {
  std::string text = R"(1;
function most = off(most, got, expected)
  most = max([most, max(abs(got(:) - expected(:)))/max([1e-300, max(abs(expected))])]);
  if any(isnan(got(:))), most = 1; end
end
)";
  for (const ComparedModel& model : models) {
    const std::string name = emit::octave_name(model.context.id);
    text += fmt::format("m = {}();\nmost = m.selftest();\n", name);
    for (const FunctionCall& call : model.calls) {
      std::vector<double> mode(call.at->mode.begin(), call.at->mode.end());
      std::string arguments, results, comparisons;
      for (const abi::Input input : abi::find(call.name)->inputs) {
        arguments += arguments.empty() ? "" : ", ";
        if (input == abi::Input::time) arguments += fmt::format("{:.17e}", call.at->t);
        if (input == abi::Input::state) arguments += fmt::format("[{}]", listed(call.at->x, "; "));
        if (input == abi::Input::parameters) arguments += fmt::format("[{}]", listed(call.at->p, "; "));
        if (input == abi::Input::inputs) arguments += fmt::format("[{}]", listed(call.at->u, "; "));
        if (input == abi::Input::mode) arguments += fmt::format("[{}]", listed(mode, "; "));
        if (abi::is_vector(input)) arguments += fmt::format("[{}]", listed(call.v, "; "));
      }
      for (std::size_t r = 0; r < call.results.size(); ++r) {
        results += fmt::format("y{}, ", r);
        if (call.code == 0 && !call.results[r].empty())
          comparisons += fmt::format("most = off(most, y{}, [{}]);\n", r, listed(call.results[r], "; "));
      }
      text += fmt::format("[{}code] = m.{}({});\nif code ~= {}, most = 1; end\n{}", results, call.name, arguments,
                          call.code, comparisons);
    }
    text += fmt::format("printf('{} %g\\n', most);\n", name);
  }
  return text;
}

std::string bracketed(const std::vector<double>& values) { return "[" + listed(values, ", ") + "]"; }

const char* const evaluators = "import sys\nsys.dont_write_bytecode = True\nsys.path.insert(0, '" EOMGEN_TEST_EVALUATORS
                               "')\nfrom evaluators import Array, julia, modelica, off\n";

std::string julia_program(const std::vector<ComparedModel>& models) {
  std::string text = evaluators;
  for (const ComparedModel& model : models) {
    const std::string name = emit::julia_name(model.context.id);
    text += fmt::format("m = julia('{}.jl')\nmost = m['selftest']()\n", name);
    for (const FunctionCall& call : model.calls) {
      std::vector<double> mode(call.at->mode.begin(), call.at->mode.end());
      const abi::Function& function = *abi::find(call.name);
      std::string results, values, time, keywords, comparisons;
      for (std::size_t r = 0; r < call.results.size(); ++r) {
        text += fmt::format("y{} = Array([0.0]*{})\n", r, call.results[r].size());
        if (function.results[r].may_be_null)
          keywords += fmt::format(", {}=y{}", function.results[r].name, r);
        else
          results += fmt::format("{}y{}", results.empty() ? "" : ", ", r);
        if (call.code == 0)
          comparisons += fmt::format("most = max(most, off(y{}, {}))\n", r, bracketed(call.results[r]));
      }
      for (const abi::Input input : function.inputs) {
        if (input == abi::Input::time) time = fmt::format(", {:.17e}", call.at->t);
        if (input == abi::Input::state) values += fmt::format(", Array({})", bracketed(call.at->x));
        if (input == abi::Input::parameters) values += fmt::format(", Array({})", bracketed(call.at->p));
        if (input == abi::Input::inputs && !call.at->u.empty())
          keywords += fmt::format(", u=Array({})", bracketed(call.at->u));
        if (input == abi::Input::mode && !mode.empty()) keywords += fmt::format(", mode=Array({})", bracketed(mode));
        if (abi::is_vector(input)) values += fmt::format(", Array({})", bracketed(call.v));
      }
      text += fmt::format("if m['{}_b']({}{}{}{}) != {}: most = 1\n{}", call.name, results, values, time, keywords,
                          call.code, comparisons);
    }
    text += fmt::format("print('{}', most)\n", name);
  }
  return text;
}

std::string modelica_program(const std::vector<ComparedModel>& models) {
  std::string text = evaluators;
  for (const ComparedModel& model : models) {
    const std::string name = emit::modelica_name(model.context.id);
    text += fmt::format("m = modelica('{}.mo')\nmost = off([*m.states.values()], {})\n", name,
                        bracketed(model.context.start));
    for (const FunctionCall& call : model.calls) {
      const auto frozen = [](int entry) { return entry != 0; };  // branches follow the state in Modelica
      if (call.name != "rhs" || call.code != 0 || std::any_of(call.at->mode.begin(), call.at->mode.end(), frozen))
        continue;
      text += fmt::format("dx, code = m.derivatives({:.17e}, {}, {}, {})\nmost = max(most, code, off(dx, {}))\n",
                          call.at->t, bracketed(call.at->x), bracketed(call.at->p), bracketed(call.at->u),
                          bracketed(call.results[0]));
    }
    text += fmt::format("print('{}', most)\n", name);
  }
  return text;
}

struct ComparedLanguage {
  const char* target;
  std::vector<std::string> version;  // a command that succeeds if the language is installed
  const char* file;
  std::string (*program)(const std::vector<ComparedModel>& models);
  const char* run;           // in the folder
  bool has_contacts = true;  // false: it refuses models with contacts
};

const std::vector<ComparedLanguage> languages = {
    {"rust", {"rustc", "--version"}, "main.rs", rust_program, "rustc --edition 2021 -o main main.rs && ./main"},
    {"octave",
     {"octave-cli", "--norc", "--no-history", "--eval", "1;"},
     "main.m",
     octave_program,
     "octave-cli --norc --no-history main.m"},
    {"julia", {"python3", "--version"}, "main.py", julia_program, "python3 main.py"},
    {"modelica", {"python3", "--version"}, "main.py", modelica_program, "python3 main.py", false}};

}  // namespace

TEST_CASE(
    "languages: every function gives what the C of the same program gives, of points, bodies, loops, kinks, "
    "contacts and chains") {
  std::vector<ComparedModel> models;
  for (const char* name :
       {"P2_planar_pendulum", "P4_moving_cone", "P14_kepler_spherical", "S5_double_pendulum_cartesian", "S6_chain_6",
        "R1_free_body_euler_parameters", "R6_rough_disk", "R10_lagrange_top", "R18_rodrigues", "bilinear_oscillator",
        "cart_pendulum", "knife_edge", "n_four_bar_2", "stick_slip_belt"})
    models.push_back(compared_model(name, {"jac",         "jac_p",         "jac_u",         "jvp",
                                           "vjp",         "adjoint",       "hvp",           "inverse",
                                           "coriolis",    "gravity",       "mass",          "constraints",
                                           "reactions",   "events",        "frames",        "energy_gradients",
                                           "regressor",   "momentum",      "reactions_jac", "reactions_jac_p",
                                           "outputs_jac", "outputs_jac_p", "outputs_jac_u"},
                                    {"energy", "kinetic"}));
  for (ComparedModel& model : models) {
    call_c(model);
    CHECK(model.calls.size() >= 8);
  }
  for (const ComparedLanguage& language : languages) {
    INFO(language.target);
    if (!is_installed(language.version)) continue;
    const TemporaryFolder folder;
    std::vector<emit::EmittedFile> files;
    std::vector<ComparedModel> stated;
    for (const ComparedModel& model : models) {
      const bool contacts = !model.program.contacts.empty() || !model.program.contact_set.empty();
      if (contacts && !language.has_contacts) {
        CHECK_THROWS_AS(emit::emit(model.program, model.context, language.target), Error);
        continue;
      }
      files.push_back(emit::emit(model.program, model.context, language.target).front());
      stated.push_back(model);
    }
    files.push_back({language.file, language.program(stated)});
    emit::write_files(folder.path, files);
    const emit::ProcessResult finished = emit::run_process({"sh", "-c", "cd '" + folder.path + "' && " + language.run});
    CAPTURE(finished.output);
    REQUIRE(finished.status == 0);
    std::istringstream lines(finished.output);
    std::string name;
    double off = 1;
    std::size_t count = 0;
    for (; lines >> name >> off; ++count) CHECK_MESSAGE(off <= allowed_between_languages, name);
    CHECK(count == stated.size());
  }
}

TEST_CASE("languages: start in Rust completes t, x and p as a run does, with each parameter changed") {
  if (!is_installed({"rustc", "--version"})) return;
  const TemporaryFolder folder;
  std::string modules, body;
  std::vector<emit::EmittedFile> files;
  std::vector<std::vector<double>> expected;
  for (const char* name : {"P7_moving_sphere", "S5_double_pendulum_cartesian", "R1_free_body_euler_parameters",
                           "R6_rolling_disk", "R15_ball_joint", "cart_pendulum", "n_four_bar_2", "stick_slip_belt"}) {
    ComparedModel model = compared_model(name, {}, {});
    pipeline::DerivedModel& derived = *model.derived;
    model.context.start_functions = pipeline::describe_start(derived, derived.model.scene("default"));
    REQUIRE(model.context.start_functions);
    files.push_back(emit::emit(model.program, model.context, "rust").front());
    const std::string module = emit::rust_name(model.context.id);
    modules += fmt::format("mod {};\n", module);
    body += fmt::format("  assert_eq!({}::selftest(), 0);\n", module);
    const system::EquationSystem& system = derived.candidates.front();
    for (std::size_t i = 0; i <= derived.model.parameters.size(); ++i) {
      const bool changed = i > 0;
      if (changed && (derived.model.parameters[i - 1].initial_value_of || derived.model.start_time == i - 1)) continue;
      run::Overrides overrides;
      const double value = changed ? 1.0625 * model.context.parameters[i - 1].value : 0;
      if (changed) overrides.values[derived.model.parameters[i - 1].name] = cln::rational(cln::cl_DF(value));
      std::vector<double> row;
      std::string code = "0";
      try {
        const run::Scene scene =
            run::resolve_scene(derived.mechanics, system, derived.model.scene("default"), overrides);
        row = {0, scene.t0, scene.t1};
        for (const std::uint32_t k : system.free) row.push_back(scene.q[k]);
        for (const std::uint32_t k : system.free) row.push_back(scene.qdot[k]);
        row.insert(row.end(), scene.z.begin(), scene.z.end());
        row.insert(row.end(), scene.parameters.begin(), scene.parameters.end());
      } catch (const Error&) {
        row = {7};  // or 8: refused
      }
      expected.push_back(row);
      body += fmt::format(
          "  {{\n    use {} as m;\n    let {}given = [0; m::STATES + m::PARAMETERS + 2];\n"
          "    let (mut t, mut x, mut p) = ([f64::NAN; 2], [f64::NAN; m::STATES], [f64::NAN; m::PARAMETERS]);\n",
          module, changed ? "mut " : "");
      if (changed) body += fmt::format("    given[m::STATES + {0}] = 1;\n    p[{0}] = {1:.17e};\n", i - 1, value);
      body +=
          "    print!(\"{}\", m::start(Some(&given), &mut t, &mut x, &mut p, None));\n"
          "    for value in t.iter().chain(&x).chain(&p) { print!(\" {:e}\", value); }\n    println!();\n  }\n";
    }
  }
  files.push_back({"main.rs", modules + "fn main() {\n" + body + "}\n"});
  emit::write_files(folder.path, files);
  const emit::ProcessResult finished =
      emit::run_process({"sh", "-c", "cd '" + folder.path + "' && rustc --edition 2021 -O -o main main.rs && ./main"});
  CAPTURE(finished.output);
  REQUIRE(finished.status == 0);
  std::istringstream lines(finished.output);
  std::string line;
  std::size_t count = 0;
  for (; std::getline(lines, line); ++count) {
    REQUIRE(count < expected.size());
    const std::vector<double>& row = expected[count];
    std::istringstream words(line);
    std::vector<double> found;
    for (std::string word; words >> word;) found.push_back(std::strtod(word.c_str(), nullptr));
    if (row.size() == 1) {
      CHECK(found[0] >= 7);
      continue;
    }
    REQUIRE(found.size() == row.size());
    CHECK(found[0] == 0);
    double largest = 1e-300;
    for (const double value : row) largest = std::max(largest, std::abs(value));
    for (std::size_t k = 1; k < row.size(); ++k) CHECK(std::abs(found[k] - row[k]) <= 1e-9 * largest);
  }
  CHECK(count == expected.size());
}
