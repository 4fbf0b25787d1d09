// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/cpp/templates.hpp"

#include <cln/integer.h>
#include <cln/integer_io.h>
#include <cln/rational.h>
#include <fmt/format.h>

#include <sstream>

#include "emit/file_parts.hpp"
#include "emit/parts.hpp"
#include "emit/signature.hpp"
#include "emit/text.hpp"

namespace eomgen::emit {
namespace {

std::string text_of(const cln::cl_I& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

bool fits_double(const cln::cl_I& value) { return cln::integer_length(value) <= 53; }
bool fits_int(const cln::cl_I& value) { return cln::integer_length(value) <= 31; }

/// Exact for every Real if a quotient of two exact numbers represents it: Real(981)/Real(100).
std::string real_constant(const symbolic::Rational& value) {
  const cln::cl_I above = cln::numerator(value), below = cln::denominator(value);
  const auto whole = [](const cln::cl_I& n) { return "Real(" + text_of(n) + (fits_int(n) ? ")" : ".0)"); };
  if (!fits_double(above) || !fits_double(below)) return "Real(" + decimal(nearest_double(value)) + ")";
  if (below == 1) return whole(above);
  if (cln::power2p(below) != 0) return "Real(" + decimal(nearest_double(value)) + ")";
  return whole(above) + "/" + whole(below);
}

}  // namespace

Dialect template_dialect() {
  Dialect dialect;
  dialect.real = "Real";
  dialect.constant = real_constant;
  dialect.value = [](double value) { return "Real(" + decimal(value) + ")"; };
  dialect.pi = "Real(3.141592653589793238462643383279502884L)";
  dialect.abs_function = "abs";
  dialect.kernel_prefix = template_kernel_prefix;
  dialect.line_comments = true;
  dialect.using_std = true;
  return dialect;
}

std::string index_names(const ModelNames& names, const program::Program& program) {
  std::string result;
  const auto add = [&result](const char* type, const char* count, const std::vector<std::string>& entries) {
    if (!entries.empty()) {
      std::string list;
      for (const std::string& entry : entries) list += (list.empty() ? "" : ", ") + entry;
      result += wrapped(fmt::format("struct {} {{ enum : std::size_t {{ {} }}; }};", type, list), "    ") + "\n";
    }
    result += fmt::format("inline constexpr std::size_t {} = {};\n", count, entries.size());
  };
  add("State", "state_count", names.state);
  add("Parameter", "parameter_count", names.parameters);
  add("Input", "input_count", names.inputs);
  add("Output", "output_count", names.outputs);
  add("Reaction", "reaction_count", names.reactions);
  if (!names.events.empty()) add("Event", "event_count", names.events);
  if (!names.frames.empty()) add("Frame", "frame_count", names.frames);
  if (!names.inertial.empty()) add("Inertial", "inertial_count", names.inertial);
  result += fmt::format("inline constexpr std::size_t mode_size = {};\n", program.mode_layout().size());
  result += fmt::format("inline constexpr std::size_t prepared_size = {};\n", program.prepared_count());
  if (program.taylor)
    result += fmt::format("inline constexpr int taylor_order = {};\n", program::taylor_order(*program.taylor));
  result.pop_back();
  return result;
}

TemplateFunctions template_functions(const program::Program& program, const ModelNames& names,
                                     const EmissionContext& context, const Dialect& dialect, const std::string& mark) {
  TemplateFunctions result;
  for (const FilePart& part : file_parts(program, "", dialect)) {
    std::vector<std::pair<std::string, std::string>> entry{{"purpose", part.purpose}};
    if (part.function == nullptr) {
      entry.emplace_back("head", wrapped(fmt::format("{}int {}({})", mark, part.name, part.arguments),
                                         std::string(part.name.size() + 5, ' ')));
      entry.emplace_back("body", part.body);
    } else {
      FunctionText text = print_function(*part.function, names, context, dialect);
      result.packs = result.packs || text.packs > 0;
      for (std::size_t k = 0; k < text.parts.size(); ++k) {
        const std::string list = argument_list(arguments(part.function->name, text, names), "Real");
        const std::string head =
            fmt::format("#if defined(__GNUC__)\n__attribute__((noinline))\n#endif\n{}int {}_part{}({}, Real* {})", mark,
                        part.name, k + 1, list, text.work);
        result.functions.push_back(
            {{"purpose", fmt::format("Part {} of {}.", k + 1, part.name)}, {"head", head}, {"body", text.parts[k]}});
      }
      if (!text.parts.empty())
        text.body = part_calls(part.name, text, argument_names(*part.function, text, names), "Real");
      entry.emplace_back("head", mark + function_head(part.name, *part.function, text, names, "Real"));
      entry.emplace_back("body", text.body);
    }
    result.functions.push_back(std::move(entry));
  }
  return result;
}

}  // namespace eomgen::emit
