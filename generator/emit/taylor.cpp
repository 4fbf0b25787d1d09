// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/taylor.hpp"

#include <fmt/format.h>

#include "emit/metadata.hpp"
#include "emit/names.hpp"
#include "emit/parts.hpp"
#include "emit/signature.hpp"
#include "emit/text.hpp"
#include "program/taylor.hpp"
#include "skeletons/kernels_taylor.hpp"
#include "skeletons/kernels_taylor_sums.hpp"
#include "skeletons/kernels_taylor_sums_generic.hpp"

namespace eomgen::emit {
namespace {

/// The function, preceded by its parts if it is long.
std::string helper(const program::Function& function, const ModelNames& names, const EmissionContext& context,
                   const Dialect& dialect, const std::string& prefix, const std::string& remark) {
  FunctionText text = print_function(function, names, context, dialect);
  const std::string name = prefix + function.name;
  const bool generic = prefix.empty();
  std::string parts;
  for (std::size_t k = 0; k < text.parts.size(); ++k) {
    parts += fmt::format(
        "{}#if defined(__GNUC__)\n__attribute__((noinline))\n#endif\n{}int {}_part{}({}, {}* {})\n{{\n{}}}\n\n",
        generic ? "template <class Real>\n" : "", generic ? "" : "static ", name, k + 1,
        argument_list(arguments(function.name, text, names), dialect.real), dialect.real, text.work, text.parts[k]);
  }
  if (!text.parts.empty()) text.body = part_calls(name, text, argument_names(function, text, names), dialect.real);
  const std::string head = function_head(name, function, text, names, dialect.real);
  if (generic) return fmt::format("{}// {}\ntemplate <class Real>\n{} {{\n{}}}\n", parts, remark, head, text.body);
  return fmt::format("{}/* {} */\nstatic {}\n{{\n{}}}\n", parts, remark, head, text.body);
}

}  // namespace

ModelNames taylor_next_names(const ModelNames& names) {
  ModelNames result = names;
  NameTable table;
  for (const auto* list : {&names.state, &names.parameters, &names.inputs}) {
    for (const std::string& name : *list) table.declare(name);
  }
  result.time = table.declare("k");
  result.x = table.declare("x");
  result.w = table.declare("w");
  return result;
}

TaylorText print_taylor(const program::Program& program, const ModelNames& names, const EmissionContext& context,
                        const Dialect& dialect, const std::string& prefix) {
  const program::Taylor& taylor = *program.taylor;
  const bool generic = prefix.empty();
  const std::string& real = dialect.real;
  std::string text = helper(taylor.start, names, context, dialect, prefix, "Values of order 0: z for taylor_next, dx.");
  text +=
      "\n" +
      helper(
          taylor.next, taylor_next_names(names), context, dialect, prefix,
          "From the coefficients x of order k: factors a, b of order k, k + 1 times the coefficients of order k + 1.");
  // The sums in C compute two doubles at a time if the compiler has vector types. In either case each sum has the same
  // order of additions.
  text += "\n" + render_template(generic ? skeleton::kernels_taylor_sums_generic : skeleton::kernels_taylor_sums,
                                 {{"prefix", prefix},
                                  {"products", fmt::format("{}", taylor.product_count)},
                                  {"lanes", fmt::format("{}", program::taylor_lanes)}},
                                 {});
  TaylorText result;
  const std::string name = prefix + "taylor";
  result.head = wrapped(fmt::format("int {}({})", name, argument_list(abi_arguments("taylor"), real)),
                        std::string(name.size() + 5, ' '));
  const auto converted = [&](const char* k) {
    return generic ? fmt::format("Real({})", k) : fmt::format("(double)({})", k);
  };
  text += fmt::format("\n{}{}\n",
                      generic ? "// Coefficients of the solution's Taylor series.\ntemplate <class Real>\n" : "",
                      result.head);
  text += render_template(skeleton::kernels_taylor,
                          {{"real", real},
                           {"prefix", prefix},
                           {"n", fmt::format("{}", program.state_count())},
                           {"series", fmt::format("{}", taylor.product_count * program::taylor_order(taylor))},
                           {"prepared", fmt::format("{}", taylor.workspace_size())},
                           {"zeros", fmt::format("{}", taylor.order_zero_count)},
                           {"products", fmt::format("{}", taylor.product_count)},
                           {"zero", dialect.constant(0)},
                           {"one", dialect.constant(1)},
                           {"real_of_k", converted("k")},
                           {"real_of_next", converted("k + 1")}},
                          {});
  result.definition = text;
  return result;
}

}  // namespace eomgen::emit
