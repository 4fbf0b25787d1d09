// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of a scene: parameters, inputs, the solver, outputs.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <eom/registry.hpp>

#include "model/read_friction.hpp"
#include "model/read_scenes.hpp"

namespace eomgen::model {
namespace {

constexpr std::array<std::string_view, 5> built_in_outputs{"energy", "kinetic", "potential", "power", "all"};

std::vector<std::string> split_at_dots(const std::string& text) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

bool is_axis(const std::string& part, std::string_view name) {
  return part.size() == name.size() + 1 && part.starts_with(name) && part.back() >= '1' && part.back() <= '3';
}

}  // namespace

void ScenesReader::read_scene_parameters(Scene& scene, const std::vector<const Entry*>& entries) {
  for (const Entry* entry : entries) {
    const Symbol* symbol = scope_.find(entry->key);
    if (symbol == nullptr || symbol->kind != SymbolKind::parameter) {
      const std::string hint = did_you_mean(entry->key, scope_.names(SymbolKind::parameter));
      source_.fail(entry->span, fmt::format("{} is not a parameter", quote(entry->key)),
                   hint.empty() ? "the keys of 'parameters' are names of [parameters]" : hint);
    }
    const Parameter& parameter = model_.parameters[symbol->index];
    const Context context{fmt::format("the value of '{}'", entry->key), 0, Shape::scalar, symbol->typed.dimension, ""};
    const TypedNode typed = resolver_.value(entry->value, context);
    if (resolver_.uses_parameters(typed.node)) {
      source_.fail(entry->value.span, fmt::format("the value of '{}' uses parameters", entry->key),
                   "a scene sets parameters to numbers, with units if you like");
    }
    if (parameter.positive && typed.constant && !cln::plusp(*typed.constant)) {
      source_.fail(entry->value.span, fmt::format("the parameter '{}' is declared positive", entry->key),
                   "write a value greater than 0");
    }
    scene.parameters.emplace_back(symbol->index, typed.node);
  }
}

void ScenesReader::read_scene_inputs(Scene& scene, const std::vector<const Entry*>& entries) {
  for (const Entry* entry : entries) {
    const Symbol* symbol = scope_.find(entry->key);
    if (symbol == nullptr || symbol->kind != SymbolKind::input) {
      const std::string hint = did_you_mean(entry->key, scope_.names(SymbolKind::input));
      source_.fail(entry->span, fmt::format("{} is not an input", quote(entry->key)),
                   hint.empty() ? "the keys of 'inputs' are names of [inputs]" : hint);
    }
    SceneInput input;
    input.input = symbol->index;
    input.span = entry->span;
    if (entry->value.is(Value::Kind::table)) {
      input.signal = read_input_table(entry->value, *symbol);
    } else {
      const Context context{fmt::format("the input '{}'", entry->key), on_time, Shape::scalar, symbol->typed.dimension,
                            "a scene gives an input as a function of t and parameters, or as a table; what depends on "
                            "the state is a [[force]], or a "
                            "controller's, which hands u to the emitted code at every step (docs/linking.md)"};
      input.signal = resolver_.value(entry->value, context).node;
    }
    scene.inputs.push_back(std::move(input));
  }
}

void ScenesReader::read_solver(Scene& scene, const Value& value) {
  require_kind(Value::Kind::text, value, "'solver'", "write solver = \"dop853\"");
  if (eom::find_method(value.text) == nullptr) {
    std::vector<std::string> names{eom::Automatic::name};
    for (const eom::MethodInfo& method : eom::methods()) names.emplace_back(method.name);
    const std::string hint = did_you_mean(value.text, names);
    source_.fail(value.span, fmt::format("there is no solver {}", quote(value.text)),
                 hint.empty() ? fmt::format("the solvers are {}", fmt::join(names, ", ")) : hint);
  }
  scene.solver = value.text;
}

void ScenesReader::read_outputs(Scene& scene, const Value& value) {
  require_kind(Value::Kind::array, value, "'outputs'", "write outputs = [\"energy\", \"reaction.NAME\"]");
  for (const Value& item : value.items) {
    require_kind(Value::Kind::text, item, "an output", "write outputs = [\"energy\", \"reaction.NAME\"]");
    check_output(item);
    const bool again = std::any_of(scene.outputs.begin(), scene.outputs.end(),
                                   [&](const OutputReference& known) { return known.name == item.text; });
    if (again) {
      resolver_.warn(item.span, fmt::format("the output '{}' is requested twice", item.text), "name it once");
      continue;
    }
    scene.outputs.push_back(OutputReference{item.text, item.span});
  }
}

/// Whether the name is that of a quantity that some models conserve. Which ones this model conserves is known after the
/// derivation, and the others are refused then.
bool ScenesReader::may_be_conserved(const std::vector<std::string>& parts) const {
  if (parts.size() == 1) return parts[0] == "jacobi";
  if (parts[0] == "linear_momentum" || parts[0] == "angular_momentum") return true;  // along axes, also of bodies
  if (parts.size() != 2) return false;
  if (parts[0] == "energy") return parts[1] == "applied";
  const Symbol* const symbol = scope_.find(parts[1]);
  if (symbol == nullptr) return false;
  return (parts[0] == "momentum" && symbol->kind == SymbolKind::coordinate) ||
         (parts[0] == "integral" && symbol->kind == SymbolKind::constraint);
}

void ScenesReader::check_output(const Value& value) {
  const std::vector<std::string> parts = split_at_dots(value.text);
  if (may_be_conserved(parts)) return;
  if (parts.size() == 1 &&
      std::find(built_in_outputs.begin(), built_in_outputs.end(), value.text) != built_in_outputs.end())
    return;
  if (FrictionReader(context_).is_output(parts)) return;
  if (parts.size() == 2 && is_axis(parts[1], "omega")) {
    const Symbol* turning = scope_.find(parts[0]);
    if (turning != nullptr && turning->frame > 0) return;
  }
  std::vector<std::string> candidates(built_in_outputs.begin(), built_in_outputs.end());
  const Symbol* symbol = scope_.find(parts.size() == 1 ? std::string(split_derivative(value.text).base) : parts[0]);
  if (parts.size() == 1 && symbol != nullptr) {
    const std::uint8_t order = split_derivative(value.text).order;
    if (symbol->kind == SymbolKind::coordinate) return;
    if (symbol->kind == SymbolKind::state && order == 0) return;
    if (symbol->kind == SymbolKind::definition && order == 0) {
      if (!model_.definitions[symbol->index].vector) return;
      source_.fail(value.span, fmt::format("the definition '{}' is a vector, and an output is a scalar", value.text),
                   "define its components, such as dot(a, E1)");
    }
  }
  if (parts.size() == 2 && symbol != nullptr && symbol->kind == SymbolKind::place &&
      (is_axis(parts[1], "position") || is_axis(parts[1], "velocity")))
    return;
  if (parts[0] == "reaction" && (parts.size() == 2 || parts.size() == 3)) {
    const Symbol* constraint = scope_.find(parts[1]);
    if (constraint != nullptr && constraint->kind == SymbolKind::constraint) {
      const std::size_t count = model_.constraints[constraint->index].reaction_count();
      if (parts.size() == 2) return;
      if (count > 1 && parts[2].size() == 1 && parts[2][0] >= '1' &&
          static_cast<std::size_t>(parts[2][0] - '0') <= count)
        return;
      source_.fail(value.span,
                   model_.constraints[constraint->index].joint
                       ? fmt::format("the joint '{}' has no reaction {}", parts[1], quote(parts[2]))
                       : fmt::format("the constraint '{}' has {} equation{}", parts[1], count, count == 1 ? "" : "s"),
                   count == 1
                       ? fmt::format("write reaction.{}", parts[1])
                       : fmt::format("write reaction.{0} or reaction.{0}.1 to reaction.{0}.{1}", parts[1], count));
    }
  }
  for (const std::string& name : scope_.names(SymbolKind::constraint)) candidates.push_back("reaction." + name);
  for (const SymbolKind kind : {SymbolKind::definition, SymbolKind::coordinate, SymbolKind::state}) {
    for (const std::string& name : scope_.names(kind)) candidates.push_back(name);
  }
  for (const std::string& name : scope_.names(SymbolKind::place))
    candidates.insert(candidates.end(), {name + ".position1", name + ".velocity1"});
  const std::string hint = did_you_mean(value.text, candidates);
  source_.fail(value.span, fmt::format("there is no output {}", quote(value.text)),
               hint.empty() ? "outputs are energy, kinetic, potential, power, P.position1, P.velocity1, reaction.NAME, "
                              "scalar definitions, coordinates, states, all"
                            : hint);
}

}  // namespace eomgen::model
