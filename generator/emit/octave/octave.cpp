// SPDX-License-Identifier: GPL-3.0-or-later
// Target octave: NAME.m, a function for Octave and MATLAB that returns the functions and names of the model.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "abi/functions.hpp"
#include "emit/languages/language.hpp"
#include "emit/metadata.hpp"
#include "emit/names.hpp"
#include "emit/self_test.hpp"
#include "emit/signature.hpp"
#include "emit/single_precision.hpp"
#include "emit/targets.hpp"
#include "emit/text.hpp"
#include "program/internal_functions.hpp"
#include "skeletons/octave_model_m.hpp"

namespace eomgen::emit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t longest_octave_name = 63;  // namelengthmax of MATLAB

// Keywords of Octave and MATLAB, functions that the code calls, and functions of the file.
// clang-format off
constexpr std::string_view octave_words[] = {
    "arguments", "elseif", "end", "end_try_catch", "end_unwind_protect", "endclassdef", "endenumeration", "endevents",
    "endfor", "endfunction", "endif", "endmethods", "endparfor", "endproperties", "endswitch", "endwhile",
    "enumeration", "events", "function", "global", "methods", "otherwise", "parfor", "persistent", "properties", "spmd",
    "until", "unwind_protect", "unwind_protect_cleanup", "classdef", "import", "ans", "nargin", "nargout", "NaN", "Inf",
    "zeros", "single", "isempty", "numel", "any", "mod", "power", "real_sqrt", "real_log", "real_pow", "real_acos",
    "real_asin", "choose", "slides", "normal_sign", "side", "differs", "default_parameters", "default_inputs",
    "selftest", "defaults", "ode45", "lsode", "struct", "clear", "clc", "close", "disp", "plot", "figure", "eval",
    "code"};
// clang-format on

std::string octave_number(double value) { return number_or(value, "NaN", "Inf", "-Inf"); }

std::string octave_single_number(double value) { return octave_number(to_single(value)); }

Language octave_language(bool single_precision) {
  Language language;
  Dialect& dialect = language.dialect;
  set_numbers<octave_number>(dialect, "3.141592653589793");
  if (single_precision) {
    set_numbers<octave_single_number>(dialect, "3.141592653589793");
    dialect.pivot_tolerance = single_dialect().pivot_tolerance;
    language.conversion = "single";
  }
  dialect.abs_function = "abs";
  dialect.is_typed = false;
  dialect.conditional = [](const std::string& a, const std::string& b, const std::string& x, const std::string& y) {
    return fmt::format("choose({} < {}, {}, {})", a, b, x, y);
  };
  dialect.element = [](const std::string& array, std::size_t index) { return fmt::format("{}({})", array, index + 1); };
  dialect.function_name = real_function;
  language.comment = "% ";
  language.declaration = [](const std::string& name, const std::string& value) {
    return fmt::format("{} = {};", name, value);
  };
  language.stop = [](const std::string& condition, int code) {
    return fmt::format("if {}, code = {}; return, end", condition, code);
  };
  language.negation = [](const std::string& condition) { return fmt::format("~({})", condition); };
  language.reserved = octave_words;
  language.longest_name = longest_octave_name;
  return language;
}

/// Text between single quotes, in ASCII.
std::string octave_text(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\'') result += '\'';
    result += byte < 0x20 || byte >= 0x7f ? '?' : c;
  }
  return result + "'";
}

std::string octave_column(const std::vector<double>& values) {
  return values.empty() ? "zeros(0, 1)" : "[" + joined(values, octave_number, "; ") + "]";
}

std::string octave_cells(const Json& names) { return "{" + joined(names, octave_text) + "}"; }

/// Long text as a row of literals over several lines.
std::string octave_long_text(const std::string& text) {
  constexpr std::size_t width = 100;
  std::string result = "[";
  for (std::size_t at = 0; at < text.size() || at == 0; at += width)
    result += fmt::format("{}{}", at == 0 ? "" : " ...\n    ", octave_text(text.substr(at, width)));
  return result + "]";
}

/// Rows of a matrix result; 0: a column.
std::size_t octave_rows(const std::string& function, std::size_t result, const program::Program& program) {
  if (function == "jac" && result == 0) return program.state_count();
  if (function == "jac_p" || function == "jac_u") return program.state_count();
  if (function == "coriolis") return program.free.size();
  if (function == "regressor" && result == 0) return program.free.size();
  if (function == "momentum" && result == 0) return 6;
  if (function.starts_with("outputs_jac") && result == 0) return program.outputs.size();
  if (function.starts_with("reactions_jac") && result == 0) return program.reactions.size();
  if (function == "mass" && result == 0) return program.free.size();
  if (function == "constraints" && result == 1) return program.active_constraints;
  return 0;
}

std::string octave_results(const program::Function& function, const FunctionText& text, const program::Program& program,
                           bool single_precision) {
  std::string result;
  std::size_t k = 0, place = 0;
  for (const program::Result& entry : function.results) {
    ++place;
    if (entry.is_test()) continue;
    const std::size_t rows = octave_rows(function.name, place - 1, program), all = entry.entries.size();
    const std::string shape = rows == 0 ? fmt::format("{}, 1", all) : fmt::format("{}, {}", rows, all / rows);
    const std::string unset = fmt::format("NaN({})", shape);
    result += fmt::format("  {} = {};\n", text.results[k++], single_precision ? "single(" + unset + ")" : unset);
  }
  return result;
}

std::string octave_definition(const program::Function& function, const program::Program& program,
                              const ModelNames& names, const EmissionContext& context, const Language& language) {
  const FunctionText text = print_statements(function, names, context, language);
  const bool single_precision = context.single_error.has_value();
  std::string list, defaults;
  std::size_t place = 0;
  const auto missing = [&](const std::string& name, const std::string& value) {
    defaults += fmt::format("  if nargin < {0} || isempty({1}), {1} = {2}; end\n", place, name, value);
  };
  for (const Argument& argument : arguments(function.name, text, names)) {
    if (argument.kind == Argument::Kind::result) continue;
    list += (list.empty() ? "" : ", ") + argument.name;
    ++place;
    if (argument.slot == program::Slot::parameter && argument.kind == Argument::Kind::input)
      missing(argument.name, "default_parameters()");
    if (argument.slot == program::Slot::input) missing(argument.name, "default_inputs()");
    if (argument.kind == Argument::Kind::mode)
      missing(argument.name, fmt::format("zeros({}, 1)", program.mode_layout().size()));
    if (argument.kind == Argument::Kind::number && single_precision)
      defaults += fmt::format("  {0} = single({0});\n", argument.name);
  }
  return fmt::format("function [{}, code] = {}({})\n  % {}\n{}{}  code = 0;\n{}end\n", fmt::join(text.results, ", "),
                     function.name, list, comment_text(function_purpose(function.name)), defaults,
                     octave_results(function, text, program, single_precision), text.body);
}

std::string octave_comparison(const FunctionValues& f, std::size_t state) {
  std::string results, inputs, differences;
  for (std::size_t r = 0; r < f.values.size(); ++r) {
    results += fmt::format("y{}, ", r + 1);
    differences +=
        fmt::format(" || differs(y{}, {}, {})", r + 1, octave_column(f.values[r]), octave_number(f.tolerances[r]));
  }
  bool prepared = false;
  for (const abi::Input input : abi::find(f.function)->inputs) {
    inputs += (inputs.empty() ? "" : ", ") + std::string(abi::name(input));
    prepared = prepared || input == abi::Input::prepared;
  }
  return fmt::format("{}  [{}code] = {}({});\n  if code ~= 0{}, first = {}; return, end\n",
                     prepared ? "  w = prepare(p);\n" : "", results, f.function, inputs, differences, state);
}

std::string octave_selftest(const program::Program& program, const EmissionContext& context) {
  std::string text;
  if (begins_with_defaults(context, context.single_error.has_value()) && !context.tests.empty()) {
    text += fmt::format("  [x, p] = defaults();\n  if any(x ~= {}) || any(p ~= {}), first = 1; return, end\n",
                        octave_column(context.tests[0].x), octave_column(context.tests[0].p));
  }
  for (std::size_t k = 0; k < context.tests.size(); ++k) {
    const TestVector& test = context.tests[k];
    std::vector<double> mode(test.mode.begin(), test.mode.end());
    mode.resize(program.mode_layout().size());
    text += fmt::format("  t = {}; x = {}; p = {}; u = {}; mode = {};\n", octave_number(test.t), octave_column(test.x),
                        octave_column(test.p), octave_column(test.u), octave_column(mode));
    if (!test.v.empty()) text += fmt::format("  v = {};\n", octave_column(test.v));
    for (const FunctionValues& f : test.functions) text += octave_comparison(f, k + 1);
  }
  return text;
}

}  // namespace

std::string octave_name(const std::string& id) {
  const std::string name = id_beside(id, octave_words);
  if (name.size() <= longest_octave_name) return name;
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return fmt::format("{}_{:08x}", name.substr(0, longest_octave_name - 9), hash & 0xffffffffu);
}

std::vector<EmittedFile> emit_octave(const program::Program& program, const EmissionContext& context) {
  require_consistent(program, context);
  require_plain(program, "octave");
  require_no_start(context, "octave", ", or use the target c, javascript or rust");
  const std::string name = octave_name(context.id);
  const bool single_precision = context.single_error.has_value();
  const Language language = octave_language(single_precision);
  const ModelNames names = model_names(program, context, octave_words, longest_octave_name);
  std::vector<std::vector<std::pair<std::string, std::string>>> functions;
  std::string handles;
  for (const program::Function& function : program.functions) {
    functions.push_back({{"definition", octave_definition(function, program, names, context, language)}});
    handles += fmt::format("  model.{0} = @{0};\n", function.name);
  }
  const Json info = Json::parse(info_json(program, context));
  const auto rounded = [&](std::vector<double> list) {
    for (double& value : list) value = single_precision ? to_single(value) : value;
    return octave_column(list);
  };
  const std::vector<std::pair<std::string, std::string>> values = {
      {"banner", banner(program, context, "  % ", "  % ", "")},
      {"name", name},
      {"abi", std::to_string(abi::version)},
      {"states", octave_cells(info.at("states"))},
      {"parameters", octave_cells(info.at("parameters"))},
      {"inputs", octave_cells(info.at("inputs"))},
      {"outputs", octave_cells(Json(program.outputs))},
      {"reactions", octave_cells(Json(program.reactions))},
      {"info", octave_long_text(info.dump(-1, ' ', true, Json::error_handler_t::replace))},
      {"handles", handles},
      {"x", rounded(context.start)},
      {"p", rounded(values_of(context.parameters))},
      {"u", rounded(values_of(context.inputs))},
      {"selftest", octave_selftest(program, context)}};
  return {{name + ".m", render_template(skeleton::octave_model_m, values, functions)}};
}

}  // namespace eomgen::emit
