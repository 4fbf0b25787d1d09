// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/batch/taylor_lanes.hpp"

#include <fmt/format.h>

#include "emit/names.hpp"
#include "emit/taylor.hpp"
#include "program/taylor.hpp"

namespace eomgen::emit {
namespace {

static_assert(program::taylor_lanes % 4 == 0);

constexpr std::size_t max_lanes = 8, stack_budget = std::size_t{1} << 21;  // bytes, the same as for one state

// Sums have the order of additions of NAME_taylor_sums. Orders are computed up to the highest that a lane requests.
constexpr const char* series_block = R"(/* sums[i] = a_1 b_(k-1) + ... + a_(k-1) b_1 of each product i. */
static void {0}taylor_sums(int k, const {0}lanes* a, const {0}lanes* b, {0}lanes* sums)
{{
  int i, j;
  for (i = 0; i < {products}; i += 4) {{
    {0}lanes s0 = {{0}}, s1 = {{0}}, s2 = {{0}}, s3 = {{0}}; /* a sum waits for its last one */
    for (j = 1; j < k; ++j) {{
      const {0}lanes* const u = a + j*{products} + i;
      const {0}lanes* const v = b + (k - j)*{products} + i;
      s0 += u[0]*v[0];
      s1 += u[1]*v[1];
      s2 += u[2]*v[2];
      s3 += u[3]*v[3];
    }}
    sums[i] = s0;
    sums[i + 1] = s1;
    sums[i + 2] = s2;
    sums[i + 3] = s3;
  }}
}}

__attribute__((noinline))
static int {0}taylor_block(const struct {0}block* block, size_t now)
{{
  {0}lanes a[{series}], b[{series}], w[{prepared}], c[{coefficients}], order_of_next;
  long long lane_fine[{0}WIDTH];
  const int* const orders = block->order + now*block->order_advance;
  const struct {0}target* place;
  struct {0}block inner = *block;
  {0}mask fine = {0}whole(), alike;
  double* to;
  int i, k, lane, highest = 0;
  size_t array;
  for (array = 0; array < 5; ++array) {{
    inner.from[array] = block->from[array] + now*block->advance[array];
    inner.advance[array] = 0;
  }}
  inner.mode = block->mode + now*block->mode_advance;
  inner.fine = lane_fine;
  inner.target.step = {0}WIDTH;
  inner.target.advance = 0;
  inner.target.to[0] = (double*)w;
  inner.target.to[1] = (double*)(c + {n});
  inner.target.to[2] = NULL;
  inner.aside = inner.target;
  for (lane = 0; lane < {0}WIDTH; ++lane) {{
    if (orders[lane] < 0 || orders[lane] > {name}_taylor_order)
      fine[lane] = 0;
    else if (orders[lane] > highest)
      highest = orders[lane];
  }}
  for (i = 0; i < {n}; ++i) c[i] = {0}at(block, now, 1, (size_t)i);
  if ({0}taylor_start_block(&inner, 0) != 0) {{
    memcpy(&alike, lane_fine, sizeof alike);
    fine &= alike;
  }}
  inner.from[0] = (const double*)&order_of_next;
  inner.from[3] = (const double*)w;
  inner.step[1] = inner.step[3] = {0}WIDTH;
  for (k = 1; k < highest; ++k) {{
    order_of_next = {0}all((double)k);
    {0}taylor_sums(k, a, b, w + {zeros});
    w[{prepared} - 2] = {0}all((double)k == 1.0 ? 1.0 : 0.0);
    w[{prepared} - 1] = {0}all(1.0/(double)k);
    inner.from[1] = (const double*)(c + {n}*k);
    inner.target.to[0] = (double*)(a + {products}*k);
    inner.target.to[1] = (double*)(b + {products}*k);
    inner.target.to[2] = (double*)(c + {n}*(k + 1));
    inner.aside = inner.target;
    if ({0}taylor_next_block(&inner, 0) != 0) {{
      memcpy(&alike, lane_fine, sizeof alike);
      fine &= alike;
    }}
    for (i = 0; i < {n}; ++i) c[{n}*(k + 1) + i] = c[{n}*(k + 1) + i]/{0}all((double)(k + 1));
  }}
  for (lane = 0; lane < {0}WIDTH; ++lane) {{
    double finite = 0.0;
    for (i = 0; fine[lane] && i < {n}; ++i) finite = finite + c[{n}*orders[lane] + i][lane];
    if (!(finite - finite <= 0.0)) fine[lane] = 0;
  }}
  place = {0}place(block, fine);
  to = {0}to(place, now, 0);
  for (i = 0; i < {n}*(highest + 1); ++i) {0}store(to + (size_t)i*place->step, c[i]);
  return place != &block->target;
}}
)";

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
  return kernel("taylor_start", print_function(taylor.start, names, context, dialect)) +
         kernel("taylor_next", print_function(taylor.next, of_next, context, dialect)) +
         fmt::format(fmt::runtime(series_block), dialect.lane_prefix, fmt::arg("name", mangled_id(context.id)),
                     fmt::arg("n", program.state_count()), fmt::arg("products", taylor.product_count),
                     fmt::arg("series", taylor.product_count * orders), fmt::arg("prepared", taylor.workspace_size()),
                     fmt::arg("zeros", taylor.order_zero_count),
                     fmt::arg("coefficients", program.state_count() * (orders + 1)));
}

}  // namespace eomgen::emit
