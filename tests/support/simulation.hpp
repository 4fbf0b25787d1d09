// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a shipped model in a test: final values by name, rows by name, error estimates and drifts.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/simulate.hpp"

namespace eomgen::test {

struct Rows {
  std::vector<std::string> names;
  std::vector<double> t;
  std::vector<std::vector<double>> y;

  std::size_t size() const { return t.size(); }
  double at(std::size_t row, const std::string& name) const;
};

double value_of(const std::vector<std::pair<std::string, double>>& values, const std::string& name);

struct FinishedRun {
  pipeline::Simulation simulation;
  Rows rows;

  double final(const std::string& name) const;
  double error(const std::string& name) const;
  double drift(const std::string& name) const;
  double parameter(const std::string& name) const;
};

std::string model_path(const std::string& name);
std::string read_text(const std::string& path);
void write_text(const std::string& path, const std::string& text);
std::shared_ptr<const model::Model> model_at(const std::string& path);

/// Runs models/NAME.toml (or a path that ends in .toml) and stores the rows. `adjust` may set scene, overrides and so
/// on.
FinishedRun run_model(const std::string& name, const std::function<void(pipeline::SimulationRequest&)>& adjust = {});

}  // namespace eomgen::test
