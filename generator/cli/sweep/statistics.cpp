// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/outcome.hpp>
#include <eom/output/decimal.hpp>

namespace eomgen::cli {

using analysis::ColumnStatistics;
using analysis::quantile_levels;

namespace {

constexpr std::size_t values_in_memory = 16'000'000;  // in memory at the same time

/// Calls take(number, field) with the first fields of a line, which are not quoted.
template <class Take>
void each_field(std::string_view line, std::size_t most, Take&& take) {
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t end = line.find(',');
    take(k, line.substr(0, end));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

}  // namespace

bool is_successful(std::string_view outcome) {
  return outcome == eom::name(eom::Outcome::done) || outcome == eom::name(eom::Outcome::stopped_by_event);
}

std::vector<ColumnStatistics> statistics_of_table(const std::string& header, std::size_t rows,
                                                  const RowSource& for_each_row) {
  std::vector<std::string> names;
  each_field(header, std::string::npos, [&](std::size_t, std::string_view name) { names.emplace_back(name); });
  const auto outcome = static_cast<std::size_t>(std::find(names.begin(), names.end(), "outcome") - names.begin());
  std::vector<ColumnStatistics> result;
  const std::size_t at_once = std::max<std::size_t>(1, values_in_memory / std::max<std::size_t>(rows, 1));
  const std::size_t end = names.size() - 2;  // the last columns are the detail and the checksum
  for (std::size_t first = outcome + 1; first < end; first += at_once) {
    const std::size_t last = std::min(first + at_once, end);
    std::vector<std::vector<double>> values(last - first);
    for_each_row([&](std::string_view row) {
      bool well = false;
      each_field(row, last, [&](std::size_t k, std::string_view text) {
        if (k == outcome) well = is_successful(text);
        if (k < first || !well) return;
        double value = 0;
        const auto [stop, error] = eom::decimals::read_decimal(text, value);
        if (error == std::errc() && stop == text.data() + text.size() && std::isfinite(value))
          values[k - first].push_back(value);
      });
    });
    for (std::size_t k = first; k < last; ++k) {
      if (!values[k - first].empty()) result.push_back(analysis::statistics_of(names[k], values[k - first]));
    }
  }
  return result;
}

void classify_runs(analysis::BasinStatistics& basins, const std::string& header, const RowSource& for_each_row) {
  std::vector<std::string> names;
  each_field(header, std::string::npos, [&](std::size_t, std::string_view name) { names.emplace_back(name); });
  const auto place_of = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const std::size_t outcome = place_of("outcome");
  std::vector<std::size_t> places;
  for (const std::string& name : basins.names()) places.push_back(place_of(name));
  std::vector<double> state(places.size());
  for_each_row([&](std::string_view row) {
    bool well = false;
    each_field(row, names.size() - 2, [&](std::size_t k, std::string_view text) {
      if (k == outcome) well = is_successful(text);
      const auto place = std::find(places.begin(), places.end(), k);
      if (place == places.end()) return;
      double& value = state[static_cast<std::size_t>(place - places.begin())];
      const auto [stop, error] = eom::decimals::read_decimal(text, value);
      if (error != std::errc() || stop != text.data() + text.size()) value = std::nan("");
    });
    if (well) basins.classify(state);
  });
}

Json to_json(const analysis::BasinStatistics& basins) {
  Json attractors = Json::array();
  for (const analysis::BasinStatistics::Attractor& goal : basins.attractors()) {
    Json values = Json::object();
    for (const auto& [name, value] : goal.values) values[name] = value;
    attractors.push_back({{"values", values}, {"stability", linear::name(goal.stability)}, {"runs", goal.runs}});
  }
  return {{"within", basins.tolerance()}, {"reached", attractors}, {"elsewhere", basins.unclassified()}};
}

std::string to_text(const analysis::BasinStatistics& basins) {
  std::string text = fmt::format("reached, within {:g}\n", basins.tolerance());
  for (const analysis::BasinStatistics::Attractor& goal : basins.attractors()) {
    text += fmt::format("{:>9} runs at", goal.runs);
    for (const auto& [name, value] : goal.values) {
      if (value != 0 || !name.ends_with("_dot")) text += fmt::format(" {} = {:.6g}", name, value);
    }
    text += fmt::format(" ({})\n", linear::name(goal.stability));
  }
  return text + fmt::format("{:>9} runs elsewhere\n", basins.unclassified());
}

Json to_json(const std::vector<ColumnStatistics>& columns) {
  Json list = Json::array();
  for (const ColumnStatistics& c : columns) {
    list.push_back({{"column", c.name},
                    {"count", c.count},
                    {"mean", c.mean},
                    {"deviation", c.deviation},
                    {"min", c.least},
                    {"max", c.greatest},
                    {"histogram", c.histogram}});
    Json& quantiles = list.back()["quantiles"] = Json::array();
    for (std::size_t i = 0; i < c.quantiles.size(); ++i)
      quantiles.push_back({{"part", quantile_levels[i]}, {"value", c.quantiles[i]}});
  }
  return list;
}

std::string to_text(const std::vector<ColumnStatistics>& columns) {
  std::size_t width = 6;
  for (const ColumnStatistics& c : columns) width = std::max(width, c.name.size());
  std::string text =
      fmt::format("{:<{}} {:>9} {:>13} {:>13} {:>13}", "column", width, "runs", "mean", "deviation", "min");
  for (const double part : quantile_levels) text += fmt::format(" {:>13}", fmt::format("{:g} %", 100 * part));
  text += fmt::format(" {:>13}\n", "max");
  for (const ColumnStatistics& c : columns) {
    text +=
        fmt::format("{:<{}} {:>9} {:>13.6g} {:>13.6g} {:>13.6g}", c.name, width, c.count, c.mean, c.deviation, c.least);
    for (const double value : c.quantiles) text += fmt::format(" {:>13.6g}", value);
    text += fmt::format(" {:>13.6g}\n", c.greatest);
  }
  return text;
}

}  // namespace eomgen::cli
