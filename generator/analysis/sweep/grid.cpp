// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/sweep/grid.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <cmath>

#include "analysis/shortest_decimal.hpp"
#include "error.hpp"

namespace eomgen::analysis {

using symbolic::Rational;

Rational GridAxis::value(std::size_t i) const {
  if (!values.empty()) return values[i];
  if (i == 0 || i + 1 == count) return i == 0 ? from : to;
  const auto step = static_cast<long>(i), steps = static_cast<long>(count - 1);
  if (!logarithmic) return from + (to - from) * step / steps;
  return shortest_decimal(cln::double_approx(from) * std::pow(cln::double_approx(to / from),
                                                              static_cast<double>(step) / static_cast<double>(steps)),
                          parameter);
}

std::string GridAxis::domain_error() const {
  if (!logarithmic) return "";
  if (cln::minusp(from * to) || cln::zerop(from * to)) return "goes through 0 or changes its sign, which log cannot";
  for (const Rational& value : {from, to, to / from}) {
    const double rounded = cln::double_approx(value);
    if (!std::isfinite(rounded) || rounded == 0) return "leaves the range of binary64";
  }
  return "";
}

Grid::Grid(std::vector<GridAxis> axes) : axes_(std::move(axes)) {
  for (const GridAxis& axis : axes_) {
    if (axis.count > max_points / size_)
      throw Error("sweep", {}, fmt::format("the grid has more than {} points", max_points), "take fewer");
    size_ *= axis.count;
  }
}

std::map<std::string, Rational> Grid::point(std::size_t index) const {
  std::map<std::string, Rational> result;
  for (std::size_t a = axes_.size(); a-- > 0;) {
    result[axes_[a].parameter] = axes_[a].value(index % axes_[a].count);
    index /= axes_[a].count;
  }
  return result;
}

}  // namespace eomgen::analysis
