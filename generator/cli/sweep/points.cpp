// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/points.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

#include "analysis/sweep/grid.hpp"
#include "analysis/sweep/sampling.hpp"
#include "cli/assignments.hpp"
#include "error.hpp"
#include "model/content_hash.hpp"
#include "model/names.hpp"

namespace eomgen::cli {

using analysis::Design;
using analysis::GridAxis;
using analysis::SampledAxis;
using analysis::Shard;
using symbolic::Rational;

namespace {

/// Parameter points from a CSV file: the first line has the names, each further line one point.
struct PointsFile {
  analysis::ListedPoints points;
  std::string content_hash;  // of its bytes
};

constexpr std::size_t largest_file = 1'000'000'000;

[[noreturn]] void refuse_file(const std::string& what, const std::string& remedy) {
  throw Error("sweep", {}, what, remedy);
}

std::string file_text(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none))
    refuse_file(fmt::format("--points {}: there is no such file", model::quote(path)),
                "name a CSV file: a line of parameters, then lines of values");
  if (std::filesystem::file_size(path, none) > largest_file)
    refuse_file(fmt::format("--points {}: the file is larger than 1 GB", model::quote(path)),
                "make several sweeps of parts of it");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file)
    refuse_file(fmt::format("--points {}: the file cannot be read", model::quote(path)), "see to your rights there");
  return text.str();
}

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  for (std::string& field : fields) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    field.erase(field.begin(), std::find_if_not(field.begin(), field.end(), blank));
    field.erase(std::find_if_not(field.rbegin(), field.rend(), blank).base(), field.end());
  }
  return fields;
}

/// Skips lines that are empty or begin with #. Throws Error with the line number if the file is no such table.
PointsFile read_points(const std::string& path) {
  const std::string text = file_text(path);
  PointsFile file{{}, model::content_hash(text)};
  auto& [names, values] = file.points;
  std::size_t number = 0;
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // the byte order mark
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    const std::vector<std::string> fields = fields_of(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const std::string place = fmt::format("--points {}, line {}", path, ++number);
    if ((fields.size() == 1 && fields[0].empty()) || fields[0].starts_with('#')) continue;
    if (names.empty()) {
      names = fields;
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) refuse_file(place + ": a column has no name", "name a parameter in each");
        if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
            names.begin() + static_cast<std::ptrdiff_t>(i)) {
          refuse_file(fmt::format("{}: {} comes twice", place, model::quote(names[i])), "name each parameter once");
        }
      }
      continue;
    }
    if (fields.size() != names.size()) {
      refuse_file(fmt::format("{}: {} values, and {} parameters are named", place, fields.size(), names.size()),
                  "give a value for each, with commas between them");
    }
    for (const std::string& field : fields) {
      const double value = cln::double_approx(parse_decimal(field, place));
      if (!std::isfinite(value))
        refuse_file(fmt::format("{}: {} leaves the range of binary64", place, model::quote(field)),
                    "use units in which it is nearer to 1");
      values.push_back(value);
    }
  }
  if (names.empty() || values.empty())
    refuse_file(fmt::format("--points {}: no line has values", model::quote(path)),
                "write a line of parameters, then lines of values");
  return file;
}

// Parser of the axes of a sweep: --grid k=1:1e6:log:13 --grid m=0.5,1,2; --sample k=1:100 --sample m=1:0.1:normal.

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

/// Each of `axes` is NAME=FROM:TO:COUNT, NAME=FROM:TO:lin:COUNT, NAME=FROM:TO:log:COUNT or NAME=a,b,c. Throws Error for
/// anything else, and for a repeated name.
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

/// Each of `axes` is NAME=FROM:TO, NAME=FROM:TO:log or NAME=MEAN:DEVIATION:normal; `design` is random, latin or sobol.
/// Throws Error.
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

constexpr const char* note = " shard ";

std::optional<std::size_t> whole(const std::string& text) {
  std::size_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<Shard> shard_of(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const auto number = whole(text.substr(0, slash)), count = whole(text.substr(slash + 1));
  if (!number || !count || *number < 1 || *number > *count) return std::nullopt;
  return Shard{*number, *count};
}

}  // namespace

analysis::SweepPoints points_of(const SweepOptions& options, std::uint64_t seed, std::string& file_hash) {
  const bool sampled = !options.sample.empty() || options.samples > 0, listed = !options.points.empty();
  if (options.design && !sampled)
    throw Error("sweep", {}, "--design is of samples, and there are none",
                "add --sample NAME=FROM:TO and --samples N, or leave it out");
  std::optional<analysis::Sampling> samples;
  std::optional<analysis::ListedPoints> list;
  std::optional<analysis::Grid> grid;
  if (sampled) samples = parse_sampling(options.sample, options.samples, options.design.value_or("random"), seed);
  if (listed) {
    PointsFile file = read_points(options.points);
    file_hash = file.content_hash;
    list = std::move(file.points);
  }
  if (sampled && listed)
    throw Error("sweep", {}, "--sample and --points both say what changes fastest", "leave one of them out");
  if (!options.grid.empty() || (!sampled && !listed)) grid = parse_grid(options.grid);
  for (const std::string& name : samples ? samples->names() : list ? list->names : std::vector<std::string>{}) {
    const auto named = [&name](const analysis::GridAxis& axis) { return axis.parameter == name; };
    if (!grid || std::none_of(grid->axes().begin(), grid->axes().end(), named)) continue;
    throw Error(
        "sweep", {},
        fmt::format("{} has a grid and is {}", model::quote(name), sampled ? "sampled" : "a column of --points"),
        "leave one of them out");
  }
  return {std::move(grid), std::move(samples), std::move(list)};
}

analysis::Shard parse_shard(const std::string& text) {
  if (const auto shard = shard_of(text)) return *shard;
  throw Error("sweep", {}, fmt::format("{} is no shard", model::quote(text)),
              "write --shard NUMBER/COUNT, such as 2/8; numbers begin with 1");
}

std::string shard_header(const analysis::Shard& shard, std::size_t runs) {
  return fmt::format("{}{}/{} of {}", note, shard.number, shard.count, runs);
}

std::optional<ShardHeader> parse_shard_header(const std::string& line) {
  const std::size_t at = line.find(note);
  if (at == std::string::npos) return std::nullopt;
  const std::string rest = line.substr(at + std::string(note).size());
  const std::size_t of = rest.find(" of ");
  if (of == std::string::npos) return std::nullopt;
  const auto shard = shard_of(rest.substr(0, of));
  const auto runs = whole(rest.substr(of + 4));
  if (!shard || !runs) return std::nullopt;
  return ShardHeader{line.substr(0, at), *shard, *runs};
}

}  // namespace eomgen::cli
