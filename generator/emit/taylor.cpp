// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/taylor.hpp"

#include <fmt/format.h>

#include "emit/names.hpp"
#include "emit/parts.hpp"
#include "emit/signature.hpp"
#include "emit/text.hpp"
#include "program/taylor.hpp"

namespace eomgen::emit {
namespace {

// Computes two doubles at a time if the compiler has vector types. In either case each sum has the same order of
// additions.
constexpr const char* c_sums =
    R"(/* sums[i] = a_1 b_(k-1) + ... + a_(k-1) b_1 of each product i; the factors of one order stand together. */
static void {0}taylor_sums(int k, const double* a, const double* b, double* sums)
{{
#if defined(__GNUC__)
  typedef double pair __attribute__((vector_size(16)));
  int i, j;
  for (i = 0; i < {1}; i += {2}) {{
    pair s0 = {{0}}, s1 = {{0}}, s2 = {{0}}, s3 = {{0}};
    for (j = 1; j < k; ++j) {{
      const double* const u = a + j*{1} + i;
      const double* const v = b + (k - j)*{1} + i;
      pair u0, u1, u2, u3, v0, v1, v2, v3;
      memcpy(&u0, u, 16), memcpy(&u1, u + 2, 16), memcpy(&u2, u + 4, 16), memcpy(&u3, u + 6, 16);
      memcpy(&v0, v, 16), memcpy(&v1, v + 2, 16), memcpy(&v2, v + 4, 16), memcpy(&v3, v + 6, 16);
      s0 += u0*v0;
      s1 += u1*v1;
      s2 += u2*v2;
      s3 += u3*v3;
    }}
    memcpy(sums + i, &s0, 16), memcpy(sums + i + 2, &s1, 16), memcpy(sums + i + 4, &s2, 16), memcpy(sums + i + 6, &s3, 16);
  }}
#else
  int i, j;
  for (i = 0; i < {1}; ++i) {{
    double sum = 0.0;
    for (j = 1; j < k; ++j) sum += a[j*{1} + i]*b[(k - j)*{1} + i];
    sums[i] = sum;
  }}
#endif
}}
)";

constexpr const char* template_sums =
    R"(// sums[i] = a_1 b_(k-1) + ... + a_(k-1) b_1 of each product i; the factors of one order stand together.
template <class Real>
void taylor_sums(int k, const Real* a, const Real* b, Real* sums) {{
  for (int i = 0; i < {1}; ++i) {{
    Real sum = Real(0);
    for (int j = 1; j < k; ++j) sum += a[j*{1} + i]*b[(k - j)*{1} + i];
    sums[i] = sum;
  }}
}}
)";

constexpr const char* driver = R"({{
  {real} a[{series}], b[{series}], w[{prepared}];
  {real} finite = {zero};
  int i, k, code;
  if (order < 0 || order > {prefix}taylor_order) return 6;
  for (i = 0; i < {n}; ++i) coefficients[i] = x[i];
  if (order == 0) return 0;
  code = {prefix}taylor_start(t, x, p, u, mode, w, coefficients + {n});
  if (code != 0) return code;
  for (k = 1; k < order; ++k) {{
    const {real}* const before = coefficients + {n}*k;
    {real}* const after = coefficients + {n}*(k + 1);
    {prefix}taylor_sums(k, a, b, w + {zeros});
    w[{prepared} - 2] = {real_of_k} == {one} ? {one} : {zero};
    w[{prepared} - 1] = {one}/{real_of_k};
    {prefix}taylor_next({real_of_k}, before, w, a + {products}*k, b + {products}*k, after);
    for (i = 0; i < {n}; ++i) after[i] = after[i]/{real_of_next};
  }}
  for (i = 0; i < {n}; ++i) finite = finite + coefficients[{n}*order + i];
  return finite - finite <= {zero} ? 0 : 5;
}}
)";

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
  text += "\n" + (generic ? fmt::format(fmt::runtime(template_sums), prefix, taylor.product_count)
                          : fmt::format(fmt::runtime(c_sums), prefix, taylor.product_count, program::taylor_lanes));
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
  text += fmt::format(fmt::runtime(driver), fmt::arg("real", real), fmt::arg("prefix", prefix),
                      fmt::arg("n", program.state_count()),
                      fmt::arg("series", taylor.product_count * program::taylor_order(taylor)),
                      fmt::arg("prepared", taylor.workspace_size()), fmt::arg("zeros", taylor.order_zero_count),
                      fmt::arg("products", taylor.product_count), fmt::arg("zero", dialect.constant(0)),
                      fmt::arg("one", dialect.constant(1)), fmt::arg("real_of_k", converted("k")),
                      fmt::arg("real_of_next", converted("k + 1")));
  result.definition = text;
  return result;
}

}  // namespace eomgen::emit
