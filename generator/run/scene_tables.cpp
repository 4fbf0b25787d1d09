// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/scene_tables.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "run/monitored_functions.hpp"
#include "run/time_functions.hpp"
#include "system/expressions.hpp"

namespace eomgen::run {
namespace {

/// All expressions, which identify the equations.
std::vector<Ref> expressions_of(const system::EquationSystem& system) {
  std::vector<Ref> all;
  system::for_each_expression(system, [&all](Ref r, system::ExpressionRole) { all.push_back(r); });
  return all;
}

SceneTable make_tables(const system::EquationSystem& system, const std::vector<std::optional<Ref>>& inputs) {
  std::vector<Ref> roots = system.M;
  roots.insert(roots.end(), system.A.begin(), system.A.end());
  const std::size_t run = 1 + system.layout().size() + inputs.size();
  const SymbolResolver variables = [of_run = run_variables(system), run](const symbolic::Symbol& symbol) {
    if (symbol.kind == symbolic::SymbolKind::parameter) return SymbolMeaning::of_variable(run + symbol.index);
    const SymbolMeaning meaning = of_run(symbol);
    // An entry with a symbol that the start does not have is not a number, and the others are.
    return meaning.kind == SymbolMeaning::Kind::unknown ? SymbolMeaning::of(std::nan("")) : meaning;
  };
  std::optional<Table> mass_and_rows = make_table(*system.dag, roots, variables);
  if (!mass_and_rows) throw std::logic_error("the table of the mass matrix has a symbol without a meaning");
  return {time_functions(system, inputs), jump_functions(system),
          eom::expressions::Code(std::move(*mass_and_rows), {})};
}

}  // namespace

const SceneTable& SceneTables::of(const system::EquationSystem& system, const model::Scene& scene,
                                  const std::vector<std::optional<Ref>>& inputs, bool is_scenes_own) {
  std::vector<Ref> expressions = expressions_of(system);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return is_scenes_own && entry.scene == &scene && entry.expressions == expressions;
  });
  if (found == entries_.end()) {
    entries_.push_front({is_scenes_own ? &scene : nullptr, std::move(expressions), make_tables(system, inputs)});
    if (entries_.size() > most) entries_.pop_back();
  } else {
    entries_.splice(entries_.begin(), entries_, found);
  }
  return entries_.front().table;
}

}  // namespace eomgen::run
