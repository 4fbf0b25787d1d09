// SPDX-License-Identifier: GPL-3.0-or-later
// [parameters], [functions], [inputs], [coordinates], [definitions].
#include "model/read_names.hpp"

#include <fmt/format.h>

#include "model/read_bodies.hpp"
#include "model/read_places.hpp"

namespace eomgen::model {
namespace {

// The unit of a value: as written if that is SI, otherwise canonical.
Unit stated_or(const std::optional<MeasuredUnit>& stated, const std::optional<Dimension>& dimension) {
  if (stated && stated->scale == 1 && stated->pi_power == 0) return Unit{stated->text, stated->dimension};
  return unit_of(dimension);
}

// The unit as the user wrote it, as in "9.81 m/s^2".
std::optional<MeasuredUnit> unit_in(const Value& value) {
  return value.is(Value::Kind::text) ? trailing_unit(value.text) : std::nullopt;
}

}  // namespace

void NamesReader::declare() {
  const auto declare = [&](std::string_view section_name, SymbolKind kind) {
    const Value* table = section(section_name);
    if (table == nullptr) return;
    for (const Entry& entry : table->entries) scope_.declare(kind, entry.key, entry.span, &entry);
  };
  declare("parameters", SymbolKind::parameter);
  declare("functions", SymbolKind::function);
  declare("inputs", SymbolKind::input);
  declare("definitions", SymbolKind::definition);
  if (const Value* table = section("coordinates")) {
    for (const Entry& entry : table->entries) declare_coordinate(entry.key, entry.span, &entry);
    for (const Entry& entry : table->entries) read_coordinate(entry);
  }
}

std::uint32_t NamesReader::declare_coordinate(const std::string& name, Span span, const Entry* entry) {
  Symbol& symbol = scope_.declare(SymbolKind::coordinate, name, span, entry);
  if (model_.coordinates.size() >= max_coordinates) {
    source_.fail(span, fmt::format("the model has more than {} coordinates", max_coordinates),
                 "a model of this size cannot be handled");
  }
  symbol.index = static_cast<std::uint32_t>(model_.coordinates.size());
  symbol.state = Symbol::State::resolved;
  Coordinate coordinate;
  coordinate.name = name;
  coordinate.span = span;
  model_.coordinates.push_back(std::move(coordinate));
  return symbol.index;
}

void NamesReader::read_coordinate(const Entry& entry) {
  const std::uint32_t index = scope_.find(entry.key)->index;
  Coordinate& coordinate = model_.coordinates[index];
  const std::string what = fmt::format("'{}'", entry.key);
  const Value* unit = nullptr;
  if (entry.value.is(Value::Kind::text)) {
    unit = &entry.value;
  } else {
    require_kind(Value::Kind::table, entry.value, fmt::format("the coordinate {}", what),
                 "write x = \"m\", x = {} or x = { unit = \"m\" }");
    check_keys(entry.value, {fmt::format("the coordinate {}", what), {"unit", "tex", "range", "armature"}});
    unit = entry.value.find("unit");
    coordinate.tex = tex_of(entry.value, what);
    coordinate.is_along_rim = entry.value.generated;
    if (entry.value.find("range") != nullptr) coordinates_with_range_.insert(index);
  }
  if (unit == nullptr) return;
  coordinate.unit = si_unit(*unit, what);
  coordinates_with_unit_.insert(index);
}

// Called once all names are known: the ends of a range may be expressions of parameters.
void NamesReader::read_ranges() {
  const Value* table = section("coordinates");
  if (table == nullptr) return;
  for (const Entry& entry : table->entries) {
    const Value* range = entry.value.find("range");
    if (range == nullptr) continue;
    Coordinate& coordinate = model_.coordinates[scope_.find(entry.key)->index];
    require_kind(Value::Kind::array, *range, fmt::format("the range of '{}'", entry.key),
                 "write range = [0, \"pi\"]; inf means no bound");
    if (range->items.size() != 2)
      source_.fail(range->span, "a range has two ends", "write range = [0, \"pi\"]; inf means no bound");
    const Context context{fmt::format("the range of '{}'", entry.key), 0, Shape::scalar, coordinate.unit.dimension, ""};
    std::array<std::optional<Rational>, 2> ends;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string& text = range->items[k].text;
      const bool unbounded = text == "inf" || text == "+inf" || text == "-inf";
      if (unbounded && (text[0] == '-') == (k == 0)) continue;
      const TypedNode end = resolver_.value(range->items[k], context);
      ends[k] = end.constant;
      (k == 0 ? coordinate.lower : coordinate.upper) = end.node;
    }
    if (ends[0] && ends[1] && *ends[0] >= *ends[1]) {
      source_.fail(range->span, "the range is empty", "write the smaller end first: range = [a, b] with a < b");
    }
  }
}

// A rotor of inertia J behind a gear of ratio n has the kinetic energy a q_dot^2/2 with the armature a = n^2 J.
std::optional<TypedNode> NamesReader::armature_energy() {
  std::optional<TypedNode> total;
  const Value* table = section("coordinates");
  if (table == nullptr) return total;
  for (const Entry& entry : table->entries) {
    const Value* armature = entry.value.find("armature");
    if (armature == nullptr) continue;
    const Span span = armature->span;
    const std::uint32_t index = scope_.find(entry.key)->index;
    Context context{fmt::format("the armature of '{}'", entry.key), 0, Shape::scalar, std::nullopt,
                    "an armature is made of numbers and parameters, such as \"n^2*J\""};
    const Unit& unit = model_.coordinates[index].unit;
    if (unit.dimension) context.dimension = quotient(dimension_of("kg*m^2"), raised(*unit.dimension, 2));
    const TypedNode value = resolver_.value(*armature, context);
    if (value.constant && cln::minusp(*value.constant))
      resolver_.refuse_value(value, span, context.what, "is negative",
                             "write the inertia of the rotor times the square of its gear ratio");
    const TypedNode rate = resolver_.coordinate(index, 1, span);
    const TypedNode half = resolver_.product_of(resolver_.number(Rational(1) / 2, span), value, span);
    TypedNode energy = resolver_.product_of(half, resolver_.product_of(rate, rate, span), span);
    energy.dimension = dimension_of("J");  // a bare number has its unit
    energy.has_uncertain_dimension = false;
    total = total ? resolver_.sum_of(*total, energy, span) : energy;
  }
  return total;
}

TypedNode NamesReader::define(Symbol& symbol) {
  switch (symbol.kind) {
    case SymbolKind::parameter: return define_parameter(symbol);
    case SymbolKind::function: return define_function(symbol);
    case SymbolKind::input: return define_input(symbol);
    case SymbolKind::definition: return define_definition(symbol);
    case SymbolKind::place: return PlacesReader(context_).define_place(symbol);
    case SymbolKind::frame: return BodiesReader(context_).define_axes(symbol);
    default: return TypedNode{};
  }
}

TypedNode NamesReader::define_parameter(Symbol& symbol) {
  const Value& declared = symbol.entry->value;
  const std::string what = fmt::format("the parameter '{}'", symbol.name);
  const Context context{what, 0, Shape::scalar, std::nullopt, ""};
  Parameter parameter;
  parameter.name = symbol.name;
  parameter.span = symbol.span;
  const Value* value = &declared;
  std::optional<MeasuredUnit> stated;
  if (declared.is(Value::Kind::table)) {
    check_keys(declared, {what, {"value", "unit", "tex", "note", "positive"}});
    value = &require_value(declared, "value", what, "add value = ...");
    parameter.tex = tex_of(declared, what);
    if (declared.find("note") != nullptr) parameter.note = text_of_key(declared, "note", what);
    if (const Value* positive = declared.find("positive")) {
      parameter.positive = require_kind(Value::Kind::boolean, *positive, "positive", "write true or false").boolean;
    }
    if (const Value* unit = declared.find("unit")) stated = any_unit(*unit, what);
  }
  TypedNode typed = resolver_.value(*value, context);
  if (stated) typed = resolver_.with_unit(typed, *stated, declared.find("unit")->span);
  if (parameter.positive && typed.constant && !cln::plusp(*typed.constant)) {
    source_.fail(value->span, fmt::format("{} is declared positive and is not", what),
                 "correct the value, or leave positive out");
  }
  parameter.value = typed.node;
  parameter.written = value->text;
  parameter.unit = stated_or(stated ? stated : unit_in(*value), typed.dimension);
  symbol.index = static_cast<std::uint32_t>(model_.parameters.size());
  model_.parameters.push_back(std::move(parameter));
  return typed;
}

TypedNode NamesReader::define_function(Symbol& symbol) {
  const Value& declared = symbol.entry->value;
  const std::string what = fmt::format("the function '{}'", symbol.name);
  Function function;
  function.name = symbol.name;
  function.span = symbol.span;
  const Value* is = &declared;
  Context context{what, on_time, Shape::scalar, std::nullopt, ""};
  if (declared.is(Value::Kind::table)) {
    check_keys(declared, {what, {"is", "unit", "tex"}});
    is = &require_value(declared, "is", what, "add is = \"expression of t\"");
    function.tex = tex_of(declared, what);
    if (const Value* unit = declared.find("unit")) function.unit = si_unit(*unit, what);
    context.dimension = function.unit.dimension;
  }
  TypedNode typed = resolver_.value(*is, context);
  if (context.dimension) {
    typed.dimension = context.dimension;
    typed.has_uncertain_dimension = false;
  } else {
    function.unit = stated_or(unit_in(*is), typed.dimension);
  }
  typed.literal = false;
  typed.constant.reset();
  function.expression = typed.node;
  symbol.index = static_cast<std::uint32_t>(model_.functions.size());
  model_.functions.push_back(std::move(function));
  return typed;
}

TypedNode NamesReader::define_input(Symbol& symbol) {
  const Value& declared = symbol.entry->value;
  const std::string what = fmt::format("the input '{}'", symbol.name);
  require_kind(Value::Kind::table, declared, what,
               fmt::format("write {} = {{ unit = \"N\", default = 0 }}", symbol.name));
  check_keys(declared, {what, {"unit", "default", "tex"}});
  Input input;
  input.name = symbol.name;
  input.span = symbol.span;
  input.tex = tex_of(declared, what);
  TypedNode result;
  if (const Value* unit = declared.find("unit")) input.unit = si_unit(*unit, what);
  result.dimension = input.unit.dimension;
  if (const Value* fallback = declared.find("default")) {
    const Context context{fmt::format("the default of '{}'", symbol.name), on_time, Shape::scalar, input.unit.dimension,
                          ""};
    input.default_value = resolver_.value(*fallback, context).node;
  } else {
    input.default_value = resolver_.number(0, declared.span).node;
  }
  result.dependencies = on_input;
  symbol.index = static_cast<std::uint32_t>(model_.inputs.size());
  model_.inputs.push_back(std::move(input));
  return result;
}

TypedNode NamesReader::define_definition(Symbol& symbol) {
  const Context context{fmt::format("the definition '{}'", symbol.name), on_anything, Shape::either, std::nullopt, ""};
  TypedNode typed = resolver_.value(symbol.entry->value, context);
  typed.literal = false;
  Definition definition;
  definition.name = symbol.name;
  definition.expression = typed.node;
  definition.vector = typed.vector;
  definition.unit = unit_of(typed.dimension);
  definition.span = symbol.span;
  symbol.index = static_cast<std::uint32_t>(model_.definitions.size());
  model_.definitions.push_back(std::move(definition));
  return typed;
}

void NamesReader::warn_misspelt(const std::string& name, Span span) {
  for (const std::string& known : scope_.names()) {
    if (known == name || !looks_misspelt(name, known)) continue;
    resolver_.warn(span, fmt::format("'{}' declares a new coordinate; it is one letter away from '{}'", name, known),
                   fmt::format("if '{}' was meant, correct it; if not, declare '{}' in [coordinates]", known, name));
    return;
  }
}

void NamesReader::warn_unused() {
  for (Parameter& parameter : model_.parameters) {
    if (parameter.initial_value_of) continue;  // initial(q)
    parameter.used = scope_.find(parameter.name)->used;
    if (parameter.used) continue;
    resolver_.warn(parameter.span, fmt::format("the parameter '{}' is not used", parameter.name),
                   "use it or take it out");
  }
  for (const SymbolKind kind : {SymbolKind::function, SymbolKind::input}) {
    for (const Symbol* symbol : scope_.all(kind)) {
      if (symbol->used) continue;
      resolver_.warn(
          symbol->span,
          fmt::format("{} '{}' is not used", kind == SymbolKind::input ? "the input" : "the function", symbol->name),
          "use it or take it out");
    }
  }
}

}  // namespace eomgen::model
