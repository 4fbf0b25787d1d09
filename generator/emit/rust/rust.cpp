// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/rust/rust.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "abi/functions.hpp"
#include "emit/languages/language.hpp"
#include "emit/metadata.hpp"
#include "emit/names.hpp"
#include "emit/self_test.hpp"
#include "emit/signature.hpp"
#include "emit/single_precision.hpp"
#include "emit/start/start.hpp"
#include "emit/text.hpp"
#include "program/internal_functions.hpp"
#include "skeletons/rust_model_rs.hpp"

namespace eomgen::emit {
namespace {

using Json = nlohmann::ordered_json;

// Keywords, patterns of the prelude, and items of the module: a `let` of the name of a constant is a pattern.
// clang-format off
constexpr std::string_view rust_words[] = {
    "abstract", "as", "async", "await", "become", "box", "crate", "dyn", "extern", "f32", "f64", "final", "fn", "gen",
    "i32", "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "raw", "ref",
    "safe", "self", "Self", "super", "trait", "type", "unsized", "unsafe", "use", "usize", "where", "yield", "Err",
    "None", "Ok", "Some", "Option", "Real", "ABI", "INFO", "STATES", "PARAMETERS", "INPUTS", "MODE_SIZE",
    "CONSTRAINTS_ACTIVE", "REACTION_COUNT", "OUTPUT_COUNT", "PREPARED_SIZE", "EVENT_COUNT", "STATE_NAMES",
    "PARAMETER_NAMES", "INPUT_NAMES", "OUTPUT_NAMES", "REACTION_NAMES", "DEFAULT_INPUTS", "VECTORS", "Vector", "core",
    "std", "alloc", "test", "starting", "start", "slides", "normal_sign", "side", "libm", "differs", "selftest",
    "defaults"};
// clang-format on

std::string rust_number(double value) { return number_or(value, "Real::NAN", "Real::INFINITY", "Real::NEG_INFINITY"); }

std::string single_number(double value) { return rust_number(to_single(value)); }

Language rust_language(bool single) {
  Language language;
  Dialect& dialect = language.dialect;
  dialect.real = "Real";
  set_numbers<rust_number>(dialect, "3.141592653589793");
  if (single) {
    set_numbers<single_number>(dialect, "3.1415927");
    dialect.pivot_tolerance = single_dialect().pivot_tolerance;
  }
  dialect.abs_function = "abs";
  dialect.line_comments = true;
  dialect.is_typed = false;
  dialect.conditional = [](const std::string& a, const std::string& b, const std::string& x, const std::string& y) {
    return fmt::format("(if {} < {} {{ {} }} else {{ {} }})", a, b, x, y);
  };
  dialect.element = [](const std::string& array, std::size_t index) { return fmt::format("{}[{}]", array, index); };
  language.comment = "// ";
  language.declaration = [](const std::string& name, const std::string& value) {
    return fmt::format("let {}: Real = {};", name, value);
  };
  language.stop = [](const std::string& condition, int code) {
    return fmt::format("if {} {{ return {}; }}", condition, code);
  };
  language.negation = [](const std::string& condition) { return fmt::format("!({})", condition); };
  language.end = "0";
  language.if_wanted = [](const std::string& result) { return fmt::format("if let Some({0}) = {0} {{", result); };
  language.end_if = "}";
  language.has_parts = true;
  language.reserved = rust_words;
  return language;
}

/// The type of the argument v.
std::string rust_vector_type(const std::string& function, const ModelNames& names) {
  const abi::Function& entry = *abi::find(function);
  if (entry.has_input(abi::Input::accelerations)) return fmt::format("&[Real; {}]", names.acceleration.size());
  return entry.has_input(abi::Input::state_vectors) ? "&[Real; 2 * STATES]" : "&[Real; STATES]";
}

/// "x: &[Real; STATES], ..": with the sizes of the arrays.
std::string rust_parameters(const program::Function& function, const FunctionText& text, const ModelNames& names,
                            bool results) {
  std::string list;
  std::size_t result = 0, place = 0;
  for (const Argument& argument : arguments(function.name, text, names)) {
    std::string type;
    switch (argument.kind) {
      case Argument::Kind::number: type = "Real"; break;
      case Argument::Kind::integer: type = "i32"; break;
      case Argument::Kind::mode: type = "Option<&[i32; MODE_SIZE]>"; break;
      case Argument::Kind::input:
        type = argument.slot == program::Slot::input       ? "Option<&[Real; INPUTS]>"
               : argument.slot == program::Slot::parameter ? "&[Real; PARAMETERS]"
               : argument.slot == program::Slot::prepared  ? "&[Real; PREPARED_SIZE]"
               : argument.slot == program::Slot::vector    ? rust_vector_type(function.name, names)
                                                           : "&[Real; STATES]";
        break;
      case Argument::Kind::result: {
        while (function.results[result].is_test()) ++result;
        type = fmt::format("&mut [Real; {}]", function.results[result].entries.size());
        if (program::may_be_null(function.name, result)) type = fmt::format("Option<{}>", type);
        ++result;
        if (!results) continue;
        break;
      }
    }
    list += fmt::format("{}{}: {}", place++ == 0 ? "" : ", ", argument.name, type);
  }
  return list;
}

std::string rust_arguments(const program::Function& function, const FunctionText& text, const ModelNames& names,
                           bool results) {
  std::string list;
  for (const Argument& argument : arguments(function.name, text, names)) {
    if (!results && argument.kind == Argument::Kind::result) continue;
    list += (list.empty() ? "" : ", ") + argument.name;
  }
  return list;
}

/// Missing inputs have their defaults, a missing mode is zero.
std::string missing_arguments(const program::Function& function, const ModelNames& names) {
  std::string text;
  const abi::Function* entry = abi::find(function.name);
  if (entry != nullptr && entry->has_input(abi::Input::inputs))
    text += fmt::format("  let {0} = {0}.unwrap_or(&DEFAULT_INPUTS);\n", names.u);
  if (entry != nullptr && entry->has_input(abi::Input::mode))
    text += fmt::format("  let {0} = {0}.unwrap_or(&[0; MODE_SIZE]);\n", names.mode);
  return text;
}

std::string rust_definition(const program::Function& function, const ModelNames& names, const EmissionContext& context,
                            const Language& language) {
  const FunctionText text = print_statements(function, names, context, language);
  const std::string head =
      fmt::format("pub fn {}({}) -> i32 {{\n", function.name, rust_parameters(function, text, names, true));
  const std::string missing = missing_arguments(function, names);
  if (text.parts.empty()) return fmt::format("{}{}{}}}\n", head, missing, text.body);
  std::string parts;
  std::string calls = fmt::format("  let mut {}: [Real; {}] = [0.0; {}];\n", text.work, text.work_size, text.work_size);
  for (std::size_t k = 1; k <= text.parts.size(); ++k) {
    const bool last = k == text.parts.size();
    const std::string name = fmt::format("{}_part{}", function.name, k);
    parts += fmt::format("#[inline(never)]\nfn {}({}, {}: &mut [Real; {}]) -> i32 {{\n{}{}}}\n\n", name,
                         rust_parameters(function, text, names, last), text.work, text.work_size, missing,
                         text.parts[k - 1]);
    const std::string call =
        fmt::format("{}({}, &mut {})", name, rust_arguments(function, text, names, last), text.work);
    calls += last ? fmt::format("  {}\n", call)
                  : fmt::format("  let {0} = {1};\n  if {0} != 0 {{ return {0}; }}\n", text.code, call);
  }
  return fmt::format("{}{}{}}}\n", parts, head, calls);
}

std::string rust_list(const std::vector<double>& values, const Dialect& dialect) {
  return "[" + joined(values, dialect.value) + "]";
}

/// Reference values in full, also those that single precision rounds to 0.
std::string rust_references(const std::vector<double>& values) { return "[" + joined(values, rust_number) + "]"; }

std::string names_constant(const char* constant, const char* size, const Json& names) {
  const std::string list = joined(names, [](const std::string& name) { return quoted(name); });
  return fmt::format("pub const {}: [&str; {}] = [{}];\n", constant, size, list);
}

std::string rust_constants(const program::Program& program, const EmissionContext& context, const Json& info,
                           const Dialect& dialect) {
  std::string text = fmt::format("pub const ABI: i32 = {};\n", abi::version);
  const std::pair<const char*, std::size_t> sizes[] = {{"STATES", program.state_count()},
                                                       {"PARAMETERS", context.parameters.size()},
                                                       {"INPUTS", context.inputs.size()},
                                                       {"MODE_SIZE", program.mode_layout().size()},
                                                       {"CONSTRAINTS_ACTIVE", program.active_constraints},
                                                       {"REACTION_COUNT", program.reactions.size()},
                                                       {"OUTPUT_COUNT", program.outputs.size()},
                                                       {"PREPARED_SIZE", program.prepared_count()},
                                                       {"EVENT_COUNT", program.event_count()}};
  for (const auto& [name, size] : sizes) text += fmt::format("pub const {}: usize = {};\n", name, size);
  text += names_constant("STATE_NAMES", "STATES", info.at("states"));
  text += names_constant("PARAMETER_NAMES", "PARAMETERS", info.at("parameters"));
  text += names_constant("INPUT_NAMES", "INPUTS", info.at("inputs"));
  text += names_constant("OUTPUT_NAMES", "OUTPUT_COUNT", Json(program.outputs));
  text += names_constant("REACTION_NAMES", "REACTION_COUNT", Json(program.reactions));
  return text +
         fmt::format("pub const DEFAULT_INPUTS: [Real; INPUTS] = {};\n", rust_list(values_of(context.inputs), dialect));
}

std::string rust_vectors(const program::Program& program, const EmissionContext& context, const Dialect& dialect) {
  std::string text;
  for (const TestVector& test : context.tests) {
    std::vector<int> mode = test.mode;
    mode.resize(program.mode_layout().size());
    text += fmt::format("  Vector {{ t: {}, x: {}, p: {}, u: {}, mode: [{}] }},\n", dialect.value(test.t),
                        rust_list(test.x, dialect), rust_list(test.p, dialect), rust_list(test.u, dialect),
                        fmt::join(mode, ", "));
  }
  return text;
}

/// The comparison of one function at one state, of number `k`.
std::string rust_comparison(const FunctionValues& f, const std::vector<double>& v, std::size_t k,
                            const Dialect& dialect) {
  std::string text = "  {\n", call;
  const bool prepared = abi::find(f.function)->has_input(abi::Input::prepared);
  for (const abi::Input input : abi::find(f.function)->inputs) {
    call += call.empty() ? "" : ", ";
    switch (input) {
      case abi::Input::time: call += "v.t"; break;
      case abi::Input::state: call += "&v.x"; break;
      case abi::Input::parameters: call += "&v.p"; break;
      case abi::Input::prepared: call += "&w"; break;
      case abi::Input::inputs: call += "Some(&v.u)"; break;
      case abi::Input::mode: call += "Some(&v.mode)"; break;
      case abi::Input::state_vector:
      case abi::Input::state_vectors:
      case abi::Input::accelerations: call += fmt::format("&{}", rust_list(v, dialect)); break;
      default: break;
    }
  }
  text += fmt::format("    let v = &VECTORS[{}];\n", k);
  if (prepared)
    text += fmt::format(
        "    let mut w = [Real::NAN; PREPARED_SIZE];\n    if prepare(&v.p, &mut w) != 0 {{ return {}; }}\n", k + 1);
  std::string comparisons;
  for (std::size_t r = 0; r < f.values.size(); ++r) {
    text += fmt::format("    static Y{}: [Real; {}] = {};\n", r, f.values[r].size(), rust_references(f.values[r]));
    text += fmt::format("    let mut y{} = [Real::NAN; {}];\n", r, f.values[r].size());
    const bool optional = program::may_be_null(f.function, r);
    call += fmt::format(", {}&mut y{}{}", optional ? "Some(" : "", r, optional ? ")" : "");
    comparisons +=
        fmt::format("    if differs(&y{0}, &Y{0}, {1}) {{ return {2}; }}\n", r, dialect.value(f.tolerances[r]), k + 1);
  }
  return text + fmt::format("    if {}({}) != 0 {{ return {}; }}\n{}  }}\n", f.function, call, k + 1, comparisons);
}

std::string rust_selftest(const program::Program& program, const EmissionContext& context, const Dialect& dialect,
                          bool single) {
  std::string text;
  if (begins_with_defaults(context, single))
    text +=
        "  let mut x = [Real::NAN; STATES];\n  let mut p = [Real::NAN; PARAMETERS];\n  defaults(&mut x, &mut p);\n"
        "  if x != VECTORS[0].x || p != VECTORS[0].p { return 1; }\n";
  if (context.start_functions)
    text += fmt::format(
        "  let (mut t, mut x, mut p) = ([0.0; 2], [Real::NAN; STATES], [Real::NAN; PARAMETERS]);\n"
        "  let (mut x0, mut p0) = ([0.0; STATES], [0.0; PARAMETERS]);\n"
        "  if start(None, &mut t, &mut x, &mut p, None) != 0 {{ return 1; }}\n  defaults(&mut x0, &mut p0);\n"
        "  if x.iter().zip(&x0).any(|(a, b)| !(abs(a - b) <= {0}*(1.0 + abs(*b)))) {{ return 1; }}\n"
        "  if p.iter().zip(&p0).any(|(a, b)| !(abs(a - b) <= {0}*abs(*b) + {0})) {{ return 1; }}\n",
        single ? "1e-3" : "1e-7");
  for (std::size_t k = 0; k < context.tests.size(); ++k) {
    for (const FunctionValues& f : context.tests[k].functions) {
      const std::vector<double>& all = context.tests[k].v;
      const auto size = static_cast<std::ptrdiff_t>(program::vector_size(f.function, program));
      text += rust_comparison(f, {all.begin(), all.begin() + size}, k, dialect);
    }
  }
  return text;
}

}  // namespace

std::string rust_name(const std::string& id) { return id_beside(id, rust_words); }

std::vector<EmittedFile> emit_rust(const program::Program& program, const EmissionContext& context) {
  require_consistent(program, context);
  require_plain(program, "rust");
  const bool single = context.single_error.has_value();
  const Language language = rust_language(single);
  const ModelNames names = model_names(program, context, rust_words);
  const std::string info = info_json(program, context);
  std::vector<std::vector<std::pair<std::string, std::string>>> functions;
  for (const program::Function& function : program.functions)
    functions.push_back({{"purpose", function_purpose(function.name)},
                         {"definition", rust_definition(function, names, context, language)}});
  std::string start;
  if (context.start_functions) {
    for (const program::Function* function : context.start_functions->functions())
      start += "\n" + rust_definition(*function, names, context, language);
    start += rust_start(program, context);
  }
  const Json parsed = Json::parse(info);
  const std::vector<std::pair<std::string, std::string>> values = {
      {"banner", banner(program, context, "// ", "// ", "")},
      {"real", single ? "f32" : "f64"},
      {"f", single ? "f" : ""},
      {"constants", rust_constants(program, context, parsed, language.dialect)},
      {"info", quoted(parsed.dump(-1, ' ', true, Json::error_handler_t::replace))},
      {"defaults", defaults_body(program, context, language.dialect)},
      {"start", start},
      {"count", std::to_string(context.tests.size())},
      {"vectors", rust_vectors(program, context, language.dialect)},
      {"selftest", rust_selftest(program, context, language.dialect, single)}};
  return {{rust_name(context.id) + ".rs", render_template(skeleton::rust_model_rs, values, functions)}};
}

}  // namespace eomgen::emit
