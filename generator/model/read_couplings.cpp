// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/read_couplings.hpp"

#include <fmt/format.h>

namespace eomgen::model {
namespace {

std::string form(std::string_view kind) {
  return fmt::format(
      "write {0} = {{ bodies = [\"A\", \"B\"], axes = [\"A.e3\", \"B.e3\"], ratio = \"-2\" }}, or {0} = {{ angles = "
      "[\"phi\", \"psi\"], ratio = \"-2\" }}; a ratio is the first speed over the second",
      kind);
}

}  // namespace

const Entry* CouplingsReader::find_coupling(const Value& table) const {
  for (const Entry& entry : table.entries) {
    if (couplings::find(entry.key) != nullptr) return &entry;
  }
  return nullptr;
}

TypedNode CouplingsReader::relative_angular_velocity(std::uint32_t frame, Span span) {
  if (frame > 0) return resolver_.angular_velocity(frame, span);
  return resolver_.check_context(resolver_.number(0, span), span, {"the ground", 0, Shape::vector, std::nullopt, ""});
}

RotationCoupling CouplingsReader::between_bodies(const Value& table, const std::string& what,
                                                 std::map<std::string, TypedNode>& local) {
  const Value& bodies = *table.find("bodies");
  const std::string remedy = "write bodies = [\"A\", \"B\"]; one of them may be \"ground\"";
  require_kind(Value::Kind::array, bodies, fmt::format("'bodies' of {}", what), remedy);
  if (bodies.items.size() != 2)
    source_.fail(bodies.span, fmt::format("{} is between {} bodies", what, bodies.items.size()), remedy);
  RotationCoupling coupled;
  std::array<std::uint32_t, 3>& frames = coupled.frames;  // A, B, carrier
  for (std::size_t k = 0; k < 2; ++k) frames[k] = require_frame(bodies.items[k], fmt::format("'bodies' of {}", what));
  const Value* carrier = table.find("carrier");
  if (carrier != nullptr) frames[2] = require_frame(*carrier, fmt::format("'carrier' of {}", what));
  if (frames[0] == frames[1])
    source_.fail(bodies.span, fmt::format("{} is between '{}' and itself", what, bodies.items[0].text), remedy);
  for (std::size_t k = 0; k < 2; ++k) {
    if (frames[k] != frames[2]) continue;
    source_.fail(carrier != nullptr ? carrier->span : bodies.items[k].span,
                 fmt::format("'{}' does not turn against the carrier of {}", bodies.items[k].text, what),
                 carrier != nullptr ? "the carrier is a third body, or the ground, on which both turn"
                                    : "add carrier = \"C\", the body on which both turn; it is the ground if left out");
  }
  const Value& axes =
      require_value(table, "axes", what, "add axes = [\"A.e3\", \"B.e3\"], the axes about which they turn");
  const bool two = axes.is(Value::Kind::array) && axes.items.size() == 2;
  if (axes.is(Value::Kind::array) && !two && axes.items.size() != 3)
    source_.fail(axes.span, fmt::format("'axes' of {} has {} entries", what, axes.items.size()),
                 "write axes = [\"axis of A\", \"axis of B\"], or one vector for both");
  const Context direction{fmt::format("an axis of {}", what), on_motion, Shape::vector, std::nullopt,
                          "it is made of axes of bodies, E1, E2, E3 and parameters"};
  const Span span = table.span;
  for (std::size_t k = 0; k < 2; ++k) {
    const Value& axis = two ? axes.items[k] : axes;
    local[k == 0 ? "a" : "b"] = resolver_.unit_of_vector(resolver_.value(axis, direction), axis.span);
    const std::map<std::string, TypedNode> speeds{{"w", relative_angular_velocity(frames[k], span)},
                                                  {"c", relative_angular_velocity(frames[2], span)}};
    local[k == 0 ? "wA" : "wB"] =
        resolver_.text("w - c", speeds, span, {what, on_anything, Shape::vector, std::nullopt, ""});
    coupled.axes[k] = local[k == 0 ? "a" : "b"].node;
  }
  return coupled;
}

void CouplingsReader::read(Constraint& constraint, const Entry& entry) {
  const couplings::Coupling& kind = *couplings::find(entry.key);
  const std::string what = fmt::format("the {} '{}'", kind.name, constraint.name);
  const Value& table = require_kind(Value::Kind::table, entry.value, what, form(kind.name));
  check_keys(table, {what, {"bodies", "axes", "carrier", "angles", "ratio"}});
  const Value *bodies = table.find("bodies"), *angles = table.find("angles");
  if (bodies == nullptr && angles == nullptr)
    source_.fail(table.span, fmt::format("{} has neither bodies nor angles", what), form(kind.name));
  for (const char* other : {"bodies", "axes", "carrier"}) {
    if (angles == nullptr || table.find(other) == nullptr) continue;
    source_.fail(key_span(table, other), fmt::format("{} has both angles and {}", what, other),
                 "keep the angles, or bodies and axes");
  }
  std::map<std::string, TypedNode> local;
  if (bodies != nullptr) constraint.coupled = between_bodies(table, what, local);
  if (angles != nullptr) {
    const std::string remedy = "write angles = [\"phi\", \"psi\"], two expressions of coordinates";
    require_kind(Value::Kind::array, *angles, fmt::format("'angles' of {}", what), remedy);
    if (angles->items.size() != 2)
      source_.fail(angles->span, fmt::format("{} is between {} angles", what, angles->items.size()), remedy);
    for (std::size_t k = 0; k < 2; ++k) {
      const Context angle{fmt::format("an angle of {}", what), on_motion, Shape::scalar, dimension_of("rad"),
                          "an angle is made of coordinates, functions of time, parameters and t"};
      local[fmt::format("angle{}", k + 1)] = resolver_.value(angles->items[k], angle);
    }
  }
  const Value& ratio = require_value(table, "ratio", what,
                                     "add ratio = \"-2\", the first speed over the second; of a belt it is positive");
  const Context number{fmt::format("the ratio of {}", what), on_motion, Shape::scalar, dimension_of("1"),
                       "a ratio is made of numbers, parameters, coordinates and t"};
  local["ratio"] = resolver_.value(ratio, number);
  if (constraint.coupled) constraint.coupled->ratio = local["ratio"].node;
  const auto& constant = local["ratio"].constant;
  if (constant && cln::zerop(*constant))
    resolver_.refuse_value(local["ratio"], ratio.span, number.what,
                           "is 0, which holds the first and leaves the second free", "give a ratio that is not 0");
  const TypedNode psi = resolver_.text(bodies != nullptr ? kind.body_equation : kind.angle_equation, local, table.span,
                                       {what, on_anything, Shape::scalar, std::nullopt, ""});
  if ((psi.dependencies & on_velocity) == 0 && resolver_.coordinates_in(psi.node).empty())
    source_.fail(table.span, fmt::format("{} binds nothing that moves", what), form(kind.name));
  constraint.velocity = true;
  constraint.psi.push_back(psi.node);
}

}  // namespace eomgen::model
