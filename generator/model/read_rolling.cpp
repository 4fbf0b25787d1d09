// SPDX-License-Identifier: GPL-3.0-or-later
// rolling = { .. } and sliding = { .. }: a body that touches a plane with a point at rest against it, or only touches it. Written out
// as equations: of rolling the velocities along the two tangents and the position along the normal, eqs. (7.28), (7.38).
#include <fmt/format.h>

#include "model/reader.hpp"

namespace eomgen::model {
namespace {

constexpr const char* form =
    "write rolling = { body = \"B\", at = \"<vector>\", on = \"ground\" }, with shape = { sphere = \"R\" } or { disk = \"R\" } instead of 'at' if it is one";

}  // namespace

// The plane: a point of it, its normal, what it does along itself, and the tangents.
std::map<std::string, Typed> Reader::plane_of_contact(const Value& on) {
  const Span span = on.span;
  const Context position{"a plane", on_motion, Shape::vector, std::nullopt, ""};
  std::map<std::string, Typed> plane;
  const auto basis = [&](std::size_t k) { return resolver_.own_axis(0, k, span); };
  const Typed zero = resolver_.meet(resolver_.number(0, span), span, position);
  if (on.is(Value::Kind::text)) {
    if (on.text != "ground") {
      if (const Symbol* symbol = scope_.find(on.text); symbol != nullptr && symbol->frame > 0) not_yet(span, "contact of two bodies");
      source_.fail(span, fmt::format("there is no ground {}", quote(on.text)), "write on = \"ground\", the plane E3.r = 0, or on = { point = .., normal = .. }");
    }
    return {{"o", zero}, {"V", zero}, {"n", basis(2)}, {"t1", basis(0)}, {"t2", basis(1)}};
  }
  as(Value::Kind::table, on, "'on'", "write on = \"ground\" or on = { point = \"<vector>\", normal = \"<vector>\" }");
  check_keys(on, {"a plane", {"point", "normal", "velocity"}, {}});
  const auto vector = [&](const char* key, Facts allowed, const char* unit, const char* remedy) {
    const Value* value = on.find(key);
    if (value == nullptr) return zero;
    return resolver_.value(*value, {fmt::format("the {} of the plane", key), allowed, Shape::vector,
                                    *unit == 0 ? std::nullopt : std::optional<Dimension>(dimension_of(unit)), remedy});
  };
  const char* moving = "a plane moves by prescription: it is made of parameters, functions of time and t";
  plane["o"] = vector("point", on_time, "m", moving);
  plane["V"] = vector("velocity", on_motion, "m/s", "the velocity of a plane where it is touched is made of coordinates, functions of time and t");
  needed(on, "normal", "a plane", "add normal = \"E3\", which points to the side of the body");
  const Typed normal = vector("normal", on_time, "", moving);
  const Node& node = model_.arena[normal.node];
  if (node.op == Op::fixed_basis) {
    const std::size_t k = node.index;
    plane["n"] = normal;
    plane["t1"] = basis((k + 1) % 3);
    plane["t2"] = basis((k + 2) % 3);
    return plane;
  }
  plane["n"] = resolver_.unit_of_vector(normal, span);
  plane["t1"] = resolver_.text("unit(E1 - dot(E1, n)*n)", plane, span, position);
  plane["t2"] = resolver_.text("cross(n, t1)", plane, span, position);
  return plane;
}

// From the centre of mass to the point of contact.
Typed Reader::contact_arm(const Value& table, const std::string& body, std::map<std::string, Typed> local) {
  const Value *at = table.find("at"), *shape = table.find("shape");
  if ((at == nullptr) == (shape == nullptr)) {
    source_.fail(table.span, at == nullptr ? "this contact says not where the body is touched" : "this contact has both 'at' and 'shape'", form);
  }
  const Context arm{"the vector to the point of contact", on_motion, Shape::vector, dimension_of("m"), "it is made of axes of the body, angles and lengths"};
  if (at != nullptr) return resolver_.value(*at, arm);
  as(Value::Kind::table, *shape, "'shape'", "write shape = { sphere = \"R\" } or { disk = \"R\" }");
  check_keys(*shape, {"a shape in contact", {"sphere", "disk"}, {}});
  if (shape->entries.size() != 1) source_.fail(shape->span, fmt::format("a shape in contact is given in {} ways", shape->entries.size()), "write shape = { sphere = \"R\" } or { disk = \"R\" }");
  const Entry& entry = shape->entries[0];
  local["R"] = resolver_.value(entry.value, {"the radius of a contact", 0, Shape::scalar, dimension_of("m"), ""});
  const std::string axis = body + ".e3";
  return resolver_.text(entry.key == "sphere" ? "-R*n" : fmt::format("-R*(n - dot(n, {0})*{0})/sqrt(1 - dot(n, {0})^2)", axis), local, entry.value.span, arm);
}

void Reader::read_rolling(Constraint& constraint, const Value& table, bool rolling) {
  const std::string what = fmt::format("the constraint '{}'", constraint.name);
  as(Value::Kind::table, table, what, form);
  check_keys(table, {what, {"body", "on", "at", "shape"}, {"at_b"}});
  const Value& name = needed(table, "body", what, form);
  const std::uint32_t frame = frame_named(name, fmt::format("'body' of {}", what));
  if (frame == 0 || frame_sources_[frame].place == 0) source_.fail(name.span, fmt::format("{} needs a body, and this has no mass", what), "name a [[body]]");
  std::map<std::string, Typed> local = plane_of_contact(needed(table, "on", what, "add on = \"ground\""));
  local["p"] = contact_arm(table, name.text, local);
  const Context scalar{what, on_motion | on_velocity, Shape::scalar, std::nullopt, ""};
  const auto equation = [&](const std::string& text) { return resolver_.text(text, local, table.span, scalar); };
  if (rolling) {
    for (const char* tangent : {"t1", "t2"}) {
      constraint.psi.push_back(equation(fmt::format("dot(velocity({0}) + cross(omega({0}), p) - V, {1})", name.text, tangent)).node);
    }
  }
  constraint.psi.push_back(equation(fmt::format("dot({} + p - o, n)", name.text)).node);
  constraint.rolling = rolling;
  // What touches the plane may move on the body, but not into the plane: then it would not be the point of contact.
  constraint.sinking = equation(fmt::format("dot(ddt(p) - cross(omega({}), p), n)", name.text)).node;
}

}  // namespace eomgen::model
