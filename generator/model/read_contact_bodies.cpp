// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of two bodies: the points of contact of both and the normal. It is then treated as the contact of a body with
// a plane through the point of the other body, which moves with that point, eq. (7.28).
#include <fmt/format.h>

#include "model/read_contacts.hpp"

namespace eomgen::model {

bool ContactsReader::touches_body(const Value& on) {
  if (!on.is(Value::Kind::text) || on.text == "ground") return false;
  const Symbol* symbol = scope_.find(on.text);
  return symbol != nullptr && symbol->frame > 0;
}

// The geometry is right for all positions by its construction (contact_shapes.hpp). Obstacles are at rest.
std::string ContactsReader::nearest_points(BodyContact& contact, const Value& table,
                                           std::map<std::string, TypedNode>& local) {
  const Value& on = *table.find("on");
  if (touches_body(on)) other_body(contact, on, local);
  const Context any{"a contact", on_motion, Shape::either, std::nullopt, ""};
  for (const Value& value : table.find("at_rest")->items)
    resolver_.value(value, {"an obstacle with friction", 0, Shape::either, std::nullopt,
                            "it is at rest: write it with parameters, or the shape of a body, on = \"B\""});
  std::map<std::string, TypedNode> parts;  // names of the model and of parts, without those of the equations
  for (const Entry& entry : table.find("parts")->entries) {
    if (scope_.find(entry.key) != nullptr)
      source_.fail(table.span, fmt::format("{} is a name of the geometry of this contact", quote(entry.key)),
                   "rename what has this name in the model");
    parts[entry.key] = resolver_.text(entry.value.text, parts, table.span, any);
  }
  const auto vector = [&](const char* key) {
    return resolver_.text(table.find(key)->text, parts, table.span,
                          {"a contact", on_motion, Shape::vector, std::nullopt, ""});
  };
  local["p"] = vector("at");
  local["pb"] = vector("at_b");
  local["n"] = vector("normal");
  local["gap"] = resolver_.text(table.find("gap")->text, parts, table.span,
                                {"the gap of a contact", on_motion, Shape::scalar, dimension_of("m"), ""});
  default_tangents(true, table.span, local);
  const Context motion{"a contact", on_motion | on_velocity, Shape::vector, std::nullopt, ""};
  const bool rests = contact.other_frame == 0;
  local["o"] = rests ? local.at("pb") : resolver_.text("xb + pb", local, table.span, motion);
  local["V"] = rests ? resolver_.check_context(resolver_.number(0, table.span), table.span, motion)
                     : resolver_.text("vb + cross(wb, pb)", local, table.span, motion);
  return "gap";
}

void ContactsReader::other_body(BodyContact& contact, const Value& on, std::map<std::string, TypedNode>& local) {
  contact.other_frame = require_frame(on, "'on'");
  contact.other_place = frame_sources_[contact.other_frame].place;
  if (contact.other_place == 0)
    source_.fail(on.span, fmt::format("{} has no mass: contact of two bodies needs two", quote(on.text)),
                 "name a [[body]], or write the plane: on = { point = .., normal = .. }");
  if (contact.other_frame == contact.frame)
    source_.fail(on.span, fmt::format("{} cannot touch itself", quote(on.text)), "name the other body, or \"ground\"");
  name_motion(contact.other_frame, "b", on.span, local);
}

std::optional<std::string> ContactsReader::between_bodies(BodyContact& contact, const Value& table,
                                                          std::map<std::string, TypedNode>& local) {
  other_body(contact, *table.find("on"), local);
  const bool shapes = table.find("shape") != nullptr;
  if (shapes) {
    spheres_in_contact(table, local);
  } else {
    points_in_contact(table, local);
  }
  const Context any{"a contact", on_motion | on_velocity, Shape::vector, std::nullopt, ""};
  if (table.find("tangent") == nullptr)
    default_tangents((local.at("n").dependencies & on_coordinate) != 0, table.span, local);
  local["o"] = resolver_.text("xb + pb", local, table.span, any);
  local["V"] = resolver_.text("vb + cross(wb, pb)", local, table.span, any);
  if (!shapes) return std::nullopt;
  const bool hollow = table.find("shape_b")->find("hollow") != nullptr;
  return hollow ? "Rb - R - norm(x - xb)" : "norm(x - xb) - (R + Rb)";
}

// shape = { sphere = "R" }, shape_b = { sphere = "S" } or { hollow = "S" } with the other sphere inside.
void ContactsReader::spheres_in_contact(const Value& table, std::map<std::string, TypedNode>& local) {
  constexpr const char* form =
      "write shape = { sphere = \"R\" }, shape_b = { sphere = \"S\" }, or shape_b = { hollow = \"S\" } where it is "
      "inside of the other";
  for (const char* key : {"at", "at_b", "normal"}) {
    if (table.find(key) != nullptr)
      source_.fail(key_span(table, key), fmt::format("this contact has both 'shape' and '{}'", key), form);
  }
  const auto radius = [&](const char* key, const std::vector<std::string_view>& kinds) {
    const Value& shape = require_kind(Value::Kind::table, require_value(table, key, "a contact of two spheres", form),
                                      fmt::format("'{}'", key), form);
    check_keys(shape, {fmt::format("'{}' in a contact of two bodies", key), kinds});
    if (shape.entries.size() != 1)
      source_.fail(shape.span, fmt::format("'{}' is given in {} ways", key, shape.entries.size()), form);
    return resolver_.value(shape.entries[0].value,
                           {"the radius of a contact", 0, Shape::scalar, dimension_of("m"), ""});
  };
  local["R"] = radius("shape", {"sphere"});
  local["Rb"] = radius("shape_b", {"sphere", "hollow"});
  const bool hollow = table.find("shape_b")->find("hollow") != nullptr;
  const Context direction{"a normal", on_motion, Shape::vector, std::nullopt, ""},
      arm{"an arm", on_motion, Shape::vector, dimension_of("m"), ""};
  local["n"] = resolver_.text(hollow ? "unit(xb - x)" : "unit(x - xb)", local, table.span, direction);
  local["p"] = resolver_.text("-R*n", local, table.span, arm);
  local["pb"] = resolver_.text(hollow ? "-Rb*n" : "Rb*n", local, table.span, arm);
}

// at, at_b and the normal; the default normal is that of a sphere about the centre of mass of the first body.
void ContactsReader::points_in_contact(const Value& table, std::map<std::string, TypedNode>& local) {
  const std::string what = "a contact of two bodies";
  if (const Value* shape = table.find("shape_b"))
    source_.fail(shape->span, "'shape_b' needs 'shape' of the first body beside it",
                 "add shape = { sphere = \"R\" }, or give at and at_b");
  const Context arm{"the vector to the point of contact", on_motion, Shape::vector, dimension_of("m"),
                    "it is made of coordinates, axes of the bodies, angles and lengths"};
  const std::string remedy = fmt::format(
      "add at = \"<vector>\" from the body and at_b = \"<vector>\" from '{}' to where they touch, or shape and shape_b",
      table.find("on")->text);
  local["p"] = resolver_.value(require_value(table, "at", what, remedy), arm);
  local["pb"] = resolver_.value(require_value(table, "at_b", what, remedy), arm);
  const Context direction{"a normal", on_motion, Shape::vector, std::nullopt,
                          "a normal is made of coordinates, axes and t"};
  const Value* normal = table.find("normal");
  local["n"] = normal != nullptr ? resolver_.unit_of_vector(resolver_.value(*normal, direction), normal->span)
                                 : resolver_.text("unit(-p)", local, table.span, direction);
}

}  // namespace eomgen::model
