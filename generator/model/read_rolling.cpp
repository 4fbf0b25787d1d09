// SPDX-License-Identifier: GPL-3.0-or-later
// rolling = { .. } and sliding = { .. }: contact of a body with a plane or another body, without slip or with slip. The
// equations of rolling are the velocities along the two tangents and the position along the normal, eqs. (7.28),
// (7.38). With friction only the position remains a constraint; the law of friction replaces the others.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "model/read_contacts.hpp"
#include "model/samples.hpp"

namespace eomgen::model {
namespace {

constexpr const char* rolling_form =
    "write rolling = { body = \"B\", at = \"<vector>\", on = \"ground\" }, with shape = { sphere = \"R\" } or { disk = "
    "\"R\" } instead of 'at' if it is one";

}  // namespace

// The plane: a point, the normal, the tangential surface velocity and the tangents.
std::map<std::string, TypedNode> ContactsReader::plane_of_contact(const Value& on) {
  const Span span = on.span;
  const Context position{"a plane", on_motion, Shape::vector, std::nullopt, ""};
  std::map<std::string, TypedNode> plane;
  const auto basis = [&](std::size_t k) { return resolver_.own_axis(0, k, span); };
  const TypedNode zero = resolver_.check_context(resolver_.number(0, span), span, position);
  if (on.is(Value::Kind::text)) {
    if (on.text != "ground") {
      source_.fail(span, fmt::format("there is no ground and no body {}", quote(on.text)),
                   "write on = \"ground\", the plane E3.r = 0, on = { point = .., normal = .. }, or the name of "
                   "another [[body]]");
    }
    return {{"o", zero}, {"V", zero}, {"n", basis(2)}, {"t1", basis(0)}, {"t2", basis(1)}};
  }
  require_kind(Value::Kind::table, on, "'on'",
               "write on = \"ground\" or on = { point = \"<vector>\", normal = \"<vector>\" }");
  check_keys(on, {"a plane", {"point", "normal", "velocity"}});
  const auto vector = [&](const char* key, Dependencies allowed, const char* unit, const char* remedy) {
    const Value* value = on.find(key);
    if (value == nullptr) return zero;
    return resolver_.value(*value, {fmt::format("the {} of the plane", key), allowed, Shape::vector,
                                    *unit == 0 ? std::nullopt : std::optional<Dimension>(dimension_of(unit)), remedy});
  };
  const char* moving = "a plane moves by prescription: it is made of parameters, functions of time and t";
  plane["o"] = vector("point", on_time, "m", moving);
  plane["V"] = vector("velocity", on_motion, "m/s",
                      "the velocity of a plane where it is touched is made of coordinates, functions of time and t");
  require_value(on, "normal", "a plane", "add normal = \"E3\", which points to the side of the body");
  const TypedNode normal = vector("normal", on_time, "", moving);
  const Node& node = model_.arena[normal.node];
  if (node.op == Op::fixed_basis) {
    const std::size_t k = node.index;
    plane["n"] = normal;
    plane["t1"] = basis((k + 1) % 3);
    plane["t2"] = basis((k + 2) % 3);
    return plane;
  }
  if (node.op == Op::negate && model_.arena[node.args[0]].op == Op::fixed_basis) {
    plane["n"] = normal;
    plane["t1"] = basis((model_.arena[node.args[0]].index + 1) % 3);
    plane["t2"] = resolver_.text("cross(n, t1)", plane, span, position);
    return plane;
  }
  plane["n"] = resolver_.unit_of_vector(normal, span);
  default_tangents(false, span, plane);
  return plane;
}

// The vector from the centre of mass to the point of contact.
TypedNode ContactsReader::contact_arm(const Value& table, std::map<std::string, TypedNode>& local) {
  const Value *at = table.find("at"), *shape = table.find("shape");
  if ((at == nullptr) == (shape == nullptr)) {
    source_.fail(table.span,
                 at == nullptr ? "this contact does not state where the body is touched"
                               : "this contact has both 'at' and 'shape'",
                 rolling_form);
  }
  const Context arm{"the vector to the point of contact", on_motion, Shape::vector, dimension_of("m"),
                    "it is made of axes of the body, angles and lengths"};
  if (at != nullptr) return resolver_.value(*at, arm);
  require_kind(Value::Kind::table, *shape, "'shape'", "write shape = { sphere = \"R\" } or { disk = \"R\" }");
  check_keys(*shape, {"a shape in contact", {"sphere", "disk"}});
  if (shape->entries.size() != 1)
    source_.fail(shape->span, fmt::format("a shape in contact is given in {} ways", shape->entries.size()),
                 "write shape = { sphere = \"R\" } or { disk = \"R\" }");
  const Entry& entry = shape->entries[0];
  local["R"] = resolver_.value(entry.value, {"the radius of a contact", 0, Shape::scalar, dimension_of("m"), ""});
  return resolver_.text(entry.key == "sphere" ? "-R*n" : "-R*(n - dot(n, e3)*e3)/sqrt(1 - dot(n, e3)^2)", local,
                        entry.value.span, arm);
}

// A disk that lies flat has no lowest point: its angle from the plane keeps the sign of the start, and sin of it is
// taken as positive unless [coordinates] states a range.
void ContactsReader::set_range_of_tilt(std::uint32_t frame, const Value& table,
                                       const std::map<std::string, TypedNode>& local) {
  const Value* shape = table.find("shape");
  const Frame& body = model_.frames[frame];
  const Node& normal = model_.arena[local.at("n").node];
  const bool tilts = body.parent == 0 && (body.rotation == "313" || body.rotation == "323");
  if (shape == nullptr || shape->entries[0].key != "disk" || !tilts || normal.op != Op::fixed_basis ||
      normal.index != 2)
    return;
  const Node& angle = model_.arena[body.entries[1]];
  if (angle.op != Op::coordinate || angle.order != 0) return;
  Coordinate& tilt = model_.coordinates[angle.index];
  if (tilt.lower != no_node || tilt.upper != no_node) return;
  const Context context{"the range of an angle", 0, Shape::scalar, std::nullopt, ""};
  tilt.lower = resolver_.text("0", {}, shape->span, context).node;
  tilt.upper = resolver_.text("pi", {}, shape->span, context).node;
}

// Spheres and disks in contact are drawn as such, unless [draw] says otherwise.
void ContactsReader::draw_shapes(const BodyContact& contact, const Value& table,
                                 const std::map<std::string, TypedNode>& local) {
  const auto add = [&](const char* key, std::uint32_t place, const char* radius) {
    const Value* shape = table.find(key);
    if (shape == nullptr || place == 0) return;
    const Entry& entry = shape->entries[0];
    if (entry.key != "hollow")
      context_.contact_shapes.push_back({place, entry.key, {local.at(radius).node}, {}, 2, {}, entry.value.span});
  };
  add("shape", contact.place, "R");
  add("shape_b", contact.other_place, "Rb");
}

// Names for the motion of a body: its centre of mass x and the velocity v of it, its angular velocity w, its axis e3.
// The equations use only these names, so that they cannot collide with names of the model.
void ContactsReader::name_motion(std::uint32_t frame, const std::string& ending, Span span,
                                 std::map<std::string, TypedNode>& local) {
  const Context vector{"a contact", on_motion | on_velocity, Shape::vector, std::nullopt, ""};
  const std::map<std::string, TypedNode> body{{"x", resolver_.place(frame_sources_[frame].place, span)}};
  local["x" + ending] = body.at("x");
  local["v" + ending] = resolver_.text("ddt(x)", body, span, vector);
  local["w" + ending] = resolver_.check_context(resolver_.angular_velocity(frame, span), span, vector);
  local["e3" + ending] = resolver_.own_axis(frame, 2, span);
}

// Tangent 1 is the direction of E1 in the plane. A normal that is always along E1 takes E2 in its place. A normal that
// turns about a fixed axis passes E1 in its turn, so tangent 1 turns with it, and is E1 where the normal is the axis
// across both.
void ContactsReader::default_tangents(bool turns, Span span, std::map<std::string, TypedNode>& local) {
  constexpr int points = 4;
  constexpr double zero = 1e-7;  // differences for basis vectors are good to 1e-10
  std::array<bool, 3> across{true, true, true}, no_part{true, true, true};  // of E1, E2, E3, at all points
  Samples samples(model_);
  for (int i = 0; i < points; ++i) {
    samples.next();
    const std::array<double, 3> n = samples.vector(local.at("n").node);
    for (std::size_t k = 0; k < 3; ++k) {
      across[k] = across[k] && std::abs(n[k]) <= zero;
      no_part[k] = no_part[k] && n[k] == 0;
    }
  }
  std::string first = "unit(E1 - dot(E1, n)*n)";
  if (no_part[1] && no_part[2])  // an angle of 90 deg leaves a part of 1e-17, which has a direction
    first = "unit(E2 - dot(E2, n)*n)";
  else if (turns && across[0])
    first = "E1";
  else if (turns && across[1])
    first = "cross(E2, n)";
  else if (turns && across[2])
    first = "cross(n, E3)";
  const Context direction{"a tangent", on_motion, Shape::vector, std::nullopt, ""};
  local["t1"] = resolver_.text(first, local, span, direction);
  local["t2"] = resolver_.text("cross(n, t1)", local, span, direction);
}

// The direction to which tangent 1 is closest, if the model gives one.
void ContactsReader::tangent_of_contact(const Value& table, std::map<std::string, TypedNode>& local) {
  const Value* value = table.find("tangent");
  if (value == nullptr) return;
  local["a"] = resolver_.value(*value, {"the tangent of a contact", on_motion, Shape::vector, std::nullopt,
                                        "it is made of axes, coordinates and t"});
  const Context direction{"a tangent", on_motion, Shape::vector, std::nullopt, ""};
  local["t1"] = resolver_.text("unit(a - dot(a, n)*n)", local, value->span, direction);
  local["t2"] = resolver_.text("cross(n, t1)", local, value->span, direction);
}

// The point of contact and the slip velocity there.
void ContactsReader::read_contact_point(Constraint& constraint, const Value& table,
                                        const std::map<std::string, TypedNode>& local) {
  const std::string what = fmt::format("the constraint '{}'", constraint.name);
  BodyContact& contact = *constraint.contact;
  contact.arm = local.at("p").node;
  contact.tangents = {local.at("t1").node, local.at("t2").node};
  const auto read = [&](const std::string& text, Shape shape) {
    return resolver_.text(text, local, table.span, {what, on_motion | on_velocity, shape, std::nullopt, ""}).node;
  };
  contact.slip = read("v + cross(w, p) - V", Shape::vector);
  contact.tangential_velocity = read("ddt(p) - cross(w, p)", Shape::vector);
  if (local.contains("pb")) contact.other_arm = local.at("pb").node;
  if (local.contains("gap")) return;
  // The point of contact may move over the body, but not along the normal: it would then not be the point of contact.
  contact.normal_velocity.push_back(read("dot(ddt(p) - cross(w, p), n)", Shape::scalar));
  if (contact.other_frame == 0) return;
  contact.normal_velocity.push_back(read("dot(ddt(pb) - cross(wb, pb), n)", Shape::scalar));
  contact.offset = read("x + p - o - dot(x + p - o, n)*n", Shape::vector);
}

void ContactsReader::read(Constraint& constraint, const Value& table, bool rolling, bool rough) {
  const std::string what = fmt::format("the constraint '{}'", constraint.name);
  require_kind(Value::Kind::table, table, what, rolling_form);
  if (!table.generated)
    check_keys(table, {what, {"body", "on", "at", "shape", "at_b", "shape_b", "normal", "tangent"}});
  const Value& name = require_value(table, "body", what, rolling_form);
  const std::uint32_t frame = require_frame(name, fmt::format("'body' of {}", what));
  if (frame == 0 || frame_sources_[frame].place == 0)
    source_.fail(name.span, fmt::format("{} needs a body, and this has no mass", what), "name a [[body]]");
  constraint.contact.emplace();
  constraint.contact->frame = frame;
  constraint.contact->place = frame_sources_[frame].place;
  constraint.contact->rolling = rolling;
  const Value& on = require_value(table, "on", what, "add on = \"ground\"");
  std::map<std::string, TypedNode> local;
  std::string psi = "dot(x + p - o, n)";
  if (table.find("gap") != nullptr) {
    name_motion(frame, "", table.span, local);
    psi = nearest_points(*constraint.contact, table, local);
  } else if (touches_body(on)) {
    name_motion(frame, "", table.span, local);
    psi = between_bodies(*constraint.contact, table, local).value_or(psi);
  } else {
    for (const char* key : {"at_b", "shape_b", "normal"}) {
      if (table.find(key) == nullptr) continue;
      source_.fail(key_span(table, key),
                   fmt::format("'{}' belongs to a contact of two bodies, and this is one with a plane", key),
                   *key == 'n' ? "write on = { point = \"<vector>\", normal = \"<vector>\" }"
                               : "remove it, or name the other body in 'on'");
    }
    local = plane_of_contact(on);
    name_motion(frame, "", table.span, local);
    local["p"] = contact_arm(table, local);
    set_range_of_tilt(frame, table, local);
  }
  draw_shapes(*constraint.contact, table, local);
  tangent_of_contact(table, local);
  const Context scalar{what, on_motion | on_velocity, Shape::scalar, std::nullopt, ""};
  const auto equation = [&](const std::string& text) { return resolver_.text(text, local, table.span, scalar); };
  constraint.rolling = rolling && !rough;
  if (constraint.rolling) {
    for (const char* tangent : {"t1", "t2"}) {
      constraint.psi.push_back(equation(fmt::format("dot(v + cross(w, p) - V, {})", tangent)).node);
    }
  }
  constraint.psi.push_back(equation(psi).node);
  read_contact_point(constraint, table, local);
}

}  // namespace eomgen::model
