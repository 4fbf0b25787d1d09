// SPDX-License-Identifier: GPL-3.0-or-later
// The keyframes of a run as a file (`run --animation`). In: the drawing's outputs in the rows of the run. Out: glTF.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/drawing/parts.hpp"
#include "cli/output.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::cli {

class AnimationFile {
 public:
  /// Empty path: no animation.
  explicit AnimationFile(std::string path) : path_(std::move(path)) {}

  bool wanted() const { return !path_.empty(); }
  OutputTarget target() const { return {"--animation", path_, ".glb"}; }

  /// Adds the outputs of the drawing to all candidates. Returns their names. Throws Error if nothing can be drawn.
  std::vector<std::string> prepare(pipeline::DerivedModel& derived);
  /// names: the columns of the rows; expected_rows: of the whole run.
  void begin(const std::vector<std::string>& names, double expected_rows);
  void row(double t, std::span<const double> values);
  /// Returns the number of bytes.
  std::uint64_t write(const pipeline::Simulation& simulation, const std::string& title) const;

 private:
  std::string path_;
  std::optional<analysis::Drawing> drawing_;
  std::vector<std::size_t> index_;
  std::uint64_t count_ = 0, stride_ = 1;
  std::vector<double> t_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace eomgen::cli
