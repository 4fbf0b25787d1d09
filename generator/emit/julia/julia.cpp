// SPDX-License-Identifier: GPL-3.0-or-later
// Target julia: NAME.jl, a module with functions in the form of DifferentialEquations.jl.
#include <fmt/format.h>

#include <cmath>
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
#include "skeletons/julia_model_jl.hpp"

namespace eomgen::emit {
namespace {

using Json = nlohmann::ordered_json;

// Keywords, functions that the code calls, and names of the module.
constexpr std::string_view julia_words[] = {
    "abstract",  "as",           "baremodule", "begin",   "catch",       "do",      "elseif",  "end",       "finally",
    "function",  "global",       "import",     "in",      "isa",         "let",     "local",   "macro",     "missing",
    "module",    "mutable",      "nothing",    "outer",   "primitive",   "public",  "quote",   "type",      "using",
    "where",     "Base",         "Core",       "Main",    "Float32",     "Float64", "Int",     "String",    "Inf",
    "NaN",       "abs",          "any",        "atan",    "eval",        "u",       "mode",    "dfdt",      "fill",
    "ifelse",    "include",      "length",     "mod",     "ones",        "pi",      "zeros",   "real_sqrt", "real_log",
    "real_pow",  "real_acos",    "real_asin",  "slides",  "normal_sign", "side",    "differs", "selftest",  "defaults",
    "STATES",    "PARAMETERS",   "INPUTS",     "OUTPUTS", "REACTIONS",   "START",   "VALUES",  "INFO",      "ABI",
    "DEFAULT_U", "DEFAULT_MODE", "code"};

std::string julia_number(double value) { return number_or(value, "NaN", "Inf", "-Inf"); }

/// "0.1f0": a literal of single precision.
std::string julia_single_number(double value) {
  const double rounded = to_single(value);
  if (!std::isfinite(rounded)) return julia_number(rounded) + "32";
  std::string text = decimal(rounded);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text + "f0";
  text[exponent] = 'f';
  return text;
}

const char* julia_function(symbolic::Op op) { return op == symbolic::Op::atan2 ? "atan" : real_function(op); }

Language julia_language(bool single_precision) {
  Language language;
  Dialect& dialect = language.dialect;
  set_numbers<julia_number>(dialect, "3.141592653589793");
  if (single_precision) {
    set_numbers<julia_single_number>(dialect, "3.1415927f0");
    dialect.pivot_tolerance = single_dialect().pivot_tolerance;
    language.conversion = "Float32";
  }
  dialect.abs_function = "abs";
  dialect.is_typed = false;
  dialect.conditional = [](const std::string& a, const std::string& b, const std::string& x, const std::string& y) {
    return fmt::format("ifelse({} < {}, {}, {})", a, b, x, y);
  };
  dialect.element = [](const std::string& array, std::size_t index) { return fmt::format("{}[{}]", array, index + 1); };
  dialect.function_name = julia_function;
  language.comment = "# ";
  language.declaration = [](const std::string& name, const std::string& value) {
    return fmt::format("{} = {}", name, value);
  };
  language.stop = [](const std::string& condition, int code) {
    return fmt::format("({}) && return {}", condition, code);
  };
  language.negation = [](const std::string& condition) { return fmt::format("!({})", condition); };
  language.end = "return 0";
  language.if_wanted = [](const std::string& result) { return fmt::format("if {} !== nothing", result); };
  language.end_if = "end";
  language.reserved = julia_words;
  return language;
}

/// Text between double quotes, in ASCII, without interpolation.
std::string julia_text(const std::string& text) { return quoted(text, "$"); }

std::string julia_vector(const std::vector<double>& values, bool single_precision) {
  return single_precision ? fmt::format("Float32[{}]", joined(values, julia_single_number))
                          : fmt::format("Float64[{}]", joined(values, julia_number));
}

std::string julia_texts(const Json& names) { return "String[" + joined(names, julia_text) + "]"; }

/// Results first, then x, p, w and t. Results that may be omitted, inputs and modes are keywords.
std::string julia_definition(const program::Function& function, const ModelNames& names, const EmissionContext& context,
                             const Language& language) {
  const FunctionText text = print_statements(function, names, context, language);
  std::string results, values, time, keywords, unset;
  std::size_t result = 0;
  for (const Argument& argument : arguments(function.name, text, names)) {
    switch (argument.kind) {
      case Argument::Kind::number: time += ", " + argument.name; break;
      case Argument::Kind::integer: values += ", " + argument.name; break;
      case Argument::Kind::mode: keywords += fmt::format(", {} = DEFAULT_MODE", argument.name); break;
      case Argument::Kind::input:
        if (argument.slot == program::Slot::input)
          keywords += fmt::format(", {} = DEFAULT_U", argument.name);
        else
          values += ", " + argument.name;
        break;
      case Argument::Kind::result: {
        while (function.results[result].is_test()) ++result;
        if (program::may_be_null(function.name, result)) {
          const char* const keyword = abi::find(function.name)->results[result].name;
          keywords += fmt::format(", {} = nothing", keyword);
          if (argument.name != keyword) unset += fmt::format("  {} = {}\n", argument.name, keyword);
          unset += fmt::format("  ({0} === nothing) || fill!({0}, NaN)\n", argument.name);
        } else {
          results += (results.empty() ? "" : ", ") + argument.name;
          unset += fmt::format("  fill!({}, NaN)\n", argument.name);
        }
        ++result;
        break;
      }
    }
  }
  if (results.empty() && !values.empty()) values.erase(0, 2);
  return fmt::format("# {}\nfunction {}!({}{}{}{}{})\n{}{}end\n", comment_text(function_purpose(function.name)),
                     function.name, results, values, time, keywords.empty() ? "" : "; ",
                     keywords.empty() ? "" : keywords.substr(2), unset, text.body);
}

std::string julia_comparison(const FunctionValues& f, std::size_t state, std::size_t prepared) {
  std::string text, results, values, time, keywords, differences;
  const abi::Function& function = *abi::find(f.function);
  for (std::size_t r = 0; r < f.values.size(); ++r) {
    text += fmt::format("  y{} = zeros({})\n", r + 1, f.values[r].size());
    if (function.results[r].may_be_null)
      keywords += fmt::format(", {} = y{}", function.results[r].name, r + 1);
    else
      results += fmt::format("{}y{}", results.empty() ? "" : ", ", r + 1);
    differences +=
        fmt::format(" || differs(y{}, {}, {})", r + 1, julia_vector(f.values[r], false), julia_number(f.tolerances[r]));
  }
  for (const abi::Input input : function.inputs) {
    const std::string name(abi::name(input));
    if (input == abi::Input::time)
      time = ", t";
    else if (input == abi::Input::inputs || input == abi::Input::mode)
      keywords += fmt::format(", {0} = {0}", name);
    else
      values += ", " + name;
    if (input == abi::Input::prepared)
      text = fmt::format("  w = zeros({})\n  (prepare!(w, p) != 0) && return {}\n", prepared, state) + text;
  }
  return fmt::format("{}  code = {}!({}{}{}{}{})\n  (code != 0{}) && return {}\n", text, f.function, results, values,
                     time, keywords.empty() ? "" : "; ", keywords.empty() ? "" : keywords.substr(2), differences,
                     state);
}

std::string julia_modes(std::vector<int> mode, std::size_t size) {
  mode.resize(size);
  return fmt::format("Int[{}]", fmt::join(mode, ", "));
}

std::string julia_selftest(const program::Program& program, const EmissionContext& context, bool single_precision) {
  std::string text;
  if (begins_with_defaults(context, single_precision) && !context.tests.empty())
    text += fmt::format("  (differs(START, {}, 0.0) || differs(VALUES, {}, 0.0)) && return 1\n",
                        julia_vector(context.tests[0].x, single_precision),
                        julia_vector(context.tests[0].p, single_precision));
  for (std::size_t k = 0; k < context.tests.size(); ++k) {
    const TestVector& test = context.tests[k];
    text += fmt::format("  t = {}\n  x = {}\n  p = {}\n  u = {}\n  mode = {}\n",
                        single_precision ? julia_single_number(test.t) : julia_number(test.t),
                        julia_vector(test.x, single_precision), julia_vector(test.p, single_precision),
                        julia_vector(test.u, single_precision), julia_modes(test.mode, program.mode_layout().size()));
    if (!test.v.empty()) text += fmt::format("  v = {}\n", julia_vector(test.v, single_precision));
    for (const FunctionValues& f : test.functions) text += julia_comparison(f, k + 1, program.prepared_count());
  }
  return text;
}

}  // namespace

std::string julia_name(const std::string& id) { return id_beside(id, julia_words); }

std::vector<EmittedFile> emit_julia(const program::Program& program, const EmissionContext& context) {
  require_consistent(program, context);
  require_plain(program, "julia");
  require_no_start(context, "julia", ", or use the target c, javascript or rust");
  const std::string name = julia_name(context.id);
  const bool single_precision = context.single_error.has_value();
  const Language language = julia_language(single_precision);
  ModelNames names = model_names(program, context, julia_words);
  names.u = "u";  // keywords of every model: the reserved words keep them from its names
  names.mode = "mode";
  std::vector<std::vector<std::pair<std::string, std::string>>> functions;
  for (const program::Function& function : program.functions)
    functions.push_back({{"definition", julia_definition(function, names, context, language)}});
  const auto exported = [](const program::Function& function) { return function.name + "!"; };
  const Json info = Json::parse(info_json(program, context));
  const std::vector<std::pair<std::string, std::string>> values = {
      {"banner", banner(program, context, "# ", "# ", "")},
      {"name", name},
      {"abi", std::to_string(abi::version)},
      {"states", julia_texts(info.at("states"))},
      {"parameters", julia_texts(info.at("parameters"))},
      {"inputs", julia_texts(info.at("inputs"))},
      {"outputs", julia_texts(Json(program.outputs))},
      {"reactions", julia_texts(Json(program.reactions))},
      {"info", julia_text(info.dump(-1, ' ', true, Json::error_handler_t::replace))},
      {"exports", joined(program.functions, exported)},
      {"x", julia_vector(context.start, single_precision)},
      {"p", julia_vector(values_of(context.parameters), single_precision)},
      {"u", julia_vector(values_of(context.inputs), single_precision)},
      {"mode", julia_modes({}, program.mode_layout().size())},
      {"selftest", julia_selftest(program, context, single_precision)}};
  return {{name + ".jl", render_template(skeleton::julia_model_jl, values, functions)}};
}

}  // namespace eomgen::emit
