// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts whose nearest points have no closed form: coordinates without inertia follow the nearest point, by
// holonomic constraints. One more coordinate, with the range (0, inf), is the condition that the point is nearest among
// its neighbours: a run ends where it is no longer.
#include <fmt/format.h>

#include <string>

#include "model/contact_table.hpp"

namespace eomgen::model {
namespace {

/// f, its slopes and the normal at the foot (x, y) of a surface z = f(x, y).
struct Foot {
  std::string x, y, f, slope_x, slope_y, square;

  Foot(const std::string& surface, const std::string& name) : x(name + "_x"), y(name + "_y") {
    f = "(" + at_position(surface, x, y) + ")";
    slope_x = fmt::format("diff({}, {})", f, x);
    slope_y = fmt::format("diff({}, {})", f, y);
    square = fmt::format("(1 + {}^2 + {}^2)", slope_x, slope_y);
  }
  std::string position() const { return fmt::format("({}*E1 + {}*E2 + {}*E3)", x, y, f); }
  std::string normal() const { return fmt::format("(E3 - {}*E1 - {}*E2)/sqrt({})", slope_x, slope_y, square); }
  /// Whether both radii of curvature of the hollow are larger than R: I + R dN/d(x, y) has positive eigenvalues. Their
  /// product.
  std::string room(const std::string& R) const {
    const auto slope = [&](const std::string& of, const std::string& by) {
      return fmt::format("{}*diff({}/sqrt({}), {})", R, of, square, by);
    };
    const std::string xx = slope(slope_x, x), yy = slope(slope_y, y);
    return fmt::format("if({0} + {1} < 2, (1 - {0})*(1 - {1}) - {2}*{3}, -1)", xx, yy, slope(slope_x, y),
                       slope(slope_y, x));
  }
};

Value list_of(const Value& at, const std::vector<std::string>& texts) {
  Value list;
  list.kind = Value::Kind::array;
  list.span = at.span;
  list.begin = at.begin;
  for (const std::string& text : texts) list.items.push_back(text_value(at, text));
  return list;
}

/// A point of the rim, at an angle from e1.
std::string on_rim(const Core& disk, const std::string& body, const std::string& cosine, const std::string& sine) {
  return fmt::format("({0} + {1}*({2}*{3}.e1 + {4}*{3}.e2))", disk.centre, disk.size, cosine, body, sine);
}

}  // namespace

void ContactTable::follow(const Value& at, const std::string& name, const std::vector<std::string>& equations,
                          const std::string& room) {
  Value coordinate = empty_table(at);
  coordinate.entries.push_back({"range", at.span, list_of(at, {"0", "inf"})});
  coordinates_.push_back({name + "_room", at.span, std::move(coordinate)});
  const auto add = [&](const char* suffix, Value psi) {
    Value constraint = empty_table(at);
    constraint.entries.push_back({"name", at.span, text_value(at, name + suffix)});
    constraint.entries.push_back({"holonomic", at.span, std::move(psi)});
    constraints_.push_back(std::move(constraint));
  };
  add("_nearest", equations.size() == 1 ? text_value(at, equations[0]) : list_of(at, equations));
  add("_near", text_value(at, fmt::format("{}_room - ({})", name, room)));
}

void ContactTable::stop_below(const Value& at, const std::string& name, const std::vector<std::string>& heights,
                              const std::string& limit) {
  Value event = empty_table(at);
  const auto put = [&](const char* key, const std::string& text) {
    event.entries.push_back({key, at.span, text_value(at, text)});
  };
  put("name", name);
  put("when", fmt::format("min({}) - {}", fmt::join(heights, ", "), limit));
  put("direction", "down");
  put("action", "stop");
  events_.push_back(std::move(event));
}

void ContactTable::foot_of(const Value& at, const std::string& name, const std::string& f) {
  const Foot foot(f, name);
  Value position = empty_table(at), point = empty_table(at);
  position.entries.push_back({"cartesian", at.span, list_of(at, {foot.x, foot.y, foot.f})});
  point.entries.push_back({"name", at.span, text_value(at, name + "_foot")});
  point.entries.push_back({"position", at.span, std::move(position)});
  points_.push_back(std::move(point));
}

// Points of the ball at two angles from its lowest point: a second contact, where the surface is narrower than the
// ball.
void ContactTable::stop_beside(const Value& at, const std::string& name, const Core& ball, const std::string& f) {
  std::vector<std::string> heights;
  for (const char* angle : {"pi/7", "pi/3"}) {
    for (int k = 0; k < 8; ++k)
      heights.push_back(height_above(f, fmt::format("({0} + {1}*(sin({2})*(cos({3}*pi/4)*E1 + sin({3}*pi/4)*E2) - "
                                                    "cos({2})*E3))",
                                                    ball.centre, ball.radius, angle, k)));
  }
  stop_below(at, name, heights, fmt::format("(-0.02*{})", ball.radius));
}

// The ball is R N above its foot S in the plane of E1 and E2; the gap is along N where that holds, as B - S = R N + g
// E3.
void ContactTable::ball_on_surface(const Value& at, const std::string& suffix, const Core& ball, const std::string& f) {
  const std::string name = name_ + "_" + suffix;
  const Foot foot(f, name);
  foot_of(at, name, f);
  stop_beside(at, name + "_beside", ball, f);
  const auto beside = [&](const char* axis) {
    return fmt::format("dot({0} - {1} - {2}*{3}, {4})", ball.centre, foot.position(), ball.radius, foot.normal(), axis);
  };
  follow(at, name, {beside("E1"), beside("E2")}, foot.room(ball.radius));
  Names names;
  const std::string S = names(foot.position()), n = names(foot.normal());
  const Nearest nearest{fmt::format("dot({} - {}, {}) - {}", ball.centre, S, n, ball.radius), n,
                        fmt::format("({} - {}*{})", ball.centre, ball.radius, n), S};
  const Value surface = text_value(at, at_position(f, ball.radius, ball.radius));
  add_nearest(at, suffix, body(), on(), nearest, names, {surface});
}

void ContactTable::capsule_on_surface(const Value& at, const Core& capsule, const std::string& f) {
  std::vector<std::string> heights;
  const auto point = [&](const char* share) {
    return fmt::format("({} + {}*{}*{})", capsule.centre, share, capsule.size, capsule.axis);
  };
  for (const char* share : {"(-1/4)", "0", "1/4"}) heights.push_back(height_above(f, point(share)));
  stop_below(at, name_ + "_between", heights, capsule.radius);
  ball_on_surface(at, "1", {Core::Kind::point, point("1/2"), capsule.radius, "", ""}, f);
  ball_on_surface(at, "2", {Core::Kind::point, point("(-1/2)"), capsule.radius, "", ""}, f);
}

// The angle of the nearest point of a rim: there the gap has no slope along the rim, and a positive second one.
void ContactTable::rim(const Value& at, const Core& disk, const Approach& approach, const std::vector<Value>& at_rest,
                       const std::vector<std::string>& through_face) {
  const std::string name = name_ + "_1", phi = name + "_phi";
  const auto point = [&](const std::string& cosine, const std::string& sine) {
    return Core{Core::Kind::point, on_rim(disk, body().text, cosine, sine), "0", "", ""};
  };
  const Core nearest = point("cos(" + phi + ")", "sin(" + phi + ")");
  Value angle = empty_table(at);
  angle.generated = true;
  angle.entries.push_back({"unit", at.span, text_value(at, "rad")});
  coordinates_.push_back({phi, at.span, std::move(angle)});
  Names inlined{true}, names;
  std::vector<std::string> gaps = through_face;
  for (int k = 0; k < 8; ++k)
    gaps.push_back(approach(point(fmt::format("cos({}*pi/4)", k), fmt::format("sin({}*pi/4)", k)), inlined)[0].gap);
  stop_below(at, name_ + "_beside", gaps, fmt::format("(-0.02*{})", disk.size));
  const std::string slope = fmt::format("diff({}, {})", approach(nearest, inlined)[0].gap, phi);
  follow(at, name, {slope}, fmt::format("diff({}, {})/{}", slope, phi, disk.size));
  add_nearest(at, "1", body(), on(), approach(nearest, names)[0], names, at_rest);
}

void ContactTable::rim_on_surface(const Value& at, const Core& disk, const std::string& f) {
  const std::string name = name_ + "_1";
  foot_of(at, name, f);
  const Foot foot(f, name);
  const std::string P = on_rim(disk, body().text, "cos(" + name + "_phi)", "sin(" + name + "_phi)");
  Value constraint = empty_table(at);
  constraint.entries.push_back({"name", at.span, text_value(at, name + "_under")});
  constraint.entries.push_back(
      {"holonomic", at.span,
       list_of(at, {fmt::format("dot({}, E1) - {}", P, foot.x), fmt::format("dot({}, E2) - {}", P, foot.y)})});
  constraints_.push_back(std::move(constraint));
  const auto approach = [&](const Core& point, Names& names) -> std::vector<Nearest> {
    if (names.inlined) return {{"(" + height_above(f, point.centre) + ")", "", "", ""}};
    const std::string S = names(foot.position()), n = names(foot.normal()), p = names(point.centre);
    return {{fmt::format("dot({} - {}, {})", p, S, n), n, p, S}};
  };
  std::vector<std::string> heights{height_above(f, disk.centre)};
  for (int k = 0; k < 8; ++k) {
    const auto half = [k](const char* function) { return fmt::format("{}({}*pi/4)/2", function, k); };
    heights.push_back(height_above(f, on_rim(disk, body().text, half("cos"), half("sin"))));
  }
  rim(at, disk, approach, {text_value(at, at_position(f, disk.size, disk.size))}, heights);
}

}  // namespace eomgen::model
