// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/output_slopes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace eomgen::analysis {
namespace {

using linear::Matrix;
using linear::Precise;
using symbolic::Symbol;
using symbolic::SymbolKind;

/// The symbols on which an output may depend: z, t, the inputs, then the accelerations and multipliers, which are
/// functions of the others.
struct Directions {
  std::vector<Symbol> symbols;
  std::size_t state = 0;   // count of z with t
  std::size_t inputs = 0;  // count
};

Directions directions_of(const SteadyProblem& p) {
  Directions result;
  result.symbols = p.flow->symbols();
  result.symbols.push_back({SymbolKind::time, 0, 0});
  result.state = result.symbols.size();
  result.inputs = p.flow->inputs();
  for (std::uint32_t i = 0; i < result.inputs; ++i) result.symbols.push_back({SymbolKind::input, i, 0});
  for (const std::uint32_t i : p.system().free) result.symbols.push_back({SymbolKind::coordinate, i, 2});
  for (const std::uint32_t k : p.system().active) result.symbols.push_back({SymbolKind::multiplier, k, 0});
  return result;
}

std::size_t place_of(const std::vector<std::uint32_t>& list, std::uint32_t index) {
  return static_cast<std::size_t>(std::find(list.begin(), list.end(), index) - list.begin());
}

Error refusal(const SteadyProblem& p, const std::string& message, const std::string& remedy) {
  const model::Model& model = p.derived->model;
  return Error("linearize", model.where(model.scene(p.scene.name).span), message, remedy);
}

/// Throws Error if the output depends on something that a linearisation has not.
void require_known(const SteadyProblem& p, const system::Output& output, const Directions& directions) {
  for (const Symbol& symbol : p.derived->mechanics.dag->symbols({output.value})) {
    const bool constant = symbol.kind == SymbolKind::parameter || symbol.kind == SymbolKind::integral;
    const bool is_state = symbol.kind == SymbolKind::state;
    if (constant || is_state ||
        std::find(directions.symbols.begin(), directions.symbols.end(), symbol) != directions.symbols.end())
      continue;
    throw refusal(p, fmt::format("the output '{}' depends on quantities that only a run has", output.name),
                  "choose other outputs: --output NAMES");
  }
}

std::vector<std::string> chosen_names(const SteadyProblem& p, const std::vector<std::string>& names) {
  if (names.empty()) return p.scene.outputs;
  std::vector<model::OutputReference> wanted;
  for (const std::string& name : names) wanted.push_back({name, {}});
  return run::expand_outputs(p.derived->mechanics, p.system(), wanted);
}

}  // namespace

OutputSlopes linearise_outputs(const SteadyProblem& p, const linear::Linearisation& at,
                               const std::vector<std::string>& names) {
  OutputSlopes result;
  result.names = chosen_names(p, names);
  const Directions directions = directions_of(p);
  const system::EquationSystem& system = p.system();
  const linear::Field<Precise>& field = at.field;
  const std::size_t n = p.flow->coordinates(), columns = at.symmetry.chart.independent.size();
  const std::size_t accelerations = directions.state + directions.inputs, multipliers = accelerations + n;
  result.C = Matrix<Precise>(result.names.size(), columns);
  result.D = Matrix<Precise>(result.names.size(), directions.inputs);
  const auto of_state = p.flow->lookup(at.z, at.setting);
  const std::function<Precise(const Symbol&)> lookup = [&](const Symbol& symbol) {
    if (symbol.kind == SymbolKind::multiplier) return field.multipliers(place_of(system.active, symbol.index), 0);
    if (symbol.kind == SymbolKind::coordinate && symbol.order == 2)
      return field.X(n + place_of(system.free, symbol.index), 0);
    return of_state(symbol);
  };
  for (std::size_t k = 0; k < result.names.size(); ++k) {
    const system::Output* const output = system::find(system.outputs, result.names[k]);
    require_known(p, *output, directions);
    try {
      const linear::ValueAndJacobian<Precise> partial =
          linear::Tape(*p.derived->mechanics.dag, {output->value}, directions.symbols).at<Precise>(lookup);
      result.values.push_back(partial.value[0]);
      const auto by = [&](std::size_t direction) { return partial.jacobian(0, direction); };
      // The total derivative by an entry of z, or by an input.
      const auto total = [&](std::size_t direction, const Matrix<Precise>& rates, std::size_t column) {
        Precise sum = by(direction);
        for (std::size_t i = 0; i < n; ++i) sum = sum + by(accelerations + i) * rates(n + i, column);
        for (std::size_t m = 0; m < system.active.size(); ++m)
          sum = sum + by(multipliers + m) * field.multiplier_jacobian(m, direction);
        return sum;
      };
      for (std::size_t d = 0; d < directions.state; ++d) {
        const Precise slope = total(d, field.jacobian, d);
        for (std::size_t j = 0; j < columns; ++j) result.C(k, j) = result.C(k, j) + slope * at.tangent(d, j);
      }
      for (std::size_t u = 0; u < directions.inputs; ++u)
        result.D(k, u) = total(directions.state + u, field.input_jacobian, u);
    } catch (const std::domain_error& error) {
      throw refusal(p, fmt::format("the output '{}' has no slope at this state: {}", output->name, error.what()),
                    "linearise at another state, or choose other outputs: --output NAMES");
    }
  }
  return result;
}

}  // namespace eomgen::analysis
