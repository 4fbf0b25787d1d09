// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/simulation.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "support/folders.hpp"

namespace eomgen::test {

double Rows::at(std::size_t row, const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::logic_error("no column " + name);
  return y[row][static_cast<std::size_t>(found - names.begin())];
}

double value_of(const std::vector<std::pair<std::string, double>>& values, const std::string& name) {
  for (const auto& [key, value] : values) {
    if (key == name) return value;
  }
  throw std::logic_error("no value " + name);
}

double FinishedRun::final(const std::string& name) const { return value_of(simulation.result.final, name); }
double FinishedRun::error(const std::string& name) const { return value_of(simulation.result.error_estimate, name); }

double FinishedRun::drift(const std::string& name) const {
  for (const run::Invariant& i : simulation.result.invariants) {
    if (i.name == name) return i.max_relative_drift;
  }
  throw std::logic_error("no invariant " + name);
}

double FinishedRun::parameter(const std::string& name) const {
  const auto& parameters = simulation.derived->model.parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].name == name) return simulation.scene.parameters[i];
  }
  throw std::logic_error("no parameter " + name);
}

std::string model_path(const std::string& name) { return source_folder() + "/models/" + name + ".toml"; }

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

std::shared_ptr<const model::Model> model_at(const std::string& path) {
  return std::make_shared<const model::Model>(model::read_model(path));
}

FinishedRun run_model(const std::string& name, const std::function<void(pipeline::SimulationRequest&)>& adjust) {
  pipeline::SimulationRequest request;
  request.model = model_at(name.ends_with(".toml") ? name : model_path(name));
  Rows rows;
  request.begin = [&rows](const pipeline::DerivedModel&, const run::Scene&, const std::vector<std::string>& names) {
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
