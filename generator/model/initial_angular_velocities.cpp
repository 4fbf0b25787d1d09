// SPDX-License-Identifier: GPL-3.0-or-later
// Initial values of rotations: Euler parameters that a scene omits, and "B.omega".
#include <fmt/format.h>

#include <algorithm>

#include "model/read_bodies.hpp"

namespace eomgen::model {

// Omitted Euler parameters e1, e2, e3 are 0, and an omitted e0 follows from the unit norm.
void BodiesReader::complete_parameters(Scene& scene) {
  for (const Frame& frame : model_.frames) {
    const rotations::Rotation* rotation = rotations::find(frame.rotation);
    if (rotation == nullptr || rotation->unit.empty()) continue;
    const auto given = [&](std::size_t k) {
      const std::uint32_t coordinate = model_.arena[frame.entries[k]].index;
      const auto same = [&](const InitialValue& v) { return v.coordinate == coordinate && v.order == 0; };
      return std::any_of(scene.initial.begin(), scene.initial.end(), same) ||
             std::any_of(scene.guess.begin(), scene.guess.end(), same);
    };
    if (given(0)) continue;
    const auto add = [&](std::vector<InitialValue>& values, std::size_t k, const Rational& value) {
      values.push_back({model_.arena[frame.entries[k]].index, 0, resolver_.number(value, scene.span).node, scene.span});
    };
    const bool none = !given(1) && !given(2) && !given(3);
    for (std::size_t k = 1; k < 4; ++k) {
      if (!given(k)) add(scene.initial, k, 0);
    }
    add(none ? scene.initial : scene.guess, 0, 1);
  }
}

// "B.omega" = [..]; false for any other key.
bool BodiesReader::read_initial_angular_velocity(Scene& scene, const Entry& entry, bool guess) {
  const bool nested = entry.value.is(Value::Kind::table) && entry.value.find("omega") != nullptr;
  if (nested)
    source_.fail(entry.span, "the key of an angular velocity has a dot in it",
                 fmt::format("write it in quotes: \"{}.omega\" = [..]", entry.key));
  constexpr std::string_view ending = ".omega";
  if (!entry.key.ends_with(ending)) return false;
  Value name;
  name.kind = Value::Kind::text;
  name.text = entry.key.substr(0, entry.key.size() - ending.size());
  name.span = entry.span;
  const std::string remedy = fmt::format("write \"{}\" = [w1, w2, w3], along the axes of the body", entry.key);
  if (guess) source_.fail(entry.span, "an angular velocity cannot be guessed", "give it in 'initial'");
  InitialAngularVelocity rotation{require_frame(name, "a key of 'initial'"), {}, entry.span};
  if (rotation.frame == 0) source_.fail(entry.span, "the ground does not turn", "name a body or frame");
  require_kind(Value::Kind::array, entry.value, fmt::format("'{}'", entry.key), remedy);
  if (entry.value.items.size() != 3)
    source_.fail(entry.value.span, fmt::format("'{}' has {} entries", entry.key, entry.value.items.size()), remedy);
  for (std::size_t k = 0; k < 3; ++k) {
    rotation.value[k] =
        resolver_
            .value(entry.value.items[k],
                   {fmt::format("a component of '{}'", entry.key), on_time, Shape::scalar, dimension_of("rad/s"),
                    "it is made of numbers, parameters and functions at the start"})
            .node;
  }
  scene.rotations.push_back(rotation);
  return true;
}

// An angular velocity replaces the rates of the body's own angles.
void BodiesReader::check_initial_angular_velocities(const Scene& scene) const {
  for (const InitialAngularVelocity& rotation : scene.rotations) {
    const Frame& frame = model_.frames[rotation.frame];
    for (const NodeId entry : frame.entries) {
      const Node& node = model_.arena[entry];
      if (node.op == Op::coordinate && std::find(scene.solve.begin(), scene.solve.end(),
                                                 std::pair(node.index, std::uint8_t{1})) != scene.solve.end())
        source_.fail(rotation.span,
                     fmt::format("'{}_dot' in 'solve' follows from '{}.omega', which stays as it is given",
                                 model_.coordinates[node.index].name, frame.name),
                     "give the rates of its angles in place of it, or take them out of 'solve'");
      for (const InitialValue& initial : scene.initial) {
        if (node.op != Op::coordinate || initial.order != 1 || initial.coordinate != node.index) continue;
        source_.fail(initial.span,
                     fmt::format("'{}_dot' is given, and it follows from '{}.omega' of this scene",
                                 model_.coordinates[node.index].name, frame.name),
                     "keep one of them");
      }
    }
  }
}

}  // namespace eomgen::model
