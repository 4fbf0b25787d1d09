// SPDX-License-Identifier: GPL-3.0-or-later
// [[state]] and [discrete]: states of first order, discrete values, and their start values in scenes.
#include "model/read_states.hpp"

#include <fmt/format.h>

namespace eomgen::model {

void StatesReader::declare() {
  for (const Value* table : sections("state")) {
    check_keys(*table,
               {"[[state]]",
                {"name", "rate", "unit", "initial", "energy", "tex"},
                {{"ddt", "d/dt of the state is its 'rate'"}, {"start", "its value at the start is 'initial'"}}});
    State state;
    state.name = text_of_key(*table, "name", "this [[state]]");
    state.span = table->find("name")->span;
    const std::string what = fmt::format("the state '{}'", state.name);
    state.tex = tex_of(*table, what);
    if (const Value* unit = table->find("unit")) state.unit = si_unit(*unit, what);
    add(std::move(state));
  }
}

State& StatesReader::add(State state, const Entry* entry) {
  if (model_.states.size() >= max_coordinates) {
    source_.fail(state.span, fmt::format("the model has more than {} states", max_coordinates),
                 "a model of this size cannot be handled");
  }
  Symbol& symbol = scope_.declare(SymbolKind::state, state.name, state.span, entry);
  symbol.index = static_cast<std::uint32_t>(model_.states.size());
  symbol.state = Symbol::State::resolved;
  model_.states.push_back(std::move(state));
  return model_.states.back();
}

void StatesReader::declare_discrete() {
  const Value* table = section("discrete");
  if (table == nullptr) return;
  for (const Entry& entry : table->entries) {
    State state;
    state.name = entry.key;
    state.span = entry.span;
    state.discrete = true;
    const std::string what = fmt::format("the discrete value '{}'", state.name);
    const Value* initial = &entry.value;
    if (entry.value.is(Value::Kind::table)) {
      check_keys(entry.value, {what, {"initial", "unit", "tex"}, {{"value", "its value at the start is 'initial'"}}});
      initial = entry.value.find("initial");
      state.tex = tex_of(entry.value, what);
      if (const Value* unit = entry.value.find("unit")) state.unit = si_unit(*unit, what);
    }
    if (state.unit.text.empty() && initial != nullptr && initial->is(Value::Kind::text)) {
      if (const std::optional<MeasuredUnit> unit = trailing_unit(initial->text)) state.unit = unit_of(unit->dimension);
    }
    add(std::move(state), &entry);
  }
}

void StatesReader::read() {
  std::size_t index = 0;
  for (const Value* table : sections("state")) {
    const std::size_t k = index++;
    const std::string what = fmt::format("the state '{}'", model_.states[k].name);
    Context rate{fmt::format("the rate of '{}'", model_.states[k].name),
                 static_cast<Dependencies>(on_force_variables & ~on_state_rate), Shape::scalar, std::nullopt,
                 "a rate is made of states, coordinates, velocities, inputs, functions of time, parameters and t; in "
                 "place of ddt() of a state write its rate"};
    if (const auto& unit = model_.states[k].unit.dimension) rate.dimension = quotient(*unit, dimension_of("s"));
    const Value& written = require_value(*table, "rate", what, "add rate = \"expression\": d/dt of the state");
    // Expressions may add states, those of integrals: no reference into the list is held.
    const NodeId of_rate = resolver_.value(written, rate).node;
    model_.states[k].rate = of_rate;
    if (const Value* energy = table->find("energy")) {
      const Context stored{fmt::format("the energy of '{}'", model_.states[k].name),
                           static_cast<Dependencies>(on_motion | on_first_order), Shape::scalar, dimension_of("J"),
                           "the energy that a state stores is made of states, coordinates, functions of time, "
                           "parameters and t"};
      const NodeId of_energy = resolver_.value(*energy, stored).node;
      model_.states[k].energy = of_energy;
    }
    if (const Value* initial = table->find("initial")) {
      const NodeId start = start_value(model_.states[k], *initial);
      model_.states[k].initial = start;
    }
  }
  for (const Symbol* symbol : scope_.all(SymbolKind::state)) {
    if (symbol->entry == nullptr) continue;  // of [[state]]
    const std::uint32_t k = symbol->index;
    model_.states[k].rate = resolver_.number(0, model_.states[k].span).node;
    const Value& declared = symbol->entry->value;
    const Value* initial = declared.is(Value::Kind::table) ? declared.find("initial") : &declared;
    if (initial == nullptr) continue;
    const NodeId start = start_value(model_.states[k], *initial);
    model_.states[k].initial = start;
  }
}

NodeId StatesReader::start_value(const State& state, const Value& value) {
  const Context context{fmt::format("the start value of '{}'", state.name),
                        static_cast<Dependencies>(on_motion | on_velocity), Shape::scalar, state.unit.dimension,
                        "the start value of a state is made of numbers, parameters, functions of time, and coordinates "
                        "and velocities at the start"};
  return resolver_.value(value, context).node;
}

void StatesReader::read_initial(Scene& scene, const Entry& entry, const Symbol& symbol) {
  const State state = model_.states[symbol.index];
  scene.states.push_back({symbol.index, start_value(state, entry.value), entry.span});
}

}  // namespace eomgen::model
