// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/output_slopes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "run/requested_outputs.hpp"

namespace eomgen::analysis {
namespace {

using linear::Matrix;
using linear::Precise;
using symbolic::Symbol;
using symbolic::SymbolKind;

/// The symbols on which an output may depend: z, t, the inputs, then the accelerations and the forces of constraints
/// and contacts, which are functions of the others.
struct Directions {
  std::vector<Symbol> symbols;
  std::size_t state = 0;   // count of z with t
  std::size_t inputs = 0;  // count
  std::vector<Symbol> forces;
};

Directions directions_of(const SteadyProblem& p) {
  Directions result;
  result.symbols = p.flow->symbols();
  result.symbols.push_back({SymbolKind::time, 0, 0});
  result.state = result.symbols.size();
  result.inputs = p.flow->inputs();
  for (std::uint32_t i = 0; i < result.inputs; ++i) result.symbols.push_back({SymbolKind::input, i, 0});
  for (const std::uint32_t i : p.system().free) result.symbols.push_back({SymbolKind::coordinate, i, 2});
  result.forces = p.flow->forces();
  result.symbols.insert(result.symbols.end(), result.forces.begin(), result.forces.end());
  return result;
}

std::size_t place_of(const std::vector<std::uint32_t>& list, std::uint32_t index) {
  return static_cast<std::size_t>(std::find(list.begin(), list.end(), index) - list.begin());
}

/// Whether the output depends on the state, t, inputs and parameters alone.
bool is_known(const SteadyProblem& p, const system::Output& output, const Directions& directions) {
  const std::vector<Symbol> symbols = p.derived->mechanics.dag->symbols({output.value});
  return std::all_of(symbols.begin(), symbols.end(), [&](const Symbol& symbol) {
    return symbol.kind == SymbolKind::parameter || symbol.kind == SymbolKind::integral ||
           symbol.kind == SymbolKind::state ||
           std::find(directions.symbols.begin(), directions.symbols.end(), symbol) != directions.symbols.end();
  });
}

/// The slopes of outputs about one state.
class Slopes {
 public:
  Slopes(const SteadyProblem& p, const linear::Linearisation& at)
      : p_(p),
        at_(at),
        directions_(directions_of(p)),
        n_(p.flow->coordinates()),
        of_state_(p.flow->lookup(at.z, at.setting)) {}

  std::size_t inputs() const { return directions_.inputs; }
  std::size_t columns() const { return at_.symmetry.chart.independent.size(); }

  struct Row {
    Precise value;
    std::vector<Precise> by_state, by_input;
  };

  /// Throws std::domain_error if the output has no slope.
  Row operator()(const system::Output& output) const {
    if (!is_known(p_, output, directions_)) throw std::domain_error("it depends on quantities that only a run has");
    const linear::ValueAndJacobian<Precise> partial =
        linear::Tape(*p_.derived->mechanics.dag, {output.value}, directions_.symbols)
            .at<Precise>([this](const Symbol& symbol) { return value_of(symbol); });
    require_determined(partial.jacobian);
    Row row{partial.value[0], std::vector<Precise>(columns()), {}};
    for (std::size_t d = 0; d < directions_.state; ++d) {
      const Precise slope = total(partial.jacobian, d, at_.field.jacobian, d);
      for (std::size_t j = 0; j < columns(); ++j) row.by_state[j] = row.by_state[j] + slope * at_.tangent(d, j);
    }
    for (std::size_t u = 0; u < inputs(); ++u)
      row.by_input.push_back(total(partial.jacobian, directions_.state + u, at_.field.input_jacobian, u));
    require_finite({row.value});
    require_finite(row.by_state);
    require_finite(row.by_input);
    return row;
  }

 private:
  static void require_finite(const std::vector<Precise>& numbers) {
    for (const Precise& x : numbers) {
      if (!std::isfinite(linear::to_double(x)))
        throw std::domain_error("its value or a slope is above the range of binary64");
    }
  }
  /// Throws std::domain_error if the output depends on forces that the motion leaves undetermined.
  void require_determined(const Matrix<Precise>& partial) const {
    const Matrix<Precise>& open = at_.field.undetermined;
    const std::size_t forces = directions_.state + directions_.inputs + n_;
    for (std::size_t k = 0; k < open.cols; ++k) {
      Precise sum(0);
      for (std::size_t m = 0; m < open.rows; ++m) sum = sum + partial(0, forces + m) * open(m, k);
      if (linear::magnitude(sum) > linear::tiny<Precise>(40))
        throw std::domain_error("the motion does not determine this force");
    }
  }
  Precise value_of(const Symbol& symbol) const {
    const system::EquationSystem& system = p_.system();
    const auto force = std::find(directions_.forces.begin(), directions_.forces.end(), symbol);
    if (force != directions_.forces.end())
      return at_.field.forces(static_cast<std::size_t>(force - directions_.forces.begin()), 0);
    if (symbol.kind == SymbolKind::coordinate && symbol.order == 2)
      return at_.field.X(n_ + place_of(system.free, symbol.index), 0);
    return of_state_(symbol);
  }

  /// The total derivative by an entry of z, or by an input: accelerations and multipliers are functions of them.
  Precise total(const Matrix<Precise>& partial, std::size_t direction, const Matrix<Precise>& rates,
                std::size_t column) const {
    const std::size_t accelerations = directions_.state + directions_.inputs, forces = accelerations + n_;
    Precise sum = partial(0, direction);
    for (std::size_t i = 0; i < n_; ++i) sum = sum + partial(0, accelerations + i) * rates(n_ + i, column);
    for (std::size_t m = 0; m < directions_.forces.size(); ++m)
      sum = sum + partial(0, forces + m) * at_.field.force_jacobian(m, direction);
    return sum;
  }

  const SteadyProblem& p_;
  const linear::Linearisation& at_;
  Directions directions_;
  std::size_t n_;
  std::function<Precise(const Symbol&)> of_state_;
};

}  // namespace

OutputSlopes linearise_outputs(const SteadyProblem& p, const linear::Linearisation& at,
                               const std::vector<std::string>& names) {
  OutputSlopes result;
  const Slopes slopes(p, at);
  std::vector<Slopes::Row> rows;
  const std::vector<std::string> chosen =
      names.empty() ? p.scene.outputs : run::requested_outputs(p.derived->mechanics, p.system(), names);
  for (const std::string& name : chosen) {
    try {
      rows.push_back(slopes(*system::find(p.system().outputs, name)));
      result.names.push_back(name);
    } catch (const std::domain_error& error) {
      if (names.empty()) {
        result.left_out.push_back({name, error.what()});
        continue;
      }
      const model::Model& model = p.derived->model;
      throw Error("linearize", model.where(model.scene(p.scene.name).span),
                  fmt::format("the output '{}' has no slope at this state: {}", name, error.what()),
                  "linearise at another state, or choose other outputs: --output NAMES");
    }
  }
  result.C = Matrix<Precise>(rows.size(), slopes.columns());
  result.D = Matrix<Precise>(rows.size(), slopes.inputs());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    result.values.push_back(rows[k].value);
    for (std::size_t j = 0; j < slopes.columns(); ++j) result.C(k, j) = rows[k].by_state[j];
    for (std::size_t u = 0; u < slopes.inputs(); ++u) result.D(k, u) = rows[k].by_input[u];
  }
  return result;
}

}  // namespace eomgen::analysis
