// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/grid.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/assignments.hpp"
#include "cli/output.hpp"
#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

using symbolic::Rational;

[[noreturn]] void fail(const std::string& what) {
  throw Error("sweep", {}, what, "write --grid NAME=FROM:TO:COUNT, NAME=FROM:TO:log:COUNT, or NAME=a,b,c, in SI units");
}

std::vector<std::string> parts(const std::string& text, char delimiter) {
  std::vector<std::string> result{""};
  for (const char c : text) {
    if (c == delimiter)
      result.emplace_back();
    else
      result.back() += c;
  }
  return result;
}

std::size_t count_of(const std::string& text, const std::string& axis) {
  const Rational value = parse_decimal(text, axis);
  if (cln::denominator(value) != 1 || value < 2)
    fail(fmt::format("the number of values in {} is not a whole number of at least 2", model::quote(axis)));
  if (value > Rational(static_cast<long>(most_points)))
    fail(fmt::format("{} asks for more than {} values", model::quote(axis), most_points));
  return static_cast<std::size_t>(cln::double_approx(value));
}

/// Throws where a value between would not exist.
void require_range(const Axis& axis, const std::string& text) {
  if (!axis.logarithmic) return;
  if (cln::minusp(axis.from * axis.to) || cln::zerop(axis.from * axis.to))
    fail(fmt::format("{} goes through 0 or changes its sign, which log cannot", model::quote(text)));
  for (const Rational& value : {axis.from, axis.to, axis.to / axis.from}) {
    const double rounded = cln::double_approx(value);
    if (!std::isfinite(rounded) || rounded == 0)
      fail(fmt::format("{} leaves the range of binary64", model::quote(text)));
  }
}

Axis axis_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) fail(fmt::format("{} names no parameter", model::quote(text)));
  Axis axis{text.substr(0, equals), {}, 0, 0};
  const std::string values = text.substr(equals + 1);
  const std::vector<std::string> fields = parts(values, ':');
  if (fields.size() == 1) {
    for (const std::string& value : parts(values, ',')) axis.listed.push_back(parse_decimal(value, text));
    axis.count = axis.listed.size();
    return axis;
  }
  if (fields.size() > 4 || fields.size() == 2) fail(fmt::format("{} is no range of values", model::quote(text)));
  const std::string kind = fields.size() == 4 ? fields[2] : "lin";
  if (kind != "lin" && kind != "log")
    fail(fmt::format("{} has {} where lin or log is asked", model::quote(text), model::quote(kind)));
  axis.from = parse_decimal(fields[0], text);
  axis.to = parse_decimal(fields[1], text);
  axis.logarithmic = kind == "log";
  axis.count = count_of(fields.back(), text);
  require_range(axis, text);
  return axis;
}

}  // namespace

Rational Axis::value(std::size_t i) const {
  if (!listed.empty()) return listed[i];
  if (i == 0 || i + 1 == count) return i == 0 ? from : to;
  const auto step = static_cast<long>(i), steps = static_cast<long>(count - 1);
  if (!logarithmic) return from + (to - from) * step / steps;
  // The shortest decimal that is this binary64, which the table shows.
  const double value = cln::double_approx(from) *
                       std::pow(cln::double_approx(to / from), static_cast<double>(step) / static_cast<double>(steps));
  return parse_decimal(shortest(value), parameter);
}

Grid::Grid(const std::vector<std::string>& axes) {
  if (axes.empty()) fail("nothing is to be varied");
  for (const std::string& text : axes) {
    axes_.push_back(axis_of(text));
    const Axis& axis = axes_.back();
    const auto same = [&](const Axis& other) { return other.parameter == axis.parameter; };
    if (std::count_if(axes_.begin(), axes_.end(), same) > 1)
      fail(fmt::format("{} has two grids", model::quote(axis.parameter)));
    if (axis.count > most_points / size_) fail(fmt::format("the grid has more than {} points", most_points));
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

}  // namespace eomgen::cli
