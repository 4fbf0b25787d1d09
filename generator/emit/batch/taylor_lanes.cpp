// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/batch/taylor_lanes.hpp"

#include <fmt/format.h>

#include "emit/metadata.hpp"
#include "emit/names.hpp"
#include "emit/single_precision.hpp"
#include "emit/taylor.hpp"
#include "emit/text.hpp"
#include "program/taylor.hpp"
#include "skeletons/batch_taylor.hpp"

namespace eomgen::emit {

Dialect lane_dialect(bool single, const std::string& prefix) {
  Dialect dialect;
  if (single) {
    dialect = single_dialect();
  } else {
    dialect.real = "double";
    dialect.constant = [](const symbolic::Rational& value) { return decimal(nearest_double(value)); };
    dialect.value = decimal;
    dialect.pi = "3.141592653589793";
    dialect.abs_function = "fabs";
  }
  dialect.use_lanes(prefix);
  return dialect;
}

std::vector<std::pair<std::string, std::string>> lane_template_values(bool single) {
  if (single) {
    return {{"real", "float"},
            {"integer", "int"},
            {"size", "4"},
            {"f", "f"},
            {"lanes_128", "4"},
            {"lanes_256", "8"},
            {"lanes_512", "16"},
            {"letter", "s"},
            {"letter_512", "d"},
            {"every_128", "15"},
            {"every_256", "255"},
            {"every_512", "65535"},
            {"all_but_sign", "0x7fffffffU"},
            {"wider", "FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16"}};
  }
  return {{"real", "double"},
          {"integer", "long long"},
          {"size", "8"},
          {"f", ""},
          {"lanes_128", "2"},
          {"lanes_256", "4"},
          {"lanes_512", "8"},
          {"letter", "d"},
          {"letter_512", "q"},
          {"every_128", "3"},
          {"every_256", "15"},
          {"every_512", "255"},
          {"all_but_sign", "0x7fffffffffffffffULL"},
          {"wider", "FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1 && FLT_EVAL_METHOD != 16"}};
}

namespace {

static_assert(program::taylor_lanes % 4 == 0);

constexpr std::size_t max_lanes = 8, stack_budget = std::size_t{1} << 21;  // bytes, the same as for one state

}  // namespace

bool taylor_fits_lanes(const program::Taylor& taylor, std::size_t states) {
  const std::size_t orders = program::taylor_order(taylor) + 1,
                    numbers = 2 * taylor.product_count * orders + taylor.workspace_size() + states * orders;
  return numbers * max_lanes * sizeof(double) <= stack_budget;
}

std::string taylor_block(const program::Program& program, const ModelNames& names, const EmissionContext& context,
                         const Dialect& dialect,
                         const std::function<std::string(const std::string&, const FunctionText&)>& kernel) {
  const program::Taylor& taylor = *program.taylor;
  ModelNames of_next = taylor_next_names(names);
  NameTable table;
  for (const auto* list : {&of_next.state, &of_next.parameters, &of_next.inputs}) {
    for (const std::string& name : *list) table.declare(name);
  }
  of_next.prepared.clear();
  for (std::size_t i = 0; i < taylor.workspace_size(); ++i)
    of_next.prepared.push_back(table.declare(fmt::format("w_{}", i)));
  const std::size_t orders = program::taylor_order(taylor);
  // Sums have the order of additions of NAME_taylor_sums. Orders are computed up to the highest that a lane requests.
  return kernel("taylor_start", print_function(taylor.start, names, context, dialect)) +
         kernel("taylor_next", print_function(taylor.next, of_next, context, dialect)) +
         render_template(skeleton::batch_taylor,
                         {{"prefix", dialect.lane_prefix},
                          {"name", mangled_id(context.id)},
                          {"n", fmt::format("{}", program.state_count())},
                          {"products", fmt::format("{}", taylor.product_count)},
                          {"series", fmt::format("{}", taylor.product_count * orders)},
                          {"prepared", fmt::format("{}", taylor.workspace_size())},
                          {"zeros", fmt::format("{}", taylor.order_zero_count)},
                          {"coefficients", fmt::format("{}", program.state_count() * (orders + 1))}},
                         {});
}

}  // namespace eomgen::emit
