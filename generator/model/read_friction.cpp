// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/read_friction.hpp"

#include <fmt/format.h>

namespace eomgen::model {

Friction FrictionReader::coefficients(const Value& table, const std::string& what, std::optional<Dimension> speed) {
  Friction law;
  law.span = table.span;
  const auto coefficient = [&](std::string_view key) {
    const Value& value =
        require_value(table, key, what, "give both coefficients: static = \"..\" and dynamic = \"..\"");
    if (const Symbol* other = scope_.find("slip")) {
      source_.fail(value.span, "'slip' means the slip speed of this contact here, and it is also declared in the model",
                   fmt::format("rename {} 'slip' of line {}", model::kind_name(other->kind), other->span.line));
    }
    TypedNode slip = resolver_.slip(value.span);
    if (speed) slip.dimension = *speed;
    const Context context{fmt::format("the {} coefficient of {}", key, what), on_force_variables, Shape::scalar,
                          dimension_of("1"),
                          "a coefficient of friction is made of parameters, slip, velocities, coordinates and t"};
    return resolver_.value_with_names(value, {{"slip", slip}}, context).node;
  };
  law.dynamic_coefficient = coefficient("dynamic");
  const Value* name = table.find("law");
  const Value* width = table.find("width");
  if (name != nullptr)
    require_kind(Value::Kind::text, *name, fmt::format("'law' of {}", what),
                 "write law = \"coulomb\" or law = \"smooth\"");
  if (name != nullptr && name->text != "coulomb" && name->text != "smooth") {
    source_.fail(name->span, fmt::format("there is no law of friction {}", quote(name->text)),
                 "write law = \"coulomb\" (the default), which sticks and slides, or law = \"smooth\"");
  }
  if (name == nullptr || name->text == "coulomb") {
    if (width != nullptr) {
      source_.fail(width->span, fmt::format("'width' of {} belongs to the smooth law", what),
                   "add law = \"smooth\", or remove width: Coulomb's law has none");
    }
    law.static_coefficient = coefficient("static");
    return law;
  }
  if (const Value* value = table.find("static")) {
    source_.fail(value->span,
                 fmt::format("the smooth law of {} has no static coefficient: under it nothing sticks", what),
                 "remove static, or law = \"smooth\"");
  }
  const Value& given =
      require_value(table, "width", what, "add width = \"1 mm/s\", the slip speed at which friction is mu |N|/sqrt(2)");
  law.width = resolver_
                  .value(given, Context{fmt::format("the width of {}", what), on_time, Shape::scalar, speed,
                                        "a width is a slip speed made of parameters"})
                  .node;
  return law;
}

void FrictionReader::read_constraint_friction(Constraint& constraint, const Value& value) {
  const std::string what = fmt::format("the friction of '{}'", constraint.name);
  require_kind(Value::Kind::table, value, what, "write friction = { static = \"mu_s\", dynamic = \"mu_d\" }");
  check_keys(value, {what, {"static", "dynamic", "surface_velocity", "law", "width"}});
  if (constraint.velocity) {
    source_.fail(value.span,
                 fmt::format("'{}' is a constraint on velocities, which has no surface to slide on", constraint.name),
                 "friction belongs to a holonomic constraint of one particle: a surface, or a curve of two equations");
  }
  if (constraint.psi.size() > 2) {
    source_.fail(value.span, fmt::format("'{}' leaves no direction to slide in", constraint.name),
                 "friction belongs to one equation (a surface) or to two (a curve)");
  }
  Friction law = coefficients(value, what, dimension_of("m/s"));
  if (law.width != no_node && constraint.contact && constraint.contact->rolling) {
    source_.fail(value.span, fmt::format("under the smooth law '{}' creeps and never rolls", constraint.name),
                 "write sliding = { .. } in place of rolling, or law = \"coulomb\"");
  }
  if (const Value* velocity = value.find("surface_velocity")) {
    const Context context{fmt::format("the surface velocity of '{}'", constraint.name), on_motion, Shape::vector,
                          dimension_of("m/s"), "the velocity of a surface is made of coordinates, parameters and t"};
    law.surface_velocity = resolver_.value(*velocity, context).node;
  }
  constraint.friction = law;
}

DryFriction FrictionReader::read_dry_friction(const Value& table, const std::string& what) {
  check_keys(table, {what, {"coordinate", "normal", "static", "dynamic", "law", "width"}});
  const Value& name = require_value(table, "coordinate", what, "add coordinate = \"x\", the coordinate with friction");
  require_kind(Value::Kind::text, name, fmt::format("the coordinate of {}", what), "write the name of a coordinate");
  const Symbol* symbol = scope_.find(name.text);
  if (symbol == nullptr || symbol->kind != SymbolKind::coordinate) {
    const std::string hint = did_you_mean(name.text, scope_.names(SymbolKind::coordinate));
    source_.fail(name.span, fmt::format("{} is not a coordinate", quote(name.text)),
                 hint.empty() ? "name a coordinate of the model" : hint);
  }
  DryFriction rubbing{symbol->index, no_node, {}};
  const Value& normal = require_value(table, "normal", what, "add normal = \"m*g\", the normal force");
  rubbing.normal =
      resolver_
          .value(normal, Context{fmt::format("the normal force of {}", what), on_force_variables, Shape::scalar,
                                 std::nullopt, "a normal force is made of parameters, the state and t"})
          .node;
  rubbing.law = coefficients(table, what, std::nullopt);
  for (const Force& before : model_.forces) {
    const std::optional<DryFriction>& other = before.dry;
    if (!other || other->coordinate != rubbing.coordinate || rubbing.law.width != no_node ||
        other->law.width != no_node)
      continue;
    source_.fail(name.span,
                 fmt::format("{} sticks with '{}' already: how the two share the static friction is not defined",
                             quote(name.text), before.name),
                 "write one force whose normal force is that of both");
  }
  return rubbing;
}

bool FrictionReader::is_output(const std::vector<std::string>& parts) {
  constexpr std::string_view outputs[] = {"friction", "slip", "mode", "gap"};
  if (parts.size() < 2 || parts.size() > 3 ||
      std::find(std::begin(outputs), std::end(outputs), parts[0]) == std::end(outputs))
    return false;
  const Symbol* symbol = scope_.find(parts[1]);
  if (symbol == nullptr) return false;
  const bool dry = symbol->kind == SymbolKind::force && model_.forces[symbol->index].dry.has_value();
  const bool constraint = symbol->kind == SymbolKind::constraint;
  const bool rough = constraint && model_.constraints[symbol->index].friction.has_value();
  const bool left = constraint && model_.constraints[symbol->index].unilateral;
  if (parts[0] == "gap") return parts.size() == 2 && left;
  if (parts[0] == "mode") return parts.size() == 2 && (dry || rough || left);
  if (parts[0] == "slip")
    return (dry || rough) && (parts.size() == 2 || (rough && (parts[2] == "1" || parts[2] == "2")));
  if (dry) return parts.size() == 2;
  if (rough && parts.size() == 2) return true;  // all three components
  return rough && (parts[2] == "1" || parts[2] == "2" || parts[2] == "3");
}

}  // namespace eomgen::model
