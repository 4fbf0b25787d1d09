// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/cpp/cpp.hpp"

#include <cln/integer.h>
#include <cln/integer_io.h>
#include <cln/rational.h>
#include <fmt/format.h>

#include <sstream>

#include "emit/c/c.hpp"
#include "emit/file_parts.hpp"
#include "emit/kernels.hpp"
#include "emit/metadata.hpp"
#include "emit/parts.hpp"
#include "emit/self_test.hpp"
#include "emit/signature.hpp"
#include "emit/taylor.hpp"
#include "emit/text.hpp"
#include "program/taylor.hpp"
#include "skeletons/cpp_model_hpp.hpp"

namespace eomgen::emit {
namespace {

std::string text_of(const cln::cl_I& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

bool fits_double(const cln::cl_I& value) { return cln::integer_length(value) <= 53; }
bool fits_int(const cln::cl_I& value) { return cln::integer_length(value) <= 31; }

/// Exact for every Real where a quotient of two exact numbers can say it: Real(981)/Real(100).
std::string real_constant(const symbolic::Rational& value) {
  const cln::cl_I above = cln::numerator(value), below = cln::denominator(value);
  const auto whole = [](const cln::cl_I& n) { return "Real(" + text_of(n) + (fits_int(n) ? ")" : ".0)"); };
  if (!fits_double(above) || !fits_double(below)) return "Real(" + decimal(nearest_double(value)) + ")";
  if (below == 1) return whole(above);
  if (cln::power2p(below) != 0) return "Real(" + decimal(nearest_double(value)) + ")";
  return whole(above) + "/" + whole(below);
}

const std::string kernel_prefix = "eom_";

Dialect cpp_dialect() {
  Dialect dialect;
  dialect.real = "Real";
  dialect.constant = real_constant;
  dialect.value = [](double value) { return "Real(" + decimal(value) + ")"; };
  dialect.pi = "Real(3.141592653589793238462643383279502884L)";
  dialect.absolute = "abs";
  dialect.kernels = kernel_prefix;
  dialect.line_comments = true;
  dialect.using_std = true;
  return dialect;
}

// What other types than double take in place of templates/kernels/sincos.
const std::string generic_sincos = R"(
template <class Real>
void eom_sincos(const Real& a, const Real& b, Real* sine, Real* cosine) {
  using std::cos; using std::sin;
  sine[0] = sin(a);
  sine[1] = sin(b);
  cosine[0] = cos(a);
  cosine[1] = cos(b);
}
)";

const std::string prepared_struct = R"(
// The right-hand side for given parameters, which have to stay where they are; what needs nothing else is computed once.
template <class Real>
struct Prepared {
  explicit Prepared(const Real* parameters) : p(parameters), code(prepare(parameters, w)) {}
  int operator()(Real t, const Real* x, const Real* u, int mode, Real* dx) const {
    return code != 0 ? code : rhs_prepared(t, x, p, w, u, mode, dx);
  }
  const Real* p;
  Real w[prepared_size];
  int code;  // of prepare
};
)";

/// Named indices into the arrays: x[State::theta].
std::string enums(const ModelNames& names, std::size_t prepared, const std::optional<program::Taylor>& taylor) {
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
  result += fmt::format("inline constexpr std::size_t prepared_size = {};\n", prepared);
  if (taylor) result += fmt::format("inline constexpr int taylor_order = {};\n", program::taylor_order(*taylor));
  result.pop_back();
  return result;
}

}  // namespace

std::vector<EmittedFile> emit_cpp(const program::Program& program, const EmissionContext& context) {
  require_consistent(program, context);
  const Dialect dialect = cpp_dialect();
  const std::string name = mangled_id(context.id);
  const ModelNames names = model_names(program, context);
  std::vector<std::vector<std::pair<std::string, std::string>>> functions;
  bool packs = false;
  std::string taylor;
  for (const FilePart& part : file_parts(program, "", "Real")) {
    std::vector<std::pair<std::string, std::string>> entry{{"purpose", part.purpose}};
    if (part.function == nullptr) {
      entry.emplace_back("head", wrapped(fmt::format("int {}({})", part.name, part.arguments), std::string(part.name.size() + 5, ' ')));
      entry.emplace_back("body", part.body);
    } else {
      FunctionText text = print_function(*part.function, names, context, dialect);
      packs = packs || text.packs > 0;
      for (std::size_t k = 0; k < text.parts.size(); ++k) {
        const std::string list = argument_list(arguments(part.function->name, text, names), "Real");
        const std::string head = fmt::format("#if defined(__GNUC__)\n__attribute__((noinline))\n#endif\nint {}_part{}({}, Real* {})", part.name, k + 1, list, text.work);
        functions.push_back({{"purpose", fmt::format("Part {} of {}.", k + 1, part.name)}, {"head", head}, {"body", text.parts[k]}});
      }
      if (!text.parts.empty()) text.body = calls_of_parts(part.name, text, argument_names(*part.function, text, names), "Real");
      entry.emplace_back("head", function_head(part.name, *part.function, text, names, "Real"));
      entry.emplace_back("body", text.body);
    }
    functions.push_back(std::move(entry));
  }
  if (program.taylor) {
    const TaylorText text = print_taylor(program, names, context, dialect, "");
    taylor = "\n" + text.definition;
  }
  const SelfTestNames test{[](const std::string& f) { return f + "<double>"; }, kernel_prefix + "differs", "nullptr"};
  std::vector<EmittedFile> files = {
      {name + ".hpp",
       rendered(skeleton::cpp_model_hpp,
                {{"banner", banner(program, context, "// ", "// ", "")},
                 {"name", name},
                {"includes", packs ? "#include <cfloat>\n#include <cmath>\n#include <cstddef>\n#include <cstring>" : "#include <cmath>\n#include <cstddef>"},
                {"kernels", packs ? generic_sincos + sincos_kernel(kernel_prefix, "inline", "std::") : ""},
                 {"enums", enums(names, program.prepared_count(), program.taylor)},
                 {"prepared", (program.prepared_count() > 0 ? prepared_struct : "") + taylor},
                {"info", string_literal(info_json(program, context), "      ")},
                 {"defaults", defaults_body(program, context, dialect)},
                 {"comparison", selftest_comparison(context, test, dialect)},
                 {"selftest", selftest_body(program, context, test, dialect)}},
                functions)}};
  for (EmittedFile& file : emit_c(program, context)) files.push_back(std::move(file));
  return files;
}

}  // namespace eomgen::emit
