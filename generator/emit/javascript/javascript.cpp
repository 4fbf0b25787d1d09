// SPDX-License-Identifier: GPL-3.0-or-later
// Target javascript: one file, NAME.js, a script for pages and a module for Node.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "abi/functions.hpp"
#include "emit/languages/language.hpp"
#include "emit/metadata.hpp"
#include "emit/names.hpp"
#include "emit/self_test.hpp"
#include "emit/signature.hpp"
#include "emit/single_precision.hpp"
#include "emit/start/start.hpp"
#include "emit/straight_line.hpp"
#include "emit/targets.hpp"
#include "emit/text.hpp"
#include "emit/uses.hpp"
#include "error.hpp"
#include "program/internal_functions.hpp"
#include "skeletons/javascript_model_js.hpp"

namespace eomgen::emit {
namespace {

using Json = nlohmann::ordered_json;

std::string script_number(double value) { return number_or(value, "NaN", "Infinity", "-Infinity"); }

std::string rounded_number(double value) { return script_number(to_single(value)); }

/// In single precision, sums, products, quotients and roots have the same bits as in C: rounding to 53 and then to 24
/// bits equals one rounding to 24 bits.
Dialect javascript_dialect(bool single) {
  Dialect dialect;
  set_numbers<script_number>(dialect, "3.141592653589793");
  if (single) {
    set_numbers<rounded_number>(dialect, "3.1415927410125732");
    dialect.pivot_tolerance = single_dialect().pivot_tolerance;
    dialect.rounding_function = "fround";
  }
  dialect.abs_function = "abs";
  dialect.line_comments = true;
  dialect.is_typed = false;
  return dialect;
}

/// JSON that is safe in a script of a page: text of the model cannot end the script.
std::string literal(const Json& value) {
  std::string result;
  for (const char c : value.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    result += c == '<' ? "\\u003c" : c == '>' ? "\\u003e" : std::string(1, c);
  }
  return result;
}

/// The same for the banner.
std::string harmless(std::string text) {
  for (char& c : text) {
    if (c == '<' || c == '>') c = '|';
  }
  return text;
}

const char* array_of(const Dialect& dialect) {
  return dialect.rounding_function.empty() ? "Float64Array" : "Float32Array";
}

std::string parameter_list(const std::string& function, const FunctionText& text, const ModelNames& names) {
  return joined(arguments(function, text, names), [](const Argument& argument) { return argument.name; });
}

bool reads_time(const program::Function& function) {
  const Uses uses = count_uses(function);
  return std::any_of(uses.leaves.begin(), uses.leaves.end(), [](const Leaves& leaves) {
    return std::any_of(leaves.begin(), leaves.end(),
                       [](const auto& leaf) { return leaf.first == program::Slot::time; });
  });
}

/// The definition of a function. Long functions are split into parts, since engines do not optimise very long
/// functions.
std::string definition(const program::Function& function, const FunctionText& text, const ModelNames& names,
                       const Dialect& dialect) {
  const std::string list = parameter_list(function.name, text, names);
  std::string head = fmt::format("function {}({})", function.name, list);
  if (!dialect.rounding_function.empty() && reads_time(function))
    head += fmt::format(" {{\n  {0} = {1};\n", names.time, dialect.rounded(names.time));
  else
    head += " {\n";
  if (text.parts.empty()) return fmt::format("{}{}}}\n", head, text.body);
  std::string parts, calls = fmt::format("  const {} = new {}({});\n  let {} = 0;\n", text.work, array_of(dialect),
                                         text.work_size, text.code);
  for (std::size_t k = 1; k <= text.parts.size(); ++k) {
    const std::string name = fmt::format("{}_part{}", function.name, k);
    parts += fmt::format("function {}({}, {}) {{\n{}}}\n\n", name, list, text.work, text.parts[k - 1]);
    calls += fmt::format("  {0} = {1}({2}, {3});\n  if ({0} !== 0) return {0};\n", text.code, name, list, text.work);
  }
  return fmt::format("{}{}{}  return 0;\n}}\n", parts, head, calls);
}

/// Ungroups sines and cosines, since JavaScript has no SIMD vectors.
program::Function without_packs(program::Function function) {
  for (program::Instruction& instruction : function.code) instruction.pack = instruction.lane = 0;
  return function;
}

std::string vectors(const program::Program& program, const EmissionContext& context) {
  Json tests = Json::array();
  for (const TestVector& test : context.tests) {
    Json functions = Json::array();
    for (const FunctionValues& f : test.functions)
      functions.push_back({{"name", f.function}, {"values", f.values}, {"allowed", f.tolerances}});
    std::vector<int> mode = test.mode;
    mode.resize(program.mode_layout().size());
    tests.push_back(
        {{"t", test.t}, {"mode", mode}, {"x", test.x}, {"p", test.p}, {"u", test.u}, {"functions", functions}});
    if (!test.v.empty()) tests.back()["v"] = test.v;
  }
  std::string text = "[";
  for (std::size_t i = 0; i < tests.size(); ++i) text += (i > 0 ? ",\n  " : "\n  ") + literal(tests[i]);
  return text + "]";
}

/// The comparison of `defaults` with the first vector, in the self test.
std::string defaults_test(const program::Program& program, const EmissionContext& context, const Dialect& dialect) {
  if (!begins_with_defaults(context, !dialect.rounding_function.empty())) return "";
  return fmt::format(R"(  const x = new {0}({1}).fill(NaN), p = new {0}({2}).fill(NaN), first = vectors[0];
  defaults(x, p);
  if (!{0}.from(first.x).every((value, i) => x[i] === value)) return 1;
  if (!{0}.from(first.p).every((value, i) => p[i] === value)) return 1;
)",
                     array_of(dialect), program.state_count(), context.parameters.size());
}

void require_known(const program::Program& program) {
  if (program.taylor)
    throw Error("emit", {}, "the JavaScript target does not support Taylor series",
                "leave taylor out of --with, or use the target c or cpp");
  if (!program.charts.empty())
    throw Error("emit", {}, "the JavaScript target does not support charts",
                "use the target c or cpp, or leave --with charts out");
}

/// The arguments of each function before its results, for the self test: { "rhs": ["t", "x", ..], .. }.
std::string argument_table(const program::Program& program) {
  Json table = Json::object();
  for (const program::Function& function : program.functions) {
    Json names = Json::array();
    for (const abi::Input input : program::inputs_of(function.name)) names.push_back(abi::name(input));
    table[function.name] = names;
  }
  return literal(table);
}

}  // namespace

std::vector<EmittedFile> emit_javascript(const program::Program& program, const EmissionContext& context) {
  require_consistent(program, context);
  require_known(program);
  const std::string name = script_name(context.id);
  const Dialect dialect = javascript_dialect(context.single_error.has_value());
  const ModelNames names = model_names(program, context, javascript_reserved_words());
  std::vector<std::vector<std::pair<std::string, std::string>>> functions;
  std::string list;
  for (const program::Function& emitted : program.functions) {
    const program::Function function = without_packs(emitted);
    const FunctionText text = print_function(function, names, context, dialect);
    functions.push_back(
        {{"purpose", function_purpose(function.name)}, {"definition", definition(function, text, names, dialect)}});
    list += ", " + function.name;
  }
  std::string start;
  if (context.start_functions) {
    for (const program::Function* function : context.start_functions->functions()) {
      const program::Function alone = without_packs(*function);
      start += "\n" + definition(alone, print_function(alone, names, context, dialect), names, dialect);
    }
    start +=
        "\n" + start_text(*context.start_functions, context, program, {false, "", context.single_error.has_value()});
    list += ", start";
  }
  const std::vector<std::pair<std::string, std::string>> values = {
      {"start", start},
      {"banner", harmless(banner(program, context, "// ", "// ", ""))},
      {"name", name},
      {"abi", std::to_string(abi::version)},
      {"info", literal(Json::parse(info_json(program, context)))},
      {"defaults", defaults_body(program, context, dialect)},
      {"list", list},
      {"array", array_of(dialect)},
      {"rounding", dialect.rounding_function.empty() ? "" : ", " + dialect.rounding_function},
      {"prepared", std::to_string(program.prepared_count())},
      {"arguments", argument_table(program)},
      {"defaults_test", defaults_test(program, context, dialect)},
      {"vectors", vectors(program, context)}};
  return {{name + ".js", render_template(skeleton::javascript_model_js, values, functions)}};
}

}  // namespace eomgen::emit
