// SPDX-License-Identifier: GPL-3.0-or-later
// A shipped model run in a test: end values by name, rows by name, estimates and drifts.
#pragma once

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "pipeline/simulate.hpp"
#include "support/folders.hpp"

namespace eomgen::test {

struct Rows {
  std::vector<std::string> names;
  std::vector<double> t;
  std::vector<std::vector<double>> y;

  std::size_t size() const { return t.size(); }
  double at(std::size_t row, const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw std::logic_error("no column " + name);
    return y[row][static_cast<std::size_t>(found - names.begin())];
  }
};

inline double value_of(const std::vector<std::pair<std::string, double>>& values, const std::string& name) {
  for (const auto& [key, value] : values) {
    if (key == name) return value;
  }
  throw std::logic_error("no value " + name);
}

struct Finished {
  pipeline::Simulation simulation;
  Rows rows;

  double final(const std::string& name) const { return value_of(simulation.result.final, name); }
  double error(const std::string& name) const { return value_of(simulation.result.error_estimate, name); }
  double drift(const std::string& name) const {
    for (const run::Invariant& i : simulation.result.invariants) {
      if (i.name == name) return i.max_relative_drift;
    }
    throw std::logic_error("no invariant " + name);
  }
  double parameter(const std::string& name) const {
    const auto& parameters = simulation.derived->model.parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (parameters[i].name == name) return simulation.scene.parameters[i];
    }
    throw std::logic_error("no parameter " + name);
  }
};

inline std::string model_path(const std::string& name) { return test::source_folder() + "/models/" + name + ".toml"; }

inline std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

inline std::shared_ptr<const model::Model> model_at(const std::string& path) {
  return std::make_shared<const model::Model>(model::read_model(path));
}

/// Runs models/NAME.toml (or a path that ends in .toml); `adjust` may set scene, overrides and so on. Rows are kept.
inline Finished run_model(const std::string& name,
                          const std::function<void(pipeline::SimulationRequest&)>& adjust = {}) {
  pipeline::SimulationRequest request;
  request.model = model_at(name.ends_with(".toml") ? name : model_path(name));
  Rows rows;
  request.begin = [&rows](const pipeline::Derived&, const run::Scene&, const std::vector<std::string>& names) {
    rows.names = names;
  };
  request.row = [&rows](double t, std::span<const double> y) {
    rows.t.push_back(t);
    rows.y.emplace_back(y.begin(), y.end());
  };
  if (adjust) adjust(request);
  pipeline::Simulation simulation = pipeline::simulate(request);
  return {std::move(simulation), std::move(rows)};
}

}  // namespace eomgen::test
