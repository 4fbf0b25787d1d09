// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the values of the keys of a force, and defines the names that the formulas of its kind may use.
#include <fmt/format.h>

#include <algorithm>

#include "model/read_forces.hpp"

namespace eomgen::model {
namespace {

using forces::ValueType;

Dependencies allowed(forces::Dependency dependency) {
  switch (dependency) {
    case forces::Dependency::time: return on_time;
    case forces::Dependency::motion: return on_motion;
    case forces::Dependency::state: break;
  }
  return on_force_variables;
}

}  // namespace

void ForcesReader::store_argument(ForceDraft& open, const std::string& name, const TypedNode& typed,
                                  std::uint32_t index) {
  open.force.arguments.push_back({name, typed.node, index});
  TypedNode known = typed;  // its unit has been checked, the formula's is not
  known.dimension = std::nullopt;
  known.has_uncertain_dimension = false;
  open.local[name] = known;
}

Context ForcesReader::context(const ForceDraft& open, const forces::Key& key, Shape shape) const {
  const bool itself = open.kind.form == forces::InputFormat::value && key.name == open.kind.name;
  Context result;
  result.what = !key.what.empty() ? key.what
                : !itself         ? fmt::format("the {} of {}", key.name, open.what)
                : open.named      ? fmt::format("the {} {}", open.kind.name, open.what)
                                  : open.what;
  result.allowed = allowed(key.dependency);
  result.shape = shape;
  if (!key.unit.empty()) result.dimension = dimension_of(key.unit);
  result.remedy = key.remedy;
  return result;
}

void ForcesReader::read_value(ForceDraft& open, const forces::Key& key, const Value& value) {
  const std::string quoted = fmt::format("'{}' of {}", key.name, open.what);
  switch (key.type) {
    case ValueType::scalar:
      return store_argument(open, key.name, resolver_.value(value, context(open, key, Shape::scalar)));
    case ValueType::vector:
      return store_argument(open, key.name, resolver_.value(value, context(open, key, Shape::vector)));
    case ValueType::triple: return read_triple(open, key, value);
    case ValueType::point: return store_argument(open, key.name, point(value, context(open, key, Shape::vector).what));
    case ValueType::points:
    case ValueType::ends: return read_pair(open, key, value);
    case ValueType::place: {
      const std::uint32_t index = require_place(value, quoted);
      return store_argument(open, key.name, resolver_.place(index, value.span), index);
    }
    case ValueType::frame: {
      const std::uint32_t index = require_frame(value, quoted);
      if (index == 0)
        source_.fail(value.span, fmt::format("a {} on the ground changes nothing", open.kind.name),
                     "name a body or frame");
      open.force.arguments.push_back({key.name, no_node, index});
      return;
    }
    case ValueType::body: return read_body(open, key, value);
    case ValueType::bodies: return read_bodies(open, key, value);
    case ValueType::energy: return read_energy(open, key, value);
    case ValueType::choice: return read_choice(open, key, value);
  }
}

// A single value applies to all three components.
void ForcesReader::read_triple(ForceDraft& open, const forces::Key& key, const Value& value) {
  const Context entry = context(open, key, Shape::scalar);
  const bool three = value.is(Value::Kind::array);
  if (three && value.items.size() != 3) {
    source_.fail(
        value.span, fmt::format("{} has {} entries", entry.what, value.items.size()),
        fmt::format("write {0} = [\"..\", \"..\", \"..\"], along three axes, or {0} = \"..\" for all", key.name));
  }
  TypedNode all;
  if (!three) all = resolver_.value(value, entry);
  for (std::size_t k = 0; k < 3; ++k)
    store_argument(open, fmt::format("{}{}", key.name, k + 1), three ? resolver_.value(value.items[k], entry) : all);
  open.force.arguments.push_back({key.name, no_node, 0});
}

void ForcesReader::read_pair(ForceDraft& open, const forces::Key& key, const Value& value) {
  const bool ends = key.type == ValueType::ends;
  const std::string remedy = fmt::format("write {} = {} with particles, points, \"origin\" or vectors", key.name,
                                         ends ? "[\"P\", \"Q\"]" : "[\"point of A\", \"point of B\"]");
  require_kind(Value::Kind::array, value, fmt::format("'{}'", key.name), remedy);
  if (value.items.size() != 2)
    source_.fail(value.span, fmt::format("'{}' has {} entries", key.name, value.items.size()), remedy);
  const auto& items = value.items;
  if (ends && items[0].is(Value::Kind::text) && items[1].is(Value::Kind::text) && items[0].text == items[1].text)
    source_.fail(value.span, fmt::format("both ends of {} are the same point", open.what), remedy);
  const std::string what = ends ? fmt::format("an end of {}", open.what) : fmt::format("a point of {}", open.what);
  store_argument(open, ends ? "a" : "rA", point(items[0], what));
  store_argument(open, ends ? "b" : "rB", point(items[1], what));
}

void ForcesReader::read_body(ForceDraft& open, const forces::Key& key, const Value& value) {
  const std::uint32_t frame = require_frame(value, fmt::format("'{}' of {}", key.name, open.what));
  const auto body = std::find_if(model_.bodies.begin(), model_.bodies.end(),
                                 [&](const Body& candidate) { return candidate.frame == frame; });
  if (body == model_.bodies.end())
    source_.fail(value.span, fmt::format("{} acts on a body, and '{}' has no mass", open.what, value.text),
                 "name a [[body]]");
  open.force.arguments.push_back({key.name, no_node, static_cast<std::uint32_t>(body - model_.bodies.begin())});
  for (auto& [name, typed] : mass_names(body->place, body->mass, "", value.span)) open.local[name] = typed;
  open.local["w"] = resolver_.angular_velocity(frame, value.span);
}

void ForcesReader::read_bodies(ForceDraft& open, const forces::Key& key, const Value& value) {
  const std::string remedy = fmt::format("write {} = [\"A\", \"B\"]; one of them may be \"ground\"", key.name);
  require_kind(Value::Kind::array, value, fmt::format("'{}' of {}", key.name, open.what), remedy);
  if (value.items.size() != 2)
    source_.fail(value.span, fmt::format("'{}' has {} entries", key.name, value.items.size()), remedy);
  std::array<std::uint32_t, 2> frames{};
  for (std::size_t k = 0; k < 2; ++k) {
    frames[k] = require_frame(value.items[k], fmt::format("'{}' of {}", key.name, open.what));
    const std::string letter = k == 0 ? "A" : "B";
    open.force.arguments.push_back({letter, no_node, frames[k]});
    for (std::size_t axis = 0; axis < 3; ++axis)
      open.local[fmt::format("{}{}", letter, axis + 1)] = resolver_.own_axis(frames[k], axis, value.items[k].span);
    open.local["w" + letter] = frames[k] == 0
                                   ? resolver_.text("0*E1", {}, value.span, {"0", 0, Shape::vector, std::nullopt, ""})
                                   : resolver_.angular_velocity(frames[k], value.items[k].span);
  }
  if (frames[0] == frames[1])
    source_.fail(value.span, fmt::format("{} is between '{}' and itself", open.what, value.items[0].text), remedy);
}

void ForcesReader::read_energy(ForceDraft& open, const forces::Key& key, const Value& value) {
  if (const Symbol* other = scope_.find("extension")) {
    source_.fail(value.span,
                 "'extension' means the extension of this spring here, and it is also declared in the model",
                 fmt::format("rename {} 'extension' of line {}", model::kind_name(other->kind), other->span.line));
  }
  const TypedNode extension = resolver_.extension(value.span);
  store_argument(open, key.name,
                 resolver_.value_with_names(value, {{"extension", extension}}, context(open, key, Shape::scalar)));
}

void ForcesReader::read_choice(ForceDraft& open, const forces::Key& key, const Value& value) {
  std::vector<std::string> texts;
  for (const forces::Choice& choice : key.choices) texts.push_back(fmt::format("{} = {}", key.name, choice.text));
  const std::string remedy = fmt::format("write {}", fmt::join(texts, " or "));
  const bool written = value.is(Value::Kind::integer) || value.is(Value::Kind::text);
  const auto found = std::find_if(key.choices.begin(), key.choices.end(),
                                  [&](const forces::Choice& choice) { return written && choice.text == value.text; });
  if (found == key.choices.end()) {
    source_.fail(value.span, fmt::format("{} has no {} {}", open.kind.name, key.name, quote(value.text)), remedy);
  }
  if (!found->body_requirement.empty() && model_.bodies.empty()) {
    source_.fail(value.span,
                 fmt::format("{} of {} {} {}, and the model has none", open.kind.name, key.name, found->text,
                             found->body_requirement),
                 "write " + texts.front());
  }
  open.force.arguments.push_back({key.name, no_node, static_cast<std::uint32_t>(found - key.choices.begin())});
}

}  // namespace eomgen::model
