// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/axes.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>

#include "cli/assignments.hpp"
#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

using analysis::Design;
using analysis::GridAxis;
using analysis::SampledAxis;
using symbolic::Rational;

[[noreturn]] void wrong_grid(const std::string& what) {
  throw Error("sweep", {}, what,
              "write --grid NAME=FROM:TO:COUNT, NAME=FROM:TO:log:COUNT, or NAME=a,b,c, in SI units or as 30deg, 5mm");
}
[[noreturn]] void wrong_sample(const std::string& what) {
  throw Error(
      "sweep", {}, what,
      "write --sample NAME=FROM:TO, NAME=FROM:TO:log or NAME=MEAN:DEVIATION:normal, in SI units or as 30deg, 5mm, with "
      "--samples N");
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

/// Splits NAME=VALUES. Calls `wrong` if the name is missing.
template <class Wrong>
std::pair<std::string, std::string> assignment(const std::string& text, Wrong&& wrong) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) wrong(fmt::format("{} names no parameter", model::quote(text)));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// Values of one parameter, written with units of one dimension, or all without; 0 needs none.
class WrittenValues {
 public:
  explicit WrittenValues(const std::string& text) : text_(text) {}

  /// The next value in SI units.
  template <class Wrong>
  Rational next(const std::string& written, Wrong&& wrong) {
    const Quantity quantity = parse_quantity(written, text_);
    if (quantity.unit && !unit_) unit_ = quantity.unit;
    if (!quantity.unit && !cln::zerop(quantity.value)) bare_ = true;
    if (unit_ && (bare_ || (quantity.unit && !model::same(quantity.unit->dimension, unit_->dimension))))
      wrong(fmt::format("{} mixes {} with other units", model::quote(text_), unit_->text));
    return quantity.value;
  }
  const std::optional<model::MeasuredUnit>& unit() const { return unit_; }

 private:
  const std::string& text_;
  std::optional<model::MeasuredUnit> unit_;
  bool bare_ = false;
};

std::size_t count_of(const std::string& text, const std::string& axis) {
  const Rational value = parse_decimal(text, axis);
  if (cln::denominator(value) != 1 || value < 2)
    wrong_grid(fmt::format("the number of values in {} is not a whole number of at least 2", model::quote(axis)));
  if (value > Rational(analysis::max_points))
    wrong_grid(fmt::format("{} asks for more than {} values", model::quote(axis), analysis::max_points));
  return static_cast<std::size_t>(cln::double_approx(value));
}

GridAxis axis_of(const std::string& text) {
  const auto [parameter, values] = assignment(text, wrong_grid);
  GridAxis axis{parameter, {}, 0, 0};
  WrittenValues written(text);
  const std::vector<std::string> fields = parts(values, ':');
  if (fields.size() == 1) {
    for (const std::string& value : parts(values, ',')) axis.values.push_back(written.next(value, wrong_grid));
    axis.count = axis.values.size();
    axis.unit = written.unit();
    return axis;
  }
  if (fields.size() > 4 || fields.size() == 2) wrong_grid(fmt::format("{} is no range of values", model::quote(text)));
  const std::string kind = fields.size() == 4 ? fields[2] : "lin";
  if (kind != "lin" && kind != "log")
    wrong_grid(fmt::format("{} has {} where lin or log is asked", model::quote(text), model::quote(kind)));
  axis.from = written.next(fields[0], wrong_grid);
  axis.to = written.next(fields[1], wrong_grid);
  axis.unit = written.unit();
  axis.logarithmic = kind == "log";
  axis.count = count_of(fields.back(), text);
  if (const std::string why = axis.domain_error(); !why.empty()) wrong_grid(model::quote(text) + " " + why);
  return axis;
}

SampledAxis sampled_axis_of(const std::string& text) {
  const auto [parameter, values] = assignment(text, wrong_sample);
  const std::vector<std::string> fields = parts(values, ':');
  if (fields.size() < 2 || fields.size() > 3)
    wrong_sample(fmt::format("{} is no range of samples", model::quote(text)));
  WrittenValues written(text);
  const auto number = [&](const std::string& field) {
    const Rational value = written.next(field, wrong_sample);
    const double rounded = cln::double_approx(value);
    if (rounded == 0 && !cln::zerop(value)) wrong_sample(model::quote(text) + " leaves the range of binary64");
    return rounded;
  };
  SampledAxis axis{parameter, number(fields[0]), number(fields[1])};
  axis.unit = written.unit();
  const std::string kind = fields.size() == 3 ? fields[2] : "lin";
  if (kind == "log")
    axis.kind = SampledAxis::Kind::logarithmic;
  else if (kind == "normal")
    axis.kind = SampledAxis::Kind::normal;
  else if (kind != "lin")
    wrong_sample(fmt::format("{} has {} where lin, log or normal is asked", model::quote(text), model::quote(kind)));
  if (const std::string why = axis.domain_error(); !why.empty()) wrong_sample(model::quote(text) + " " + why);
  return axis;
}

template <class Axes>
bool has(const Axes& axes, const std::string& parameter) {
  return std::any_of(axes.begin(), axes.end(), [&](const auto& axis) { return axis.parameter == parameter; });
}

}  // namespace

analysis::Grid parse_grid(const std::vector<std::string>& texts) {
  if (texts.empty()) wrong_grid("nothing is to be varied");
  std::vector<GridAxis> axes;
  for (const std::string& text : texts) {
    GridAxis axis = axis_of(text);
    if (has(axes, axis.parameter)) wrong_grid(fmt::format("{} has two grids", model::quote(axis.parameter)));
    axes.push_back(std::move(axis));
  }
  return analysis::Grid(std::move(axes));
}

analysis::Sampling parse_sampling(const std::vector<std::string>& texts, std::size_t count, const std::string& design,
                                  std::uint64_t seed) {
  if (texts.empty()) wrong_sample("--samples gives a number, and no --sample names a parameter");
  if (count == 0) wrong_sample("--sample names a parameter, and --samples gives no number");
  constexpr Design designs[] = {Design::random, Design::latin, Design::sobol};
  const auto* const found =
      std::find_if(std::begin(designs), std::end(designs), [&](Design d) { return design == analysis::name(d); });
  if (found == std::end(designs))
    throw Error("sweep", {}, fmt::format("there is no design {}", model::quote(design)),
                "choose random, latin or sobol");
  std::vector<SampledAxis> axes;
  for (const std::string& text : texts) {
    SampledAxis axis = sampled_axis_of(text);
    if (has(axes, axis.parameter)) wrong_sample(fmt::format("{} is sampled twice", model::quote(axis.parameter)));
    axes.push_back(std::move(axis));
  }
  return {std::move(axes), count, *found, seed};
}

}  // namespace eomgen::cli
