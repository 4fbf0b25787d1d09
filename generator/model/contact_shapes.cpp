// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/contact_shapes.hpp"

namespace eomgen::model {
namespace {

// Added to squares of sines, which keeps parallel directions defined. Below it every point is as near as another up to
// rounding. A sum has no kink.
constexpr const char* added_square = "1e-14";

std::string clamp(const std::string& x, const Core& segment) {
  return fmt::format("max(-{1}/2, min({1}/2, {0}))", x, segment.size);
}
/// The point of a segment at the distance s from its centre.
std::string along(const Core& segment, const std::string& s) {
  return fmt::format("{} + {}*{}", segment.centre, s, segment.axis);
}
/// The part of v across a unit vector.
std::string across(const std::string& v, const std::string& unit) {
  return fmt::format("{0} - dot({0}, {1})*{1}", v, unit);
}

/// The point of a core that is nearest to a position.
std::string point_of(const Core& core, const std::string& position, Names& name) {
  if (core.kind == Core::Kind::point) return core.centre;
  const std::string d = name(fmt::format("{} - {}", position, core.centre));
  if (core.kind == Core::Kind::segment) return name(along(core, clamp(fmt::format("dot({}, {})", core.axis, d), core)));
  const std::string in_plane = name(across(d, core.axis));  // squares: the length has no slope above the centre
  return name(fmt::format("{0} + {1}*{2}/sqrt(max({2}^2, dot({1}, {1})))", core.centre, in_plane, core.size));
}

/// From the nearest points of both cores.
Nearest by_cores(const std::string& own, const std::string& other, const std::string& radius,
                 const std::string& other_radius, Names& name) {
  const std::string apart = name(fmt::format("{} - {}", own, other)), n = name(fmt::format("unit({})", apart));
  return {fmt::format("norm({}) - {} - {}", apart, radius, other_radius), n,
          fmt::format("({} - {}*{})", own, radius, n), fmt::format("({} + {}*{})", other, other_radius, n)};
}

/// The nearest points of the lines give s, then t and s are nearest to one another within the segments.
std::vector<Nearest> nearest_of_segments(const Core& a, const Core& b, Names& name) {
  const std::string d = name(fmt::format("{} - {}", a.centre, b.centre));
  const std::string along_u = name(fmt::format("dot({}, {})", a.axis, d));
  const std::string along_v = name(fmt::format("dot({}, {})", b.axis, d));
  const std::string cosine = name(fmt::format("dot({}, {})", a.axis, b.axis));
  const std::string both = name(fmt::format("cross({}, {})", a.axis, b.axis));
  const std::string on_lines =
      name(fmt::format("({0}*{1} - {2})/(dot({3}, {3}) + {4})", cosine, along_v, along_u, both, added_square));
  const std::string t = name(clamp(fmt::format("{}*{} + {}", cosine, clamp(on_lines, a), along_v), b));
  const std::string s = name(clamp(fmt::format("{}*{} - {}", cosine, t, along_u), a));
  return {by_cores(name(along(a, s)), name(along(b, t)), a.radius, b.radius, name)};
}

/// A cone as seen from a position p: w across the axis, of the length rho, and h along it.
struct Cone {
  std::string angle, apex, axis;

  std::string radial(const std::string& p, Names& name) const {
    return name(across(name(fmt::format("{} - {}", p, apex)), axis));
  }
  std::string height(const std::string& p) const { return fmt::format("dot({} - {}, {})", p, apex, axis); }
  /// The nearest point of the mantle or the tip. On the axis, where only the tip is nearest, rho has no slope: a length
  /// beside that of the shape keeps it defined.
  std::string foot(const std::string& p, const std::string& size, Names& name) const {
    const std::string w = radial(p, name), rho = name(fmt::format("sqrt(max(dot({0}, {0}), 1e-30*{1}^2))", w, size));
    return name(fmt::format("{0} + max(0, {1}*sin({2}) + {3}*cos({2}))*({4}*sin({2})/{1} + cos({2})*{5})", apex, rho,
                            angle, height(p), w, axis));
  }
};

}  // namespace

std::string Names::operator()(const std::string& expression) {
  if (inlined) return "(" + expression + ")";
  named.emplace_back(fmt::format("nearest_{}", named.size() + 1), expression);
  return named.back().first;
}

std::vector<Nearest> nearest_of_cores(const Core& a, const Core& b, Names& name) {
  using Kind = Core::Kind;
  if (a.radius == "0" && b.radius == "0") return {};
  if (a.kind == Kind::segment && b.kind == Kind::segment) return nearest_of_segments(a, b, name);
  if (a.kind != Kind::point && b.kind != Kind::point) return {};
  const std::string own = point_of(a, b.centre, name), other = point_of(b, a.centre, name);
  return {by_cores(own, other, a.radius, b.radius, name)};
}

std::vector<Nearest> nearest_to_hollow(const Core& a, const std::string& centre, const std::string& radius,
                                       Names& name) {
  std::vector<std::string> farthest;
  if (a.kind == Core::Kind::point) {
    farthest = {a.centre};
  } else if (a.kind == Core::Kind::segment) {
    farthest = {name(along(a, a.size + "/2")), name(along(a, "(-" + a.size + "/2)"))};
  } else {
    const std::string outwards = name(across(name(fmt::format("{} - {}", a.centre, centre)), a.axis));
    farthest = {name(fmt::format("{} + {}*unit({})", a.centre, a.size, outwards))};
  }
  std::vector<Nearest> result;
  for (const std::string& p : farthest) {
    const std::string inwards = name(fmt::format("{} - {}", centre, p)), n = name(fmt::format("unit({})", inwards));
    result.push_back({fmt::format("{} - {} - norm({})", radius, a.radius, inwards), n,
                      fmt::format("({} - {}*{})", p, a.radius, n), fmt::format("({} - {}*{})", centre, radius, n)});
  }
  return result;
}

std::vector<Nearest> nearest_to_cylinder(const Core& a, const std::string& radius, const std::string& point,
                                         const std::string& axis, Names& name) {
  if (a.kind == Core::Kind::disk) return {};
  const std::string unit = name(fmt::format("unit({})", axis));
  std::string own = a.centre;
  if (a.kind == Core::Kind::segment) {
    const std::string u = name(across(a.axis, unit)), w = name(fmt::format("{} - {}", a.centre, point));
    own = name(along(a, clamp(fmt::format("-dot({0}, {1})/(dot({0}, {0}) + {2})", u, w, added_square), a)));
  }
  const std::string on_axis = name(fmt::format("{1} + dot({0} - {1}, {2})*{2}", own, point, unit));
  return {by_cores(own, on_axis, a.radius, radius, name)};
}

// The distance of a point of the segment from the cone is convex along the segment. Its least value is where that of
// the mantle's distance is, rho cos - h sin with rho^2 = A s^2 + 2 B s + C, or where the tip is nearest. The nearer one
// of both points is the nearest of all.
std::vector<Nearest> nearest_to_cone(const Core& a, const std::string& angle, const std::string& apex,
                                     const std::string& axis, Names& name) {
  if (a.kind == Core::Kind::disk) return {};
  const Cone cone{angle, apex, name(fmt::format("unit({})", axis))};
  if (a.radius == "0") {
    const std::string w = cone.radial(a.centre, name), h = name(cone.height(a.centre));
    const std::string tip = name(fmt::format("{} - {}", a.centre, apex));
    const auto beside_tip = [&](const std::string& at_tip, const std::string& at_mantle) {
      return name(fmt::format("if(norm({})*sin({}) + {}*cos({}) < 0, {}, {})", w, angle, h, angle, at_tip, at_mantle));
    };
    const std::string gap =
        beside_tip(fmt::format("norm({})", tip), fmt::format("norm({0})*cos({1}) - {2}*sin({1})", w, angle, h));
    const std::string n =
        beside_tip(fmt::format("unit({})", tip), fmt::format("cos({0})*unit({1}) - sin({0})*{2}", angle, w, cone.axis));
    return {{gap, n, a.centre, fmt::format("({} - {}*{})", a.centre, gap, n)}};
  }
  if (a.kind == Core::Kind::point)
    return {by_cores(a.centre, cone.foot(a.centre, a.radius, name), a.radius, "0", name)};
  const std::string u = name(across(a.axis, cone.axis)), w = cone.radial(a.centre, name);
  const std::string A = name(fmt::format("dot({0}, {0})", u)), B = name(fmt::format("dot({}, {})", u, w));
  const std::string k = name(fmt::format("dot({}, {})*tan({})", a.axis, cone.axis, angle));
  const std::string plane = name(fmt::format("cross({}, {})", u, w));
  const std::string length = name(fmt::format("sqrt(dot({0}, {0}) + 1e-30*{1}^2)", plane, a.radius));
  const std::string lowest =
      name(fmt::format("({0}*{1}/sqrt(max({2} - {0}^2, {4})) - {3})/max({2}, {4})", k, length, A, B, added_square));
  const std::string end = fmt::format("sign({})*{}/2", k, a.size);
  const std::string s = name(clamp(fmt::format("if({0} - {1}^2 > {2}, {3}, {4})", A, k, added_square, lowest, end), a));
  const std::string t = name(clamp(fmt::format("dot({}, {} - {})", a.axis, apex, a.centre), a));
  const std::string p = name(along(a, s)), q = name(along(a, t));
  const auto distance = [&](const std::string& at) {
    return name(fmt::format("norm({} - {})", at, cone.foot(at, a.radius, name)));
  };
  const std::string to_p = distance(p), to_q = distance(q);
  const std::string own = name(along(a, fmt::format("if({} < {}, {}, {})", to_p, to_q, s, t)));
  return {by_cores(own, cone.foot(own, a.radius, name), a.radius, "0", name)};
}

// A plane that is steeper than the mantle cuts the cone: there the rim meets the mantle before the face meets the tip.
std::string height_below_face(const Core& disk, const std::string& angle, const std::string& apex,
                              const std::string& axis) {
  const std::string d = fmt::format("({} - {})", apex, disk.centre), height = fmt::format("dot({}, {})", d, disk.axis);
  const std::string cosine = fmt::format("dot({}, unit({}))", disk.axis, axis);
  return fmt::format("if(dot({0}, {0}) - {1}^2 < {2}^2, if({3} > sin({4}), {1}, if({3} < -sin({4}), -{1}, {2})), {2})",
                     d, height, disk.size, cosine, angle);
}

}  // namespace eomgen::model
