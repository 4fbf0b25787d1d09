// SPDX-License-Identifier: GPL-3.0-or-later
// Formats the lines of a sweep's table. In: a run, its point, its result. Out: the line without line break.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "run/runner.hpp"
#include "symbolic/dag.hpp"

namespace eomgen::cli {

class RowText {
 public:
  using Point = std::map<std::string, symbolic::Rational>;

  RowText() = default;
  /// `varied`: the names of the points.
  RowText(std::vector<std::string> varied, const model::Model& model, const run::Scene& scene);

  std::string header() const;
  std::string of(std::size_t run, const Point& point, const run::RunResult& result) const;
  /// Line of a run that could not start.
  std::string refused(std::size_t run, const Point& point, const std::string& why) const;

 private:
  std::string beginning(std::size_t run, const Point& point) const;

  std::vector<std::string> varied_, titles_, names_;
};

}  // namespace eomgen::cli
