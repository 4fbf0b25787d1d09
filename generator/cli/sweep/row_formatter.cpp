// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/row_formatter.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/outcome.hpp>

#include "cli/output.hpp"
#include "cli/sweep/row_checksum.hpp"

namespace eomgen::cli {
namespace {

constexpr const char* refused_outcome = "refused";

// Quotes a field that contains a comma, a quotation mark or a line break. Spreadsheets execute texts that begin with
// one of the marks of a formula; after an apostrophe they show them.
std::string field(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  if (text.find_first_of("=+-@\t") == 0) text.insert(0, 1, '\'');
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string decimal(double value) {
  return std::isfinite(value) ? fmt::format("{:.17g}", unsigned_zero(value))
         : std::isnan(value)  ? "nan"
         : value > 0          ? "inf"
                              : "-inf";
}

}  // namespace

RowFormatter::RowFormatter(std::vector<std::string> varied, const model::Model& model, const run::Scene& scene)
    : varied_(std::move(varied)) {
  for (const std::string& name : varied_)
    titles_.push_back(run::is_start_value(model, name) ? "initial(" + name + ")" : name);
  names_ = run::state_columns(model);
  if (std::find(scene.outputs.begin(), scene.outputs.end(), "energy") == scene.outputs.end())
    names_.emplace_back("energy");
  names_.insert(names_.end(), scene.outputs.begin(), scene.outputs.end());
}

std::string RowFormatter::header() const {
  std::string text = "run";
  for (const std::string& title : titles_) text += "," + title;
  text += ",outcome,t,steps,rhs_evaluations";
  for (const std::string& name : names_) text += "," + name;
  return text + ",error_estimate,detail," + checksum_column;
}

std::string RowFormatter::format_point(std::size_t run, const std::vector<std::string>& varied, const Point& point) {
  std::string text = std::to_string(run);
  for (const std::string& name : varied) text += "," + decimal(cln::double_approx(point.at(name)));
  return text;
}

std::string RowFormatter::format_refused(std::size_t run, const Point& point, const std::string& why) const {
  return format_point(run, varied_, point) + "," + refused_outcome + ",,," + std::string(names_.size() + 1, ',') + "," +
         field(why);
}

std::string RowFormatter::format_row(std::size_t run, const Point& point, const run::RunResult& result) const {
  std::string text =
      format_point(run, varied_, point) + fmt::format(",{},{},{},{}", eom::name(result.outcome), decimal(result.t),
                                                      result.statistics.steps, result.statistics.rhs_evaluations);
  for (const std::string& name : names_) {
    const auto found =
        std::find_if(result.final.begin(), result.final.end(), [&](const auto& entry) { return entry.first == name; });
    text += "," + (found == result.final.end() ? "" : decimal(found->second));
  }
  const auto& estimate = result.error_estimate;
  return text + "," + (estimate.empty() ? "" : decimal(estimate.back().second)) + "," + field(result.detail);
}

}  // namespace eomgen::cli
