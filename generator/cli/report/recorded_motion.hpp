// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a run, stored for the plots and the animation of a page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/drawing/forces.hpp"
#include "analysis/drawing/primitives.hpp"
#include "analysis/page/live_model.hpp"
#include "cli/json.hpp"
#include "cli/panels.hpp"

namespace eomgen::cli {

class RecordedMotion {
 public:
  void begin(const std::vector<std::string>& names) { names_ = names; }
  void row(double t, std::span<const double> values);

  std::size_t size() const { return t_.size(); }
  /// Drops every second row and keeps the last one.
  void drop_every_second_row();

  /// Rows with these values; 0 of names that the run does not have.
  std::vector<std::vector<double>> values(const std::vector<std::string>& names) const;

  /// Panels as SVG, for pages without scripts and for print.
  std::string plots(const std::vector<Panel>& panels) const;

  /// Data for the page's script; null if nothing can be drawn or integrated. With a live model it contains only the
  /// states, from which the script computes the rest; otherwise all `outputs`.
  Json json(const pipeline::Simulation& simulation, const analysis::Drawing& drawing,
            const analysis::Primitives& primitives, const analysis::DrawnForces& forces,
            const analysis::LiveModel& live, const std::vector<std::string>& outputs,
            const std::vector<Panel>& panels) const;

 private:
  std::vector<double> column(const std::string& name) const;
  Json rows(const std::vector<std::string>& names, int digits) const;

  std::vector<std::string> names_;
  std::vector<double> t_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace eomgen::cli
