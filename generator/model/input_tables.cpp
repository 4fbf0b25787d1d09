// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of inputs: written in a scene, or columns of a CSV file.
#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "model/csv_file.hpp"
#include "model/data_file.hpp"
#include "model/read_scenes.hpp"
#include "model/units.hpp"

namespace eomgen::model {
namespace {

double factor_of(const MeasuredUnit& unit) {
  return cln::double_approx(unit.scale) * std::pow(std::numbers::pi, unit.pi_power);
}

}  // namespace

InputTable ScenesReader::read_input_table(const Value& table, const Symbol& input) {
  const std::string what = fmt::format("the table of the input '{}'", input.name);
  InputTable result =
      table.find("csv") != nullptr ? read_csv_table(table, input, what) : read_written_table(table, input, what);
  const Value* kind = table.find("interpolation");
  if (kind == nullptr) return result;
  const std::string remedy = "write interpolation = \"linear\", or \"hold\" for values that last until the next time";
  require_kind(Value::Kind::text, *kind, "'interpolation'", remedy);
  if (kind->text != "linear" && kind->text != "hold")
    source_.fail(kind->span, fmt::format("there is no interpolation {}", quote(kind->text)), remedy);
  result.interpolation = kind->text == "linear" ? Interpolation::linear : Interpolation::hold;
  return result;
}

InputTable ScenesReader::read_written_table(const Value& table, const Symbol& input, const std::string& what) {
  const std::string remedy = "write { t = [0, 1, 2], value = [0, 5, 0] }: value[k] holds from t[k] on";
  check_keys(table, {what, {"t", "value", "interpolation"}});
  const Value& times = require_kind(Value::Kind::array, require_value(table, "t", what, remedy), "'t'", remedy);
  const Value& values =
      require_kind(Value::Kind::array, require_value(table, "value", what, remedy), "'value'", remedy);
  if (times.items.empty() || times.items.size() != values.items.size()) {
    source_.fail(values.span,
                 fmt::format("{} has {} times and {} values", what, times.items.size(), values.items.size()), remedy);
  }
  InputTable result;
  std::optional<Rational> last;
  const Context at{"a time of " + what, 0, Shape::scalar, dimension_of("s"), ""};
  const Context value{"a value of " + what, 0, Shape::scalar, input.typed.dimension, ""};
  for (std::size_t k = 0; k < times.items.size(); ++k) {
    const TypedNode t = resolver_.value(times.items[k], at);
    if (last && t.constant && *t.constant <= *last)
      source_.fail(times.items[k].span, fmt::format("the times of {} do not grow", what), remedy);
    last = t.constant;
    result.t.push_back(t.node);
    result.value.push_back(resolver_.value(values.items[k], value).node);
  }
  return result;
}

InputTable ScenesReader::read_csv_table(const Value& table, const Symbol& input, const std::string& what) {
  check_keys(table, {what, {"csv", "time", "value", "time_unit", "unit", "interpolation"}});
  const std::string path = text_of_key(table, "csv", what);
  const auto column = [&](const char* key, const std::string& otherwise) {
    return table.find(key) == nullptr ? otherwise : text_of_key(table, key, what);
  };
  const auto factor = [&](const char* key, const std::optional<Dimension>& dimension) {
    const Value* value = table.find(key);
    if (value == nullptr) return 1.0;
    const MeasuredUnit unit = any_unit(*value, what);
    if (dimension && !same(unit.dimension, *dimension))
      source_.fail(value->span, fmt::format("{} has no values in {}", what, quote(value->text)),
                   fmt::format("write a unit of {}", is_one(*dimension) ? "1" : text_of(*dimension)));
    return factor_of(unit);
  };
  const double time_factor = factor("time_unit", dimension_of("s")),
               factor_of_values = factor("unit", input.typed.dimension);
  const Span place = table.find("csv")->span;
  std::string text;
  try {
    text = read_data_file(context_.folder, path, max_csv_bytes);
  } catch (const DataFileError& error) {
    source_.fail(place, error.message(), error.remedy());
  }
  CsvColumns columns = read_csv((std::filesystem::path(context_.folder) / path).string(), text,
                                {column("time", "t"), column("value", input.name)});
  for (double& t : columns.first) t *= time_factor;
  for (double& value : columns.second) value *= factor_of_values;
  context_.data_hashes.push_back(columns.content_hash);
  InputTable result;
  result.csv_times = std::move(columns.first);
  result.csv_values = std::move(columns.second);
  return result;
}

}  // namespace eomgen::model
