// SPDX-License-Identifier: GPL-3.0-or-later
// Target c: NAME.c and NAME.h, the C ABI of docs/abi.md in a C11 subset that C++ compiles too.
#include <fmt/format.h>

#include "abi/functions.hpp"
#include "emit/file_parts.hpp"
#include "emit/kernels.hpp"
#include "emit/metadata.hpp"
#include "emit/parts.hpp"
#include "emit/run/run_header.hpp"
#include "emit/self_test.hpp"
#include "emit/signature.hpp"
#include "emit/single_precision.hpp"
#include "emit/start/start.hpp"
#include "emit/targets.hpp"
#include "emit/taylor.hpp"
#include "emit/text.hpp"
#include "error.hpp"
#include "program/taylor.hpp"
#include "skeletons/c_model_c.hpp"
#include "skeletons/c_model_h.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::emit {
namespace {

Dialect c_dialect() {
  Dialect dialect;
  dialect.real = "double";
  dialect.constant = [](const symbolic::Rational& value) { return decimal(nearest_double(value)); };
  dialect.value = decimal;
  dialect.pi = "3.141592653589793";
  dialect.abs_function = "fabs";
  return dialect;
}

/// The functions of math.h for float and double, as tgmath.h has them. Small C libraries lack the complex functions
/// that their tgmath.h names.
std::string generic_functions() {
  std::string text = "\n/* Functions of the precision of their arguments. */\n";
  const auto add = [&](const std::string& function, bool two) {
    text += fmt::format("#define {0}({1}) _Generic({2}, float: {0}f, default: {0})({1})\n", function,
                        two ? "a, b" : "a", two ? "(a) + (b)" : "(a)");
  };
  add("fabs", false);
  for (const symbolic::Function& function : symbolic::function_table) {
    if (function.code != nullptr) add(function.code, function.arity == 2);
  }
  text.pop_back();
  return text;
}

std::string head_of(const std::string& name, const std::string& arguments) {
  return wrapped(fmt::format("int {}({})", name, arguments), std::string(name.size() + 5, ' '));
}

/// The prototype with the argument names of docs/abi.md, independent of the model's names.
std::string prototype(const std::string& name, const FilePart& part, const std::string& real) {
  if (part.function == nullptr) return head_of(name, part.arguments);
  return head_of(name, argument_list(abi_arguments(part.function->name), real));
}

/// The definition of a function, preceded by its parts and, if it tries small angles first, by the version for large
/// angles.
std::string definition(const std::string& name, const program::Function& function, FunctionText text,
                       const ModelNames& names, const std::string& real, bool internal) {
  const char* linkage = internal ? "static " : "";
  const auto head = [&](const std::string& what) { return function_head(what, function, text, names, real); };
  if (!text.parts.empty()) {
    const std::string guard = text.near_angles_first ? fmt::format("int {}, ", text.guarded) : "";
    const std::string list = guard + argument_list(arguments(function.name, text, names), real);
    std::string parts;
    for (std::size_t k = 0; k < text.parts.size(); ++k) {
      parts += fmt::format(
          "#if defined(__GNUC__)\n__attribute__((noinline))\n#endif\nstatic int {}_part{}({}, {}* "
          "{})\n{{\n{}}}\n\n",
          name, k + 1, list, real, text.work, text.parts[k]);
    }
    const std::string handed =
        (text.near_angles_first ? text.guarded + ", " : "") + argument_names(function, text, names);
    text.body = part_calls(name, text, handed, real);
    text.parts.clear();
    return parts + definition(name, function, text, names, real, internal);
  }
  if (!text.near_angles_first) return fmt::format("{}{}\n{{\n{}}}\n", linkage, head(name), text.body);
  const std::string arguments = argument_names(function, text, names);
  std::string inner = head(name + "_from");
  inner.insert(inner.find('(') + 1, fmt::format("int {}, ", text.guarded));
  return fmt::format(
      "/* Returns -1 if guarded is 0 and an angle is too large. */\n"
      "#if defined(__GNUC__)\n__attribute__((always_inline))\n#endif\nstatic inline {}\n{{\n{}}}\n\n"
      "#if defined(__GNUC__)\n__attribute__((cold, noinline))\n#endif\nstatic {}\n{{\n  return {}_from(1, {});\n}}\n\n"
      "{}{}\n{{\n  const int code = {}_from(0, {});\n  return code >= 0 ? code : {}_far({});\n}}\n",
      inner, text.body, head(name + "_far"), name, arguments, linkage, head(name), name, arguments, name, arguments);
}

std::string sizes(const std::string& name, const program::Program& program, const EmissionContext& context) {
  std::vector<std::pair<const char*, std::size_t>> entries = {{"states", program.state_count()},
                                                              {"parameters", context.parameters.size()},
                                                              {"inputs", context.inputs.size()},
                                                              {"mode_size", program.mode_layout().size()},
                                                              {"constraints_active", program.active_constraints},
                                                              {"reaction_count", program.reactions.size()},
                                                              {"output_count", program.outputs.size()},
                                                              {"prepared_size", program.prepared_count()}};
  if (program.event_count() > 0) entries.emplace_back("event_count", program.event_count());
  if (program.result_size("frames") > 0) entries.emplace_back("frame_count", context.frames.size());
  if (program.result_size("regressor") > 0) entries.emplace_back("inertial_count", context.inertial.size());
  if (program.taylor) entries.emplace_back("taylor_order", program::taylor_order(*program.taylor));
  std::vector<std::string> lines;
  for (const auto& [what, count] : entries) lines.push_back(fmt::format("  {}_{} = {}", name, what, count));
  return fmt::format("{}", fmt::join(lines, ",\n"));
}

}  // namespace

std::vector<EmittedFile> emit_c(const program::Program& program, const EmissionContext& context) {
  require_consistent(program, context);
  const std::string name = mangled_id(context.id);
  const bool single = context.single_error.has_value();
  Dialect dialect = single ? single_dialect() : c_dialect();
  dialect.kernel_prefix = name + "_";
  dialect.near_angles_first = true;
  if (single && (program.taylor || context.run)) {
    throw Error("emit", {}, "Taylor series and run headers support double precision only",
                "leave taylor and run out of --with, or --real float");
  }
  const ModelNames names = model_names(program, context);
  std::vector<std::vector<std::pair<std::string, std::string>>> functions, declared;
  bool packs = false;
  std::vector<FilePart> parts = file_parts(program, name + "_", dialect);
  if (context.start_functions) {
    parts.push_back({"start_values", "Formulas of the default scene.", &context.start_functions->values, true, "", ""});
    if (context.start_functions->row_count() > 0)
      parts.push_back({"start_rows", "Equations of a start.", &context.start_functions->rows, true, "", ""});
  }
  for (const FilePart& part : parts) {
    const std::string full = fmt::format("{}_{}", name, part.name);
    std::string text;
    if (part.function == nullptr) {
      text = fmt::format("{}{}\n{{\n{}}}\n", part.internal ? "static " : "", head_of(full, part.arguments), part.body);
    } else {
      const FunctionText printed = print_function(*part.function, names, context, dialect);
      packs = packs || printed.packs > 0;
      text = definition(full, *part.function, printed, names, dialect.real, part.internal);
    }
    if (part.internal) text = fmt::format("/* {} */\n", comment_text(part.purpose)) + text;
    functions.push_back({{"definition", text}});
    if (!part.internal)
      declared.push_back({{"purpose", part.purpose}, {"prototype", prototype(full, part, dialect.real)}});
  }
  if (program.taylor) {
    const TaylorText text = print_taylor(program, names, context, dialect, name + "_");
    functions.push_back({{"definition", text.definition}});
    declared.push_back({{"purpose", function_purpose("taylor")}, {"prototype", text.head}});
  }
  if (context.start_functions) {
    functions.push_back(
        {{"definition", start_text(*context.start_functions, context, program, {true, name + "_", single})}});
    declared.push_back({{"purpose", start_purpose}, {"prototype", start_head(name + "_", dialect.real)}});
  }
  const SelfTestNames test{[&name](const std::string& f) { return name + "_" + f; }, name + "_differs", "0",
                           context.start_functions != nullptr};
  const std::vector<std::pair<std::string, std::string>> values = {
      {"banner", banner(program, context, "/* ", " * ", " */")},
      {"name", name},
      {"includes", fmt::format("{}{}",
                               packs || program.taylor ? "#include <float.h>\n#include <math.h>\n#include <string.h>"
                                                       : "#include <math.h>",
                               single ? "\n" + generic_functions() : "")},
      {"real", dialect.real},
      {"abi", std::to_string(abi::version)},
      {"kernels", packs ? sincos_kernel(name + "_", "static inline", "", single) + "\n" : ""},
      {"sizes", sizes(name, program, context)},
      {"info", string_literal(info_json(program, context), "      ")},
      {"defaults", defaults_body(program, context, dialect)},
      {"comparison", selftest_comparison(context, test, dialect)},
      {"selftest", selftest_body(program, context, test, dialect)}};
  std::vector<EmittedFile> files{{fmt::format("{}.c", name), render_template(skeleton::c_model_c, values, functions)},
                                 {fmt::format("{}.h", name), render_template(skeleton::c_model_h, values, declared)}};
  for (EmittedFile& file : emit_run_header(program, context)) files.push_back(std::move(file));
  return files;
}

}  // namespace eomgen::emit
