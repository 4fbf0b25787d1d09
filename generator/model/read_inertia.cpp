// SPDX-License-Identifier: GPL-3.0-or-later
// inertia = { principal = [A, B, C] }, [[..], [..], [..]], "J", or a homogeneous shape: about the centre of mass, along
// the axes of the body.
#include "model/read_inertia.hpp"

#include <fmt/format.h>

namespace eomgen::model {
namespace {

constexpr const char* inertia_form =
    "write inertia = { principal = [\"A\", \"B\", \"C\"] }, a symmetric [[..], [..], [..]], or a shape such as { "
    "sphere = \"R\" }";

struct Shape3 {
  std::string_view key;
  std::vector<std::string_view> lengths;
  std::array<std::string_view, 3> moments;
};
const std::vector<Shape3>& shapes() {
  static const std::vector<Shape3> all{
      {"sphere", {"R"}, {"2*m*R^2/5", "2*m*R^2/5", "2*m*R^2/5"}},
      {"cylinder", {"R", "L"}, {"m*(3*R^2 + L^2)/12", "m*(3*R^2 + L^2)/12", "m*R^2/2"}},
      {"disk", {"R"}, {"m*R^2/4", "m*R^2/4", "m*R^2/2"}},
      {"rod", {"L"}, {"m*L^2/12", "m*L^2/12", "0"}},
      {"box", {"a", "b", "c"}, {"m*(b^2 + c^2)/12", "m*(a^2 + c^2)/12", "m*(a^2 + b^2)/12"}},
  };
  return all;
}

Context moment_context(const std::string& what) {
  return {what, 0, Shape::scalar, dimension_of("kg*m^2"), "an inertia is made of numbers and parameters"};
}

}  // namespace

void InertiaReader::read(Body& body, const Value& table) {
  const std::string what = fmt::format("the inertia of '{}'", model_.frames[body.frame].name);
  const Value& value =
      require_value(table, "inertia", fmt::format("'{}'", model_.frames[body.frame].name), inertia_form);
  const NodeId zero = resolver_.number(0, value.span).node;
  for (auto& row : body.inertia) row = {zero, zero, zero};
  if (value.is(Value::Kind::array)) {
    const auto square = [&] {
      if (value.items.size() != 3) return false;
      for (const Value& row : value.items)
        if (!row.is(Value::Kind::array) || row.items.size() != 3) return false;
      return true;
    };
    if (!square())
      source_.fail(value.span, fmt::format("{} is not an array of three rows of three", what), inertia_form);
    std::array<std::array<TypedNode, 3>, 3> J;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        J[i][k] = resolver_.value(value.items[i].items[k], moment_context("an entry of " + what));
        body.inertia[i][k] = J[i][k].node;
        if (k >= i) continue;
        const bool same = J[i][k].constant && J[k][i].constant
                              ? *J[i][k].constant == *J[k][i].constant
                              : value.items[i].items[k].text == value.items[k].items[i].text;
        if (!same)
          source_.fail(value.items[i].items[k].span, fmt::format("{} is not symmetric", what),
                       "write the same expression on both sides of the diagonal");
        body.inertia[i][k] = body.inertia[k][i];
      }
    }
    return;
  }
  if (!value.is(Value::Kind::table)) return read_scalar_inertia(body, value);
  Keys keys{what, {"principal"}};
  for (const Shape3& shape : shapes()) keys.known.push_back(shape.key);
  check_keys(value, keys);
  if (value.entries.size() != 1) {
    source_.fail(value.span, fmt::format("{} is given in {} ways", what, value.entries.size()), inertia_form);
  }
  const Entry& entry = value.entries[0];
  const std::array<NodeId, 3> moments = shape_moments(body, entry);
  for (std::size_t k = 0; k < 3; ++k) body.inertia[k][k] = moments[k];
}

std::array<NodeId, 3> InertiaReader::shape_moments(const Body& body, const Entry& shape) {
  const std::string what = fmt::format("the inertia of '{}'", model_.frames[body.frame].name);
  std::array<NodeId, 3> result{};
  if (shape.key == "principal") {
    require_kind(Value::Kind::array, shape.value, "'principal'", inertia_form);
    if (shape.value.items.size() != 3)
      source_.fail(shape.value.span, fmt::format("'principal' has {} entries", shape.value.items.size()), inertia_form);
    std::array<TypedNode, 3> J;
    for (std::size_t k = 0; k < 3; ++k) {
      J[k] = resolver_.value(shape.value.items[k], moment_context("a principal moment"));
      if (J[k].constant && cln::minusp(*J[k].constant))
        resolver_.refuse_value(J[k], shape.value.items[k].span, "a moment of inertia", "is negative",
                               "it is a sum of masses times squares");
      result[k] = J[k].node;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &a = J[k].constant, &b = J[(k + 1) % 3].constant, &c = J[(k + 2) % 3].constant;
      if (!a || !b || !c || cln::zerop(*a) || cln::zerop(*b) || cln::zerop(*c) || *a <= *b + *c) continue;
      resolver_.refuse_value(J[k], shape.value.items[k].span, "a principal moment",
                             "is larger than the other two together, as that of no body",
                             "check the values and their units");
    }
    return result;
  }
  for (const Shape3& known : shapes()) {
    if (known.key != shape.key) continue;
    const bool one = known.lengths.size() == 1;
    const std::string remedy = one ? fmt::format("write {} = \"{}\"", known.key, known.lengths[0])
                                   : fmt::format("write {} = [\"{}\"]", known.key, fmt::join(known.lengths, "\", \""));
    if (!one) require_kind(Value::Kind::array, shape.value, fmt::format("'{}'", known.key), remedy);
    if (!one && shape.value.items.size() != known.lengths.size())
      source_.fail(shape.value.span, fmt::format("'{}' has {} entries", known.key, shape.value.items.size()), remedy);
    std::map<std::string, TypedNode> local;
    for (std::size_t k = 0; k < known.lengths.size(); ++k) {
      const Value& length = one ? shape.value : shape.value.items[k];
      const std::string part = fmt::format("a length in {}", what);
      const TypedNode given = resolver_.value(length, {part, 0, Shape::scalar, dimension_of("m"), ""});
      if (given.constant && cln::minusp(*given.constant))
        resolver_.refuse_value(given, length.span, part, "is negative", "a radius or an edge is 0 or more");
      local[std::string(known.lengths[k])] = given;
    }
    const Value& mass = *frame_sources_[body.frame].table->find("mass");
    local["m"] = resolver_.value(mass, {"a mass", 0, Shape::scalar, dimension_of("kg"), ""});
    for (std::size_t k = 0; k < 3; ++k)
      result[k] = resolver_.text(known.moments[k], local, shape.span, moment_context(what)).node;
  }
  return result;
}

// One moment of inertia suffices if the body rotates about a direction that is fixed in it and in space.
void InertiaReader::read_scalar_inertia(Body& body, const Value& value) {
  const Frame& frame = model_.frames[body.frame];
  const TypedNode J = resolver_.value(value, moment_context(fmt::format("the inertia of '{}'", frame.name)));
  if (J.constant && cln::minusp(*J.constant))
    resolver_.refuse_value(J, value.span, "a moment of inertia", "is negative", "it is a sum of masses times squares");
  const auto& axis = frame_sources_[body.frame].axis;
  if (!axis && frame_sources_[body.frame].keeps_attitude) return;  // it does not rotate: the moment has no effect
  if (!axis) {
    source_.fail(
        value.span,
        fmt::format("one moment of inertia is not enough: '{}' does not rotate about one fixed axis", frame.name),
        inertia_form);
  }
  // Only J r . r affects the motion, for the unit vector r of the axis: the matrix is J r r.
  const auto on = [&](std::size_t k) { return !axis->numbers || !cln::zerop((*axis->numbers)[k]); };
  const bool own = axis->numbers && on(0) + on(1) + on(2) == 1;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k <= i; ++k) {
      if (!on(i) || !on(k)) continue;
      const TypedNode entry =
          own ? J : resolver_.product_of(J, resolver_.product_of(axis->unit[i], axis->unit[k], value.span), value.span);
      body.inertia[i][k] = body.inertia[k][i] = entry.node;
    }
  }
}

}  // namespace eomgen::model
