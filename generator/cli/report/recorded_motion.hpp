// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of a run, kept for plots and for the animation of a page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace eomgen::cli {

class RecordedMotion {
 public:
  /// The outputs that the animation needs beside the coordinates: positions of all particles, bodies and points.
  static std::vector<std::string> needed(const model::Model& model);

  void begin(const std::vector<std::string>& names) { names_ = names; }
  void row(double t, std::span<const double> values);

  /// Plots of coordinates, one for each unit, and of the energies, as SVG.
  std::string plots(const model::Model& model) const;
  /// JSON for the page; empty where nothing moves in space.
  std::string animation(const model::Model& model) const;

 private:
  std::vector<double> column(const std::string& name) const;

  std::vector<std::string> names_;
  std::vector<double> t_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace eomgen::cli
