// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/table_size.hpp"

#include <fmt/format.h>

#include "cli/output.hpp"
#include "error.hpp"
#include "pipeline/row_count.hpp"

namespace eomgen::cli {
namespace {

constexpr double bytes_of_number = 20;  // 17 digits, decimal point, comma, sometimes a sign or exponent
constexpr double reported_rows = 1e6, most_bytes = 1e10;

}  // namespace

void require_size(double t0, double t1, double every, std::size_t columns, bool yes) {
  const double rows = pipeline::expected_rows(t0, t1, every);
  pipeline::require_distinct_rows(t0, t1, every, "take a longer --every");
  const double bytes = rows * static_cast<double>(columns + 1) * bytes_of_number;
  const std::string size = fmt::format("{:.3g} rows, about {}", rows, size_text(bytes));
  if (!yes && (rows > pipeline::most_rows || bytes > most_bytes)) {
    throw Error("run", {}, fmt::format("the interval of rows, {}, asks for {}", every, size),
                "take a longer --every; with --yes they are written");
  }
  if (rows > reported_rows) print_message(fmt::format("note: the interval of rows, {}, asks for {}\n", every, size));
}

}  // namespace eomgen::cli
