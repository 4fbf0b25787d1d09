// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/row_count.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"

namespace eomgen::pipeline {

double expected_rows(double t0, double t1, double every) { return std::floor((t1 - t0) / every) + 1; }

void require_distinct_rows(double t0, double t1, double every, const std::string& remedy) {
  const double last = std::max(std::abs(t0), std::abs(t1));
  if (!(t1 > t0) || last + every != last) return;
  throw Error("run", {}, fmt::format("the interval of rows, {}, is lost in the rounding of t = {}", every, last),
              remedy);
}

}  // namespace eomgen::pipeline
