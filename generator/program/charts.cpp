// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/charts.hpp"

#include <algorithm>

#include "error.hpp"
#include "program/from_dag.hpp"

namespace eomgen::program {
namespace {

/// y is the whole state with the angles and their rates changed.
Function exchange(const symbolic::Dag& dag, const std::string& name, const Program& program,
                  const system::ChartChange& change, const std::vector<Ref>& formulas) {
  // Symbols that occur in a formula exist in the graph; the others are created in a copy.
  symbolic::Dag graph = dag;
  FunctionExpressions wanted{name, {{"y", {}}}, {}, {}};
  for (std::uint8_t order = 0; order < 2; ++order) {
    for (const std::uint32_t q : program.free) {
      const auto angle = std::find(change.angles.begin(), change.angles.end(), q);
      const std::size_t place = static_cast<std::size_t>(angle - change.angles.begin()) + order * change.angles.size();
      wanted.results[0].entries.push_back(
          angle == change.angles.end() ? graph.symbol({symbolic::SymbolKind::coordinate, q, order}) : formulas[place]);
    }
  }
  for (const symbolic::Symbol& state : program.states) wanted.results[0].entries.push_back(graph.symbol(state));
  const PolynomialGraph result = flatten(from_dag(graph, wanted, program.free, program.states), false);
  return schedule(result, wanted.name, {{"y", wanted.results[0].entries.size()}});
}

}  // namespace

namespace {

/// Adds rows of zeros to matrices with a row for each of the outputs `places`, which then have one for every output.
void spread_rows(Function& function, const std::vector<std::uint32_t>& places, std::size_t outputs) {
  if (places.size() == outputs || places.empty()) return;
  const auto found = std::find(function.constants.begin(), function.constants.end(), symbolic::Rational(0));
  const auto zero = static_cast<std::uint32_t>(found - function.constants.begin());
  if (found == function.constants.end()) function.constants.emplace_back(0);
  for (Result& result : function.results) {
    if (result.is_test()) continue;
    const std::size_t columns = result.entries.size() / places.size();
    std::vector<Operand> entries(columns * outputs, Operand{Slot::constant, zero, false});
    for (std::size_t j = 0; j < columns; ++j)
      for (std::size_t i = 0; i < places.size(); ++i)
        entries[places[i] + outputs * j] = result.entries[i + places.size() * j];
    result.entries = std::move(entries);
  }
}

}  // namespace

std::vector<std::uint32_t> chart_independent_outputs(const std::vector<std::string>& outputs,
                                                     const std::vector<system::Output>& own,
                                                     const std::vector<system::Output>& second,
                                                     const std::vector<std::uint32_t>& exchanged) {
  std::vector<std::uint32_t> result;
  for (std::uint32_t i = 0; i < outputs.size(); ++i) {
    const system::Output* output = system::find(own, outputs[i]);
    const bool other_meaning =
        output != nullptr &&
        (output->kind == system::OutputKind::acceleration || output->kind == system::OutputKind::momentum) &&
        std::find(exchanged.begin(), exchanged.end(), output->index) != exchanged.end();
    if (!other_meaning && system::find(second, outputs[i]) != nullptr) result.push_back(i);
  }
  return result;
}

void add_charts(Program& program, const symbolic::Dag& dag, const std::vector<system::ChartChange>& changes) {
  for (const system::ChartChange& change : changes) {
    ChartInfo info{change.of, change.own, change.second, change.singularity, {}, 0, change.second_at_sine, {}, {}};
    for (const std::uint32_t angle : change.angles) {
      const auto found = std::find(program.free.begin(), program.free.end(), angle);
      if (found == program.free.end()) throw std::logic_error("an angle that can be exchanged is not free");
      info.angles.push_back(static_cast<std::uint32_t>(found - program.free.begin()));
    }
    info.guarded = info.angles.at(change.guarded);
    info.to = exchange(dag, "to_second", program, change, change.to_second);
    info.back = exchange(dag, "to_own", program, change, change.to_own);
    program.charts.push_back(std::move(info));
  }
}

void add_chart_variant(Program& program, Program second, unsigned charts, const std::vector<std::uint32_t>& places) {
  const bool fits = second.free == program.free && second.states == program.states &&
                    second.holonomic == program.holonomic && second.active_constraints == program.active_constraints &&
                    second.reactions == program.reactions && second.kinks.size() == program.kinks.size() &&
                    second.event_count() == program.event_count();
  if (!fits) {
    throw Error(
        "program", {}, "the coordinates, constraints or kinks of this model differ in its second charts",
        "this is a defect of eomgen: please report it with the model; --no-charts leaves the second charts out");
  }
  second.in_charts = charts;
  for (Function& function : second.functions) {
    if (function.name == "outputs") function.result_indices = places;
    if (function.name.starts_with("outputs_jac")) spread_rows(function, places, program.outputs.size());
  }
  program.chart_variants.push_back(std::move(second));
}

}  // namespace eomgen::program
