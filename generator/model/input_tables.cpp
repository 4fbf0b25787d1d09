// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of inputs: written in a scene, or columns of a CSV file.
#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <eom/output/decimal.hpp>
#include <filesystem>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "error.hpp"
#include "model/content_hash.hpp"
#include "model/data_file.hpp"
#include "model/names.hpp"
#include "model/read_scenes.hpp"
#include "model/units.hpp"

namespace eomgen::model {
namespace {

// Columns of numbers in a CSV file beside a model file. The file is untrusted: its rows are bounded, and its bytes
// where it is read (data_file.hpp). In: the text, names of columns. Out: numbers; every error has the file, line and
// column.

/// Largest CSV file in bytes, and most rows of numbers.
constexpr std::size_t max_csv_bytes = std::size_t{1} << 24;
constexpr std::size_t max_csv_rows = 100000;

/// Two columns of a CSV file. The first one increases.
struct CsvColumns {
  std::vector<double> first, second;
  std::string content_hash;  // of the bytes of the file
};

/// A field of a line, without blanks and quotation marks around it.
struct Field {
  std::string_view text;
  std::size_t offset = 0;  // in the line
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

Field trimmed(std::string_view line, std::size_t from, std::size_t to) {
  while (from < to && is_blank(line[from])) ++from;
  while (to > from && is_blank(line[to - 1])) --to;
  if (to > from + 1 && line[from] == '"' && line[to - 1] == '"')
    return {line.substr(from + 1, to - from - 2), from + 1};
  return {line.substr(from, to - from), from};
}

std::vector<Field> fields_of(std::string_view line, char separator) {
  std::vector<Field> fields;
  bool in_quotes = false;
  std::size_t from = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') in_quotes = !in_quotes;
    if (i < line.size() && (in_quotes || line[i] != separator)) continue;
    fields.push_back(trimmed(line, from, i));
    from = i + 1;
  }
  return fields;
}

/// The separator of a header: the first kind that it contains outside of quotation marks.
char separator_of(std::string_view header) {
  for (const char candidate : {',', ';', '\t'})
    if (fields_of(header, candidate).size() > 1) return candidate;
  return ',';
}

/// Text for a message. Other bytes do not reach the terminal.
std::string printable(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c < 0x20 || c > 0x7e) c = c == '\t' ? ' ' : '?';
  return result;
}

class CsvReader {
 public:
  CsvReader(const std::string& file, const std::array<std::string, 2>& names) : file_(file), names_(names) {}

  CsvColumns read(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // the byte order mark
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      line_ = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++number_;
      const Field whole = trimmed(line_, 0, line_.size());
      if (whole.text.empty() || whole.text.front() == '#') continue;
      header_.empty() ? read_header() : read_row();
    }
    if (header_.empty()) fail_file("the file is empty", "write a line with names of columns, and lines of numbers");
    if (columns_.first.empty()) fail_file("no line of the file has numbers", "write them below the names of columns");
    return std::move(columns_);
  }

 private:
  void read_header() {
    separator_ = separator_of(line_);
    for (const Field& field : fields_of(line_, separator_)) header_.emplace_back(field.text);
    for (std::size_t i = 0; i < 2; ++i) {
      const auto found = std::find(header_.begin(), header_.end(), names_[i]);
      if (found == header_.end()) {
        std::vector<std::string> known;
        for (const std::string& name : header_) known.push_back(printable(name));
        known.resize(std::min<std::size_t>(known.size(), 20));
        fail(Field{line_, 0}, fmt::format("there is no column {}", quote(printable(names_[i]))),
             suggest_choice(printable(names_[i]), known));
      }
      if (std::find(found + 1, header_.end(), names_[i]) != header_.end())
        fail(Field{line_, 0}, fmt::format("there are two columns {}", quote(printable(names_[i]))),
             "give each column its own name");
      places_[i] = static_cast<std::size_t>(found - header_.begin());
    }
  }

  void read_row() {
    const std::vector<Field> fields = fields_of(line_, separator_);
    if (fields.size() != header_.size())
      fail(Field{line_, 0},
           fmt::format("the line has {} values, and {} columns have names", fields.size(), header_.size()),
           "give each column a value in each line");
    if (columns_.first.size() == max_csv_rows)
      fail(Field{line_, 0}, fmt::format("the file has more than {} rows", max_csv_rows),
           "keep every tenth row, or the part that a run needs");
    const double first = number_of(fields[places_[0]]);
    if (!columns_.first.empty() && !(first > columns_.first.back()))
      fail(fields[places_[0]],
           fmt::format("{} does not increase: it is {} after {}", quote(printable(names_[0])), first,
                       columns_.first.back()),
           "sort the rows by time, and keep one of each time");
    columns_.first.push_back(first);
    columns_.second.push_back(number_of(fields[places_[1]]));
  }

  double number_of(const Field& field) const {
    double value = 0;
    std::string_view text = field.text;
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, problem] = eom::decimals::read_decimal(text, value);
    if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail(field,
           field.text.empty() ? "a value is missing"
                              : fmt::format("{} is not a finite number", quote(printable(field.text))),
           "write a decimal number such as -1.5e-3; remove rows without a measured value");
    return value;
  }

  [[noreturn]] void fail(const Field& field, const std::string& what, const std::string& remedy) const {
    constexpr std::size_t longest = 500;
    const std::string text = field.offset < longest ? printable(line_.substr(0, longest)) : "";
    throw Error("model",
                SourceLocation{file_, number_, static_cast<std::uint32_t>(field.offset + 1),
                               static_cast<std::uint32_t>(std::clamp<std::size_t>(field.text.size(), 1, 40)), text},
                what, remedy);
  }
  [[noreturn]] void fail_file(const std::string& what, const std::string& remedy) const {
    throw Error("model", SourceLocation{file_, 0, 0, 1, ""}, what, remedy);
  }

  const std::string& file_;
  const std::array<std::string, 2>& names_;
  std::string_view line_;
  std::uint32_t number_ = 0;
  char separator_ = ',';
  std::vector<std::string> header_;
  std::array<std::size_t, 2> places_{};
  CsvColumns columns_;
};

/// Columns by their names in the header, the first line that is neither blank nor begins with #. Values are separated
/// by commas, semicolons or tabs. Throws Error with a place in `file` for missing columns, rows of another length,
/// fields that are not finite numbers, values of the first column that do not increase, and more rows than allowed.
CsvColumns read_csv(const std::string& file, const std::string& text, const std::array<std::string, 2>& names) {
  CsvColumns columns = CsvReader(file, names).read(text);
  columns.content_hash = content_hash(text);
  return columns;
}

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
