// SPDX-License-Identifier: GPL-3.0-or-later
// Plot of a run: panels over time or phase planes, with events and estimated errors, as SVG or text.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/panels.hpp"
#include "run/runner.hpp"

namespace eomgen::cli {

class RunPlot {
 public:
  /// `outputs`: of the model. `code`: names of the columns of a row. Throws Error if a panel names another column.
  RunPlot(std::vector<Panel> panels, const std::vector<system::Output>& outputs, const std::vector<std::string>& code);

  void row(double t, std::span<const double> values);

  std::string svg(const std::string& title, const run::RunResult& result) const;
  /// Plot as text, at most `columns` wide.
  std::string text_plot(const std::string& title, const run::RunResult& result, std::size_t columns) const;

 private:
  const std::vector<double>& curve(const std::string& name) const;

  std::vector<Panel> panels_;
  std::vector<std::string> names_, x_labels_;  // stored columns; horizontal axis labels, per panel
  std::vector<bool> equal_scales_;             // per panel: a path of lengths over lengths
  std::vector<std::size_t> index_;
  std::vector<double> t_;
  std::vector<std::vector<double>> columns_;
};

}  // namespace eomgen::cli
