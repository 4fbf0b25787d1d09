// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <eom/outcome.hpp>

namespace eomgen::cli {
namespace {

/// Neumaier's sum.
class Sum {
 public:
  void add(double value) {
    const double sum = sum_ + value;
    rest_ += std::abs(sum_) >= std::abs(value) ? (sum_ - sum) + value : (value - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0, rest_ = 0;
};

std::vector<std::string> fields_of(const std::string& line, std::size_t most) {
  std::vector<std::string> fields;
  std::size_t begin = 0;
  while (fields.size() < most) {
    const std::size_t end = line.find(',', begin);
    fields.push_back(line.substr(begin, end == std::string::npos ? std::string::npos : end - begin));
    if (end == std::string::npos) break;
    begin = end + 1;
  }
  return fields;
}

}  // namespace

ColumnStatistics statistics_of(const std::string& name, std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  ColumnStatistics result;
  result.name = name;
  result.count = values.size();
  if (values.empty()) return result;
  const auto count = static_cast<double>(values.size());
  Sum sum, squares;
  for (const double value : values) sum.add(value);
  result.mean = sum.value() / count;
  for (const double value : values) squares.add((value - result.mean) * (value - result.mean));
  result.deviation = values.size() > 1 ? std::sqrt(squares.value() / (count - 1)) : 0;
  result.least = values.front();
  result.greatest = values.back();
  for (const double part : quantile_parts) {
    const double place = part * (count - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    result.quantiles.push_back(values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]));
  }
  return result;
}

std::vector<ColumnStatistics> statistics_of_table(const std::string& header, const std::vector<const std::string*>& rows) {
  const std::vector<std::string> names = fields_of(header, std::string::npos);
  const auto outcome = static_cast<std::size_t>(std::find(names.begin(), names.end(), "outcome") - names.begin());
  std::vector<ColumnStatistics> result;
  if (outcome >= names.size()) return result;
  for (std::size_t column = outcome + 1; column + 1 < names.size(); ++column) {  // the last one is a sentence
    std::vector<double> values;
    for (const std::string* row : rows) {
      const std::vector<std::string> fields = fields_of(*row, column + 1);
      if (fields.size() <= column || fields[column].empty()) continue;
      if (fields[outcome] != eom::name(eom::Outcome::done) && fields[outcome] != eom::name(eom::Outcome::stopped_by_event)) continue;
      const double value = std::strtod(fields[column].c_str(), nullptr);
      if (std::isfinite(value)) values.push_back(value);
    }
    if (!values.empty()) result.push_back(statistics_of(names[column], values));
  }
  return result;
}

nlohmann::ordered_json to_json(const std::vector<ColumnStatistics>& columns) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ColumnStatistics& c : columns) {
    list.push_back({{"column", c.name}, {"count", c.count}, {"mean", c.mean}, {"deviation", c.deviation}, {"min", c.least}, {"max", c.greatest}});
    nlohmann::ordered_json& quantiles = list.back()["quantiles"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < c.quantiles.size(); ++i) quantiles.push_back({{"part", quantile_parts[i]}, {"value", c.quantiles[i]}});
  }
  return list;
}

std::string to_text(const std::vector<ColumnStatistics>& columns) {
  std::size_t width = 6;
  for (const ColumnStatistics& c : columns) width = std::max(width, c.name.size());
  std::string text = fmt::format("{:<{}} {:>9} {:>13} {:>13} {:>13}", "column", width, "runs", "mean", "deviation", "min");
  for (const double part : quantile_parts) text += fmt::format(" {:>13}", fmt::format("{:g} %", 100 * part));
  text += fmt::format(" {:>13}\n", "max");
  for (const ColumnStatistics& c : columns) {
    text += fmt::format("{:<{}} {:>9} {:>13.6g} {:>13.6g} {:>13.6g}", c.name, width, c.count, c.mean, c.deviation, c.least);
    for (const double value : c.quantiles) text += fmt::format(" {:>13.6g}", value);
    text += fmt::format(" {:>13.6g}\n", c.greatest);
  }
  return text;
}

}  // namespace eomgen::cli
