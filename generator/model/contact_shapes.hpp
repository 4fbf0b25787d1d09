// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes of a [[contact]]: of bodies that touch a plane, of fixed obstacles that particles and balls touch, and of
// capsules and balls that touch one another. In: names and sizes as written, in parentheses. Out: expressions of the
// model language. Each kind of body and obstacle is one line of a table.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

namespace eomgen::model {

/// A shape of a body, centred at its centre of mass; axial ones along e3. Its points that are nearest to a plane.
struct BodyShape {
  const char* name;
  std::vector<const char*> sizes;
  /// Vectors from the centre of mass. n: the unit normal of the plane, as an expression.
  std::vector<std::string> (*points)(const std::string& body, const std::vector<std::string>& size,
                                     const std::string& n);
};

/// The highest point of a circle about e3, from its centre; the lowest one is opposite. There is none while e3 is along
/// the normal.
inline std::string highest_on_rim(const std::string& body, const std::string& radius, const std::string& n) {
  return fmt::format("{0}*unit({2} - dot({2}, {1}.e3)*{1}.e3)", radius, body, n);
}

inline const std::array<BodyShape, 6>& body_shapes() {
  using Sizes = std::vector<std::string>;
  static const std::array<BodyShape, 6> shapes{{
      {"sphere",
       {"radius"},
       [](const std::string&, const Sizes& s, const std::string& n) -> Sizes {
         return {fmt::format("-{}*{}", s[0], n)};
       }},
      {"disk",
       {"radius"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         return {"-" + highest_on_rim(b, s[0], n)};
       }},
      {"capsule",  // two half spheres, whose centres are a length apart
       {"radius", "length"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         return {fmt::format("{1}/2*{0}.e3 - {2}*{3}", b, s[1], s[0], n),
                 fmt::format("-{1}/2*{0}.e3 - {2}*{3}", b, s[1], s[0], n)};
       }},
      {"cylinder",
       {"radius", "length"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         return {fmt::format("{1}/2*{0}.e3 - {2}", b, s[1], highest_on_rim(b, s[0], n)),
                 fmt::format("-{1}/2*{0}.e3 - {2}", b, s[1], highest_on_rim(b, s[0], n))};
       }},
      {"cone",  // homogeneous, its tip towards e3
       {"radius", "height"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         return {fmt::format("3/4*{1}*{0}.e3", b, s[1]),
                 fmt::format("-{1}/4*{0}.e3 - {2}", b, s[1], highest_on_rim(b, s[0], n))};
       }},
      {"ellipsoid",  // of three half axes along e1, e2, e3
       {"a", "b", "c"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         std::string sum, square;
         for (std::size_t k = 0; k < 3; ++k) {
           sum += fmt::format("{}{}^2*dot({}, {}.e{})*{}.e{}", k == 0 ? "" : " + ", s[k], n, b, k + 1, b, k + 1);
           square += fmt::format("{}({}*dot({}, {}.e{}))^2", k == 0 ? "" : " + ", s[k], n, b, k + 1);
         }
         return {fmt::format("-({})/sqrt({})", sum, square)};
       }},
  }};
  return shapes;
}

/// A fixed obstacle. Its gap to a ball of radius R about a particle, or to the particle itself if R is 0.
struct Obstacle {
  const char* name;  // the key with its size
  std::vector<const char*> further;
  /// values: of `name`, then of `further`.
  std::string (*gap)(const std::string& particle, const std::vector<std::string>& values, const std::string& radius);
};

/// The expression with the names x and y replaced by the position of a particle along E1 and E2.
inline std::string at_particle(const std::string& expression, const std::string& particle) {
  const auto starts = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto continues = [&](char c) { return starts(c) || (c >= '0' && c <= '9') || c == '_'; };
  std::string result;
  for (std::size_t i = 0; i < expression.size();) {
    if (!continues(expression[i]) && expression[i] != '.') {
      result += expression[i++];
      continue;
    }
    std::size_t end = i;  // of a number or of a name with its parts, such as P.e1
    while (end < expression.size() && (continues(expression[end]) || expression[end] == '.')) ++end;
    const std::string word = expression.substr(i, end - i);
    result += word == "x" || word == "y" ? fmt::format("dot({}, E{})", particle, word == "x" ? 1 : 2) : word;
    i = end;
  }
  return result;
}

inline const std::array<Obstacle, 5>& obstacles() {
  using Values = std::vector<std::string>;
  static const std::array<Obstacle, 5> all{{
      {"sphere",
       {"centre"},
       [](const std::string& p, const Values& v, const std::string& r) {
         return fmt::format("norm({} - {}) - {} - {}", p, v[1], v[0], r);
       }},
      {"hollow",  // a sphere around the particle
       {"centre"},
       [](const std::string& p, const Values& v, const std::string& r) {
         return fmt::format("{} - {} - norm({} - {})", v[0], r, p, v[1]);
       }},
      {"cylinder",
       {"point", "axis"},
       [](const std::string& p, const Values& v, const std::string& r) {
         return fmt::format("norm(cross({} - {}, unit({}))) - {} - {}", p, v[1], v[2], v[0], r);
       }},
      {"cone",  // of a half angle, touched from outside, open along its axis
       {"apex", "axis"},
       [](const std::string& p, const Values& v, const std::string& r) {
         return fmt::format("norm(cross({0} - {1}, unit({2})))*cos({3}) - dot({0} - {1}, unit({2}))*sin({3}) - {4}", p,
                            v[1], v[2], v[0], r);
       }},
      {"surface",  // z = f(x, y), touched from above by particles; the gap is measured along E3
       {},
       [](const std::string& p, const Values& v, const std::string&) {
         return fmt::format("dot({}, E3) - {}", p, at_particle(v[0], p));
       }},
  }};
  return all;
}

/// A segment along e3 with a radius around its centre; a ball without a length. Sizes are expressions.
struct Capsule {
  std::string centre, radius, length;
  bool is_ball() const { return length.empty(); }
};

/// The distance of two capsules: |d + s u - t v| less both radii, with the nearest points at s and t from the centres.
/// The nearest points of the lines give s first, then t and s are nearest to one another within the segments. The last
/// step is exact, so that a term below the rounding of sin^2 keeps parallel axes defined.
inline std::string gap_of_capsules(const Capsule& a, const Capsule& b) {
  const auto within = [](const std::string& x, const Capsule& c) {
    return fmt::format("max(-{1}/2, min({1}/2, {0}))", x, c.length);
  };
  const std::string d = fmt::format("({} - {})", a.centre, b.centre);
  const std::string u = a.centre + ".e3", v = b.centre + ".e3";
  const std::string along_u = fmt::format("dot({}, {})", u, d), along_v = fmt::format("dot({}, {})", v, d);
  std::string apart = d;
  if (a.is_ball() != b.is_ball()) {
    apart += a.is_ball() ? fmt::format(" - {}*{}", within(along_v, b), v)
                         : fmt::format(" + {}*{}", within("-" + along_u, a), u);
  } else if (!a.is_ball()) {
    const std::string cosine = fmt::format("dot({}, {})", u, v);
    const std::string on_lines =
        fmt::format("({0}*{1} - {2})/(dot(cross({3}, {4}), cross({3}, {4})) + 1e-14)", cosine, along_v, along_u, u, v);
    const std::string t = within(fmt::format("{}*{} + {}", cosine, within(on_lines, a), along_v), b);
    apart += fmt::format(" + {}*{} - {}*{}", within(fmt::format("{}*{} - {}", cosine, t, along_u), a), u, t, v);
  }
  return fmt::format("norm({}) - {} - {}", apart, a.radius, b.radius);
}

}  // namespace eomgen::model
