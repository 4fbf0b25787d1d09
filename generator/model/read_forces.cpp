// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/read_forces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/read_friction.hpp"

namespace eomgen::model {
namespace {

std::vector<std::string_view> kinds() {
  std::vector<std::string_view> names;
  for (const forces::Kind& kind : forces::registry()) names.push_back(kind.name);
  return names;
}

/// Keys next to the value of a kind, such as on = "P".
std::vector<std::string_view> beside() {
  std::vector<std::string_view> keys;
  for (const forces::Kind& kind : forces::registry()) {
    if (kind.form != forces::InputFormat::value) continue;
    for (std::size_t k = 1; k < kind.keys.size(); ++k) {
      if (std::find(keys.begin(), keys.end(), kind.keys[k].name) == keys.end()) keys.push_back(kind.keys[k].name);
    }
  }
  return keys;
}

bool has_key(const forces::Kind& kind, std::string_view name) {
  return std::any_of(kind.keys.begin(), kind.keys.end(), [&](const forces::Key& key) { return key.name == name; });
}

/// The default remedy for a missing key, if the description of its kind has none.
std::string remedy_for(const forces::Key& key) {
  switch (key.type) {
    case forces::ValueType::ends: return "write between = [\"P\", \"Q\"] with particles, points, \"origin\" or vectors";
    case forces::ValueType::triple: return fmt::format("add {} = [\"..\", \"..\", \"..\"], along three axes", key.name);
    case forces::ValueType::bodies:
      return fmt::format("add {} = [\"A\", \"B\"]; one of them may be \"ground\"", key.name);
    case forces::ValueType::points: return fmt::format("add {} = [\"point of A\", \"point of B\"]", key.name);
    case forces::ValueType::vector: return fmt::format("add {} = \"<vector>\"", key.name);
    default: return fmt::format("add {} = \"..\"", key.name);
  }
}

}  // namespace

void ForcesReader::declare() {
  std::size_t number = 0;
  for (const Value* table : sections("force")) {
    Force force;
    force.span = table->span;
    force.name = fmt::format("force {}", ++number);
    if (table->find("name") != nullptr) {
      force.name = text_of_key(*table, "name", "this [[force]]");
      Symbol& symbol = scope_.declare(SymbolKind::force, force.name, table->find("name")->span);
      symbol.index = static_cast<std::uint32_t>(model_.forces.size());
    }
    model_.forces.push_back(std::move(force));
  }
}

void ForcesReader::read() {
  std::size_t index = 0;
  for (const Value* table : sections("force")) read_force(model_.forces[index++], *table);
  warn_of_repeated_weight();
}

// A weight in [energy] potential acts once more by gravity.
void ForcesReader::warn_of_repeated_weight() const {
  if (model_.energy.potential == no_node || (model_.particles.empty() && model_.bodies.empty())) return;
  const Resolver::Constants of_potential = resolver_.constants_in(model_.energy.potential);
  const auto common = [](const auto& constants, const auto& others) {
    return std::find_if(constants.begin(), constants.end(), [&](const auto& c) { return others.contains(c); });
  };
  for (const Force& force : model_.forces) {
    if (force.acceleration() == no_node) continue;
    const Resolver::Constants of_gravity = resolver_.constants_in(force.acceleration());
    const auto parameter = common(of_gravity.parameters, of_potential.parameters);
    const auto number = common(of_gravity.numbers, of_potential.numbers);
    std::string both;
    if (parameter != of_gravity.parameters.end())
      both = quote(model_.parameters[*parameter].name);
    else if (number != of_gravity.numbers.end())
      both = fmt::format("{}", cln::double_approx(*number));
    else
      continue;
    resolver_.warn(force.span, fmt::format("gravity and the potential of [energy] both contain {}: both act", both),
                   "leave out one of them if the potential is that of the weights");
  }
}

const Entry& ForcesReader::kind_of(const Value& table) const {
  const std::vector<std::string_view> others = beside();
  Keys keys{"[[force]]", kinds()};
  keys.known.emplace_back("name");
  keys.known.insert(keys.known.end(), others.begin(), others.end());
  check_keys(table, keys);
  const Entry* found = nullptr;
  for (const Entry& entry : table.entries) {
    if (entry.key == "name" || std::find(others.begin(), others.end(), entry.key) != others.end()) continue;
    if (found != nullptr) {
      source_.fail(entry.span, fmt::format("one [[force]] is both '{}' and '{}'", found->key, entry.key),
                   "write one [[force]] for each");
    }
    found = &entry;
  }
  if (found == nullptr) {
    source_.fail(table.span, "this [[force]] has no kind of force",
                 fmt::format("add one of {}", fmt::join(kinds(), ", ")));
  }
  const forces::Kind& kind = *forces::find(found->key);
  for (const std::string_view other : others) {
    if (table.find(other) == nullptr || (kind.form == forces::InputFormat::value && has_key(kind, other))) continue;
    source_.fail(key_span(table, other), fmt::format("'{}' does not belong to '{}'", other, kind.name),
                 has_key(kind, other) ? fmt::format("write it within {} = {{ .. }}", kind.name)
                                      : "'on' names the point where a force vector acts: force = \"<vector>\", on = P");
  }
  return *found;
}

void ForcesReader::read_force(Force& force, const Value& table) {
  const Entry& entry = kind_of(table);
  const forces::Kind& kind = *forces::find(entry.key);
  force.kind = kind.name;
  const bool named = table.find("name") != nullptr;
  const std::string what = named ? fmt::format("'{}'", force.name) : fmt::format("this {}", kind.name);
  if (kind.form != forces::InputFormat::value)
    require_kind(Value::Kind::table, entry.value, what, fmt::format("write {} = {{ ... }}", kind.name));
  if (kind.form == forces::InputFormat::components) return read_components(force, entry.value, what);
  if (kind.form == forces::InputFormat::friction) {
    force.dry = FrictionReader(context_).read_dry_friction(entry.value, what);
    return;
  }
  ForceDraft open{kind, force, kind.form == forces::InputFormat::value ? table : entry.value, what, named, {}};
  if (kind.form == forces::InputFormat::table) {
    Keys keys{what, {}};
    for (const forces::Key& key : kind.keys) keys.known.push_back(key.name);
    check_keys(entry.value, keys);
  }
  check_rules(open);
  for (const forces::Key& key : kind.keys) read_key(open, key);
  expand_formulas(open);
}

void ForcesReader::check_rules(const ForceDraft& open) const {
  for (const forces::Key& key : open.kind.keys) {
    const bool elsewhere = !key.required_unless.empty() && open.table.find(key.required_unless) != nullptr;
    if (!key.optional && !elsewhere)
      require_value(open.table, key.name, open.what, key.remedy.empty() ? remedy_for(key) : key.remedy);
  }
  for (const forces::Rule& rule : open.kind.rules) {
    const bool first = open.table.find(rule.first) != nullptr, second = open.table.find(rule.second) != nullptr;
    using Type = forces::Rule::Type;
    if ((rule.type == Type::not_both && first && second) || (rule.type == Type::needs && first && !second))
      source_.fail(key_span(open.table, rule.first), fmt::format("{} {}", open.what, rule.what), rule.remedy);
    const bool other = std::any_of(rule.others.begin(), rule.others.end(),
                                   [&](const std::string& key) { return open.table.find(key) != nullptr; });
    if (rule.type == Type::one_of && !first && !second && !other)
      source_.fail(open.table.span, fmt::format("{} {}", open.what, rule.what), rule.remedy);
  }
}

void ForcesReader::read_key(ForceDraft& open, const forces::Key& key) {
  if (const Value* given = open.table.find(key.name)) return read_value(open, key, *given);
  if (key.default_value.empty() || (!key.default_requires.empty() && open.table.find(key.default_requires) == nullptr))
    return;
  const Context any{key.name, on_anything, Shape::either, std::nullopt, ""};
  store_argument(open, key.name, resolver_.text(key.default_value, {}, open.table.span, any));
}

void ForcesReader::read_components(Force& force, const Value& table, const std::string& what) {
  if (table.entries.empty())
    source_.fail(table.span, fmt::format("{} names no coordinate", what), "write generalized = { x = \"F\" }");
  for (const Entry& entry : table.entries) {
    const Symbol* symbol = scope_.find(entry.key);
    if (symbol == nullptr || symbol->kind != SymbolKind::coordinate) {
      const std::string hint = did_you_mean(entry.key, scope_.names(SymbolKind::coordinate));
      source_.fail(entry.span, fmt::format("{} is not a coordinate", quote(entry.key)),
                   hint.empty() ? "the keys of 'generalized' are coordinates" : hint);
    }
    Context component{fmt::format("the generalized force along '{}'", entry.key), on_force_variables, Shape::scalar,
                      std::nullopt, ""};
    const auto& dimension = model_.coordinates[symbol->index].unit.dimension;
    if (dimension) component.dimension = quotient(dimension_of("J"), *dimension);
    const NodeId value = resolver_.value(entry.value, component).node;
    force.arguments.push_back({entry.key, value, symbol->index});
    Effect effect;
    effect.load_type = Effect::LoadType::component;
    effect.value = value;
    effect.index = symbol->index;
    force.effects.push_back(effect);
  }
}

}  // namespace eomgen::model
