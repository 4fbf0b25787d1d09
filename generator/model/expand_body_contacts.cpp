// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts of a body: its points, corners or shape on planes, obstacles and other bodies.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "model/contact_table.hpp"
#include "model/names.hpp"
#include "model/syntax.hpp"

namespace eomgen::model {
namespace {

/// The gaps between a core and the half spheres at both ends of a capsule; none for other shapes.
std::vector<std::string> gaps_of_ends(const Core& core, const Core& capsule) {
  std::vector<std::string> result;
  if (capsule.kind != Core::Kind::segment) return result;
  for (const char* share : {"1/2", "(-1/2)"}) {
    const std::string centre = fmt::format("({} + {}*{}*{})", capsule.centre, share, capsule.size, capsule.axis);
    Names inlined{true};
    result.push_back(nearest_of_cores(core, {Core::Kind::point, centre, capsule.radius, "", ""}, inlined).at(0).gap);
  }
  return result;
}

}  // namespace

const Value& ContactTable::body() const {
  const Value& name = require("body", "add body = \"B\", which touches");
  require_text(name, "the body");
  return name;
}

const Value& ContactTable::on() const {
  return require("on", "add on = \"ground\", a plane, an obstacle, or another body");
}

bool ContactTable::is_body(const std::string& name) const {
  const Value* bodies = root_.find("body");
  if (bodies == nullptr) return false;
  return std::any_of(bodies->items.begin(), bodies->items.end(), [&](const Value& table) {
    const Value* own = table.find("name");
    return own != nullptr && own->text == name;
  });
}

bool ContactTable::is_on_plane() const {
  const Value& on = this->on();
  if (on.is(Value::Kind::text)) return on.text == "ground" || !is_body(on.text);
  return std::none_of(obstacles().begin(), obstacles().end(),
                      [&](const Obstacle& kind) { return on.find(kind.name) != nullptr; });
}

void ContactTable::add_point(const Value& at, const std::string& suffix, const std::string& arm) {
  if (!is_on_plane()) {
    const std::string position = fmt::format("({} + {})", body().text, arm);
    return add_core(at, suffix, {Core::Kind::point, position, "0", "", ""});
  }
  Value& constraint = begin(at, suffix);
  Value sliding = empty_table(at);
  sliding.entries.push_back({"body", at.span, body()});
  sliding.entries.push_back({"at", at.span, text_value(at, arm)});
  sliding.entries.push_back({"on", at.span, on()});
  if (const Entry* tangent = table_.entry("tangent")) sliding.entries.push_back(*tangent);
  constraint.entries.push_back({"sliding", at.span, std::move(sliding)});
}

void ContactTable::add_core(const Value& at, const std::string& suffix, const Core& core) {
  const Value& on = this->on();
  std::vector<Value> at_rest;
  std::vector<std::string> through_face;
  Approach approach;
  std::string what;
  if (on.is(Value::Kind::text)) {
    const Value& shape = require("shape_b", "add shape_b = { sphere = \"S\" }, the shape of the body in 'on'");
    what = "the shape in 'shape_b'";
    if (const Value* radius = shape.is(Value::Kind::table) ? shape.find("hollow") : nullptr) {
      approach = [size = length(*radius, "the radius"), centre = on.text](const Core& a, Names& names) {
        return nearest_to_hollow(a, centre, size, names);
      };
    } else {
      const Core other = core_of(shape, on.text);
      approach = [other](const Core& a, Names& names) { return nearest_of_cores(a, other, names); };
      if (core.kind == Core::Kind::disk) through_face = gaps_of_ends(core, other);
    }
  } else {
    if (const Value* shape = table_.find("shape_b")) fail(*shape, "gives shape_b, and 'on' is no body", "remove it");
    const Obstacle& kind = kind_of(on, obstacles(), "obstacle");
    what = fmt::format("a {}", kind.name);
    const std::vector<std::string> values = values_of(on, kind);
    if (kind.nearest == nullptr) return add_on_surface(at, suffix, core, values[0]);
    for (const std::string& value : values) at_rest.push_back(text_value(on, value));
    approach = [&kind, values](const Core& a, Names& names) { return kind.nearest(a, values, names); };
    if (core.kind == Core::Kind::disk && kind.through_face != nullptr) through_face = kind.through_face(core, values);
  }
  Names names, unused;
  const std::vector<Nearest> found = approach(core, names);
  const bool has_rim =
      core.kind == Core::Kind::disk && !approach({Core::Kind::point, core.centre, "0", "", ""}, unused).empty();
  if (found.empty() && has_rim) return rim(at, core, approach, at_rest, through_face);
  if (found.empty()) refuse_pair(at, what);
  std::size_t count = 0;
  for (const Nearest& nearest : found)
    add_nearest(at, found.size() == 1 ? suffix : std::to_string(++count), body(), on, nearest, names, at_rest);
}

void ContactTable::refuse_pair(const Value& at, const std::string& what) const {
  fail(at, fmt::format("has a shape whose distance from {} has no closed form, or is 0 while they pass", what),
       "a point touches shapes with a radius, a disk touches spheres, and with its rim capsules; of pairs of shapes "
       "give a disk in 'shape' and the other one in 'shape_b'");
}

void ContactTable::add_nearest(const Value& at, const std::string& suffix, const Value& body, const Value& on,
                               const Nearest& nearest, const Names& names, const std::vector<Value>& at_rest) {
  const bool rests = !on.is(Value::Kind::text);
  Value parts = empty_table(at), rest;
  for (const auto& [name, text] : names.named) parts.entries.push_back({name, at.span, text_value(at, text)});
  rest.kind = Value::Kind::array;
  if (table_.find("friction") != nullptr) rest.items = at_rest;
  Value sliding = empty_table(at);
  sliding.generated = true;
  const auto put = [&](const char* key, Value value) { sliding.entries.push_back({key, at.span, std::move(value)}); };
  put("body", body);
  put("on", rests ? text_value(on, "ground") : on);
  put("at", text_value(at, nearest.own + " - " + body.text));
  put("at_b", text_value(at, rests ? nearest.other : nearest.other + " - " + on.text));
  put("normal", text_value(at, nearest.normal));
  put("gap", text_value(at, nearest.gap));
  put("parts", std::move(parts));
  put("at_rest", std::move(rest));
  if (const Entry* tangent = table_.entry("tangent")) sliding.entries.push_back(*tangent);
  begin(at, suffix).entries.push_back({"sliding", at.span, std::move(sliding)});
}

void ContactTable::add_on_surface(const Value& at, const std::string& suffix, const Core& core, const std::string& f) {
  if (core.kind == Core::Kind::segment) return capsule_on_surface(at, core, f);
  if (core.kind == Core::Kind::disk) return rim_on_surface(at, core, f);
  if (core.radius != "0") return ball_on_surface(at, suffix, core, f);
  const std::string name = name_ + "_" + suffix + "_point";
  Value point = empty_table(at);
  point.entries.push_back({"name", at.span, text_value(at, name)});
  point.entries.push_back({"position", at.span, text_value(at, core.centre)});
  points_.push_back(std::move(point));
  begin(at, suffix).entries.push_back({"holonomic", at.span, text_value(at, height_above(f, name))});
}

void ContactTable::points(const Value& value) {
  if (!value.is(Value::Kind::table) || value.entries.empty())
    fail(value, "has no points", "write points = { heel = \"<vector from the centre of mass>\", toe = \"..\" }");
  for (const Entry& entry : value.entries) add_point(entry.value, entry.key, vector(entry.value, "a point"));
}

void ContactTable::corners(const Value& value) {
  const std::vector<Value>& edges = list(value, "the edges");
  if (edges.size() != 3)
    fail(value, fmt::format("gives {} edges", edges.size()),
         "write corners = [\"a\", \"b\", \"c\"], the lengths along e1, e2, e3");
  const std::string name = body().text;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    std::string arm;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool positive = (corner >> (2 - k) & 1) != 0;
      arm += fmt::format("{}{}/2*{}.e{}", positive ? (k == 0 ? "" : " + ") : (k == 0 ? "-" : " - "),
                         length(edges[k], "an edge"), name, k + 1);
    }
    add_point(value, std::to_string(corner + 1), arm);
  }
}

std::string ContactTable::normal_of(const Value& on) const {
  if (on.is(Value::Kind::text) && on.text == "ground") return "E3";
  const Value* normal = on.is(Value::Kind::table) ? on.find("normal") : nullptr;
  if (normal == nullptr)
    fail(on, "has a shape, which touches planes", "write on = \"ground\", or on = { point = \"..\", normal = \"..\" }");
  return "unit(" + vector(*normal, "the normal") + ")";
}

std::pair<const BodyShape*, std::vector<std::string>> ContactTable::sizes_of(const Value& value) const {
  const BodyShape& kind = kind_of(value, body_shapes(), "shape");
  if (value.entries.size() != 1)
    fail(value, "has a shape with several kinds", fmt::format("write {{ {} = .. }} alone", kind.name));
  const Value& given = *value.find(kind.name);
  std::vector<std::string> sizes;
  if (kind.sizes.size() == 1) {
    sizes.push_back(length(given, fmt::format("the {}", kind.sizes[0])));
  } else {
    const std::vector<Value>& items = list(given, fmt::format("the sizes of the {}", kind.name));
    if (items.size() != kind.sizes.size())
      fail(given, fmt::format("gives {} sizes of the {}", items.size(), kind.name),
           fmt::format("write {} = [{}]", kind.name, fmt::join(kind.sizes, ", ")));
    for (std::size_t k = 0; k < items.size(); ++k)
      sizes.push_back(length(items[k], fmt::format("the {}", kind.sizes[k])));
  }
  return {&kind, sizes};
}

Core ContactTable::core_of(const Value& value, const std::string& body) const {
  const auto [kind, sizes] = sizes_of(value);
  if (kind->core == nullptr)
    fail(value, fmt::format("has a {}, which touches planes only", kind->name),
         "write a sphere, a disk or a capsule, or points of the body");
  return kind->core(body, sizes);
}

void ContactTable::shape(const Value& value) {
  if (!is_on_plane()) return add_core(value, "1", core_of(value, body().text));
  const auto [kind, sizes] = sizes_of(value);
  const std::string normal = normal_of(on());
  std::size_t count = 0;
  for (const std::string& point : kind->points(body().text, sizes, normal))
    add_point(value, std::to_string(++count), point);
}

std::vector<std::string> ContactTable::values_of(const Value& on, const Obstacle& kind) const {
  const Value& size = *on.find(kind.name);
  const std::string what = fmt::format("the {}", kind.name);
  std::vector<std::string> values{kind.is_round ? length(size, what) : expression(size, what)};
  for (const char* key : kind.further) {
    const Value* further = on.find(key);
    if (further == nullptr) fail(on, fmt::format("has no {}", key), fmt::format("add {} = \"..\"", key));
    values.push_back(vector(*further, fmt::format("the {}", key)));
  }
  for (const Entry& entry : on.entries) {
    const bool known =
        entry.key == kind.name || std::find(kind.further.begin(), kind.further.end(), entry.key) != kind.further.end();
    if (!known)
      source_.fail(entry.span, fmt::format("a {} in contact has no key {}", kind.name, quote(entry.key)),
                   kind.further.empty() ? "remove it"
                                        : fmt::format("its keys are {}, {}", kind.name, fmt::join(kind.further, ", ")));
  }
  return values;
}

}  // namespace eomgen::model
