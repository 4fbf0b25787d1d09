// SPDX-License-Identifier: GPL-3.0-or-later
// Formats the lines of a sweep's table. In: a run, its point, its result. Out: the line without line break.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "run/runner.hpp"
#include "symbolic/dag.hpp"

namespace eomgen::cli {

class RowFormatter {
 public:
  using Point = std::map<std::string, symbolic::Rational>;

  RowFormatter() = default;
  /// `varied`: the names of the points.
  RowFormatter(std::vector<std::string> varied, const model::Model& model, const run::Scene& scene);

  /// Names of the columns, with that of the checksum.
  std::string header() const;
  /// Row without its checksum, as the next one.
  std::string format_row(std::size_t run, const Point& point, const run::RunResult& result) const;
  /// Row of a run that could not start.
  std::string format_refused(std::size_t run, const Point& point, const std::string& why) const;
  /// The first fields of a row: its run, and the values of `varied`.
  static std::string format_point(std::size_t run, const std::vector<std::string>& varied, const Point& point);

 private:
  std::vector<std::string> varied_, titles_, names_;
};

}  // namespace eomgen::cli
