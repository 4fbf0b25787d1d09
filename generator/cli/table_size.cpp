// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/table_size.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/output.hpp"
#include "error.hpp"

namespace eomgen::cli {
namespace {

constexpr double bytes_of_number = 20;  // 17 digits, decimal point, comma, sometimes a sign or exponent
constexpr double reported_rows = 1e6, most_rows = 1e8, most_bytes = 1e10;

}  // namespace

double expected_rows(double t0, double t1, double every) { return std::floor((t1 - t0) / every) + 1; }

void require_size(double t0, double t1, double every, std::size_t columns, bool yes) {
  const double rows = expected_rows(t0, t1, every);
  const double last = std::max(std::abs(t0), std::abs(t1));
  if (t1 > t0 && last + every == last) {
    throw Error("run", {}, fmt::format("the interval of rows, {}, is lost in the rounding of t = {}", every, last),
                "take a longer --every");
  }
  const double bytes = rows * static_cast<double>(columns + 1) * bytes_of_number;
  const std::string size = fmt::format("{:.3g} rows, about {}", rows, size_text(bytes));
  if (!yes && (rows > most_rows || bytes > most_bytes)) {
    throw Error("run", {}, fmt::format("the interval of rows, {}, asks for {}", every, size),
                "take a longer --every; with --yes they are written");
  }
  if (rows > reported_rows) print_message(fmt::format("note: the interval of rows, {}, asks for {}\n", every, size));
}

}  // namespace eomgen::cli
