// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/solids.hpp"

#include <cln/exception.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "lists.hpp"
#include "numeric/numbers.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {

using symbolic::Vec3;

namespace {

using Axes = Eigen::Matrix3d;  // columns

constexpr std::uint32_t sides = 28;
constexpr double equal = 1e-6;                           // relative tolerance of moments
constexpr double thinnest = 0.03;                        // thickness of a disk and a plate relative to their size
constexpr double rod_radius = 0.02, bar_radius = 0.025;  // relative to their length
constexpr int size_digits = 20;                          // of sizes

const Polyhedron& box() {
  static const Polyhedron result = [] {
    Polyhedron p{"box", {}, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}, 6};
    for (unsigned k = 0; k < 8; ++k)
      p.vertices.emplace_back(k & 1u ? 0.5 : -0.5, k & 2u ? 0.5 : -0.5, k & 4u ? 0.5 : -0.5);
    return p;
  }();
  return result;
}

/// About the third edge: a ring of vertices at its end, one at its start. The first two edges are radii.
const Polyhedron& cylinder() {
  static const Polyhedron result = [] {
    Polyhedron p{"cylinder", {}, Faces(2), 2};
    for (const double z : {0.5, -0.5}) {
      for (std::uint32_t k = 0; k < sides; ++k) {
        const double angle = 2 * std::numbers::pi * k / sides;
        p.vertices.emplace_back(std::cos(angle), std::sin(angle), z);
      }
    }
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t next = (k + 1) % sides;
      p.faces[0].push_back(k);
      p.faces[1].push_back(sides + (sides - k) % sides);
      p.faces.push_back({sides + k, sides + next, next, k});
    }
    return p;
  }();
  return result;
}

// Right-handed axes of which the third is the k-th of `axes`.
Axes about(const Axes& axes, int k) {
  Axes result;
  result << axes.col((k + 1) % 3), axes.col((k + 2) % 3), axes.col(k);
  return result;
}

Axes inertia_of(const DrawnBody& body, const Sizes& sizes) {
  Axes result;
  for (int i = 0; i < 9; ++i) result(i / 3, i % 3) = sizes.value(body.inertia[static_cast<std::size_t>(i)]);
  return result;
}

/// Formulas of lengths and of moments of inertia.
class Formulas {
 public:
  explicit Formulas(Sizes& sizes) : sizes_(sizes), dag_(sizes.dag()) {}

  Ref number(double value) const { return dag_.constant(numeric::exact(value)); }
  Ref product(double factor, Ref r) const { return dag_.mul(number(factor), r); }
  Ref larger(Ref a, Ref b) const { return dag_.call(symbolic::Op::max, a, b); }
  Ref root(Ref square) const { return dag_.call(symbolic::Op::sqrt, larger(square, dag_.zero())); }
  Vec3 vector(const Point& r) const { return {number(r[0]), number(r[1]), number(r[2])}; }
  DrawnVector edge(Ref length, const Vec3& along) const { return sizes_.indices(symbolic::scale(dag_, length, along)); }
  DrawnSolid box(const std::array<Ref, 3>& lengths, const Axes& axes) const {
    DrawnSolid solid;
    solid.polyhedron = &analysis::box();
    for (int k = 0; k < 3; ++k)
      solid.edges[static_cast<std::size_t>(k)] = edge(lengths[static_cast<std::size_t>(k)], vector(axes.col(k)));
    return solid;
  }
  DrawnSolid cylinder(Ref radius, Ref length, const std::array<Vec3, 3>& axes) const {
    DrawnSolid solid;
    solid.polyhedron = &analysis::cylinder();
    solid.edges = {edge(radius, axes[0]), edge(radius, axes[1]), edge(length, axes[2])};
    return solid;
  }
  DrawnSolid cylinder(Ref radius, Ref length, const Axes& axes) const {
    return cylinder(radius, length, {vector(axes.col(0)), vector(axes.col(1)), vector(axes.col(2))});
  }

  /// About an axis: an entry of the inertia if it is an axis of the body.
  Ref moment(const DrawnBody& body, const Point& axis) const {
    Ref sum = dag_.zero();
    for (int i = 0; i < 9; ++i)
      sum = dag_.add(sum, product(axis[i / 3] * axis[i % 3], body.inertia[static_cast<std::size_t>(i)]));
    return sum;
  }
  Ref trace(const DrawnBody& body) const {
    return dag_.add(dag_.add(body.inertia[0], body.inertia[4]), body.inertia[8]);
  }
  /// Square root of a moment over the mass, times a factor.
  Ref length(const DrawnBody& body, double factor, Ref moment) const {
    return root(dag_.div(product(factor, moment), body.mass));
  }

 private:
  Sizes& sizes_;
  symbolic::Dag& dag_;
};

// Convex polygon around coplanar points, counterclockwise as seen against `normal` (gift wrapping): from the outermost
// point on, the next vertex leaves all others to the left.
std::vector<std::uint32_t> polygon(const std::vector<Point>& points, const std::vector<std::uint32_t>& in_plane,
                                   const Point& normal) {
  const Point along = normal.unitOrthogonal();
  const std::uint32_t first =
      *std::min_element(in_plane.begin(), in_plane.end(),
                        [&](std::uint32_t a, std::uint32_t b) { return along.dot(points[a]) < along.dot(points[b]); });
  std::vector<std::uint32_t> result;
  for (std::uint32_t at = first; result.size() <= in_plane.size();) {
    result.push_back(at);
    std::uint32_t next = at;
    for (const std::uint32_t l : in_plane) {
      const Point step = points[l] - points[at], best = points[next] - points[at];
      const double turn = normal.dot(best.cross(step));
      const double none = equal * best.norm() * step.norm();
      if (l != at && (next == at || turn < -none || (turn <= none && step.norm() > best.norm()))) next = l;
    }
    at = next;
    if (at == first || (points[at] - points[first]).norm() == 0) break;
  }
  return result;
}

}  // namespace

std::size_t Sizes::index(Ref size) {
  const auto [place, is_new] = index_.emplace(size, expressions_.size());
  if (is_new) expressions_.push_back(size);
  return place->second;
}

double Sizes::value(Ref size) const {
  try {
    return values({size})[0];
  } catch (const std::exception&) {
    return -1;
  }
}

std::vector<double> Sizes::values() const {
  try {
    return values(expressions_);
  } catch (const std::exception&) {  // one of them is undefined
    return mapped(expressions_, [this](Ref size) { return value(size); });
  }
}

std::vector<double> Sizes::values(const std::vector<Ref>& sizes) const {
  const auto lookup = [&](const symbolic::Symbol& s) -> cln::cl_R { return numeric::exact(parameters_[s.index]); };
  return mapped(symbolic::evaluate(dag_, sizes, lookup, size_digits),
                [](const cln::cl_R& x) { return cln::double_approx(x); });
}

DrawnSolid solid_of_shape(const DrawnShape& shape, Sizes& sizes) {
  const Formulas formulas(sizes);
  const std::vector<Ref>& l = shape.lengths;
  const Axes axes = about(Axes::Identity(), static_cast<int>(shape.axis));
  DrawnSolid solid;
  if (shape.kind == "sphere") {
    solid.ball = sizes.index(l[0]);
  } else if (shape.kind == "arrow") {
    solid.tip = sizes.indices({l[0], l[1], l[2]});
  } else if (shape.kind == "box") {
    solid = formulas.box({l[0], l[1], l[2]}, Axes::Identity());
  } else if (shape.kind == "mesh") {
    std::vector<Point> points;
    for (std::size_t k = 0; k + 2 < l.size(); k += 3) {
      solid.points.push_back(sizes.indices({l[k], l[k + 1], l[k + 2]}));
      points.emplace_back(sizes.value(l[k]), sizes.value(l[k + 1]), sizes.value(l[k + 2]));
    }
    solid.faces = shape.faces.empty() ? convex_hull(points) : shape.faces;
    solid.open = !shape.faces.empty() || solid.faces.size() == 1;
  } else if (shape.kind == "cylinder") {
    solid = formulas.cylinder(l[0], l[1], axes);
  } else if (shape.kind == "disk") {
    solid = formulas.cylinder(l[0], formulas.product(thinnest, l[0]), axes);
  } else {
    solid = formulas.cylinder(formulas.product(rod_radius, l[0]), l[0], axes);
  }
  if (!shape.at.empty()) solid.at = sizes.indices({shape.at[0], shape.at[1], shape.at[2]});
  return solid;
}

Faces convex_hull(const std::vector<Point>& points) {
  double size = 0;
  for (const Point& p : points) size = std::max(size, (p - points[0]).norm());
  const double least = 1e-9 * size;
  Faces faces;
  std::set<std::vector<std::uint32_t>> found;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    for (std::uint32_t j = i + 1; j < points.size(); ++j) {
      for (std::uint32_t k = j + 1; k < points.size(); ++k) {
        Point normal = (points[j] - points[i]).cross(points[k] - points[i]);
        if (!(normal.norm() > least * size)) continue;
        normal.normalize();
        double low = 0, high = 0;
        std::vector<std::uint32_t> in_plane;
        for (std::uint32_t l = 0; l < points.size(); ++l) {
          const double height = normal.dot(points[l] - points[i]);
          low = std::min(low, height);
          high = std::max(high, height);
          if (std::abs(height) <= least) in_plane.push_back(l);
        }
        if ((low < -least && high > least) || !found.insert(in_plane).second) continue;
        if (high > least) normal = -normal;
        faces.push_back(polygon(points, in_plane, normal));
      }
    }
  }
  return faces;
}

std::optional<DrawnSolid> solid_of_inertia(const DrawnBody& body, Sizes& sizes) {
  const Eigen::SelfAdjointEigenSolver<Axes> principal(inertia_of(body, sizes));
  const Point J = principal.eigenvalues();
  Axes axes = principal.eigenvectors();
  const double largest = J.maxCoeff();
  if (!(sizes.value(body.mass) > 0) || !(largest > 0) || J.minCoeff() < -1e-9 * largest ||
      2 * largest > (1 + equal) * J.sum())
    return std::nullopt;
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  const auto same = [&](int i, int j) { return std::abs(J[i] - J[j]) < equal * largest; };
  const Formulas formulas(sizes);
  symbolic::Dag& dag = sizes.dag();
  const auto moment = [&](int k) { return formulas.moment(body, axes.col(k)); };
  const auto side = [&](int k) {
    return formulas.length(body, 6, dag.sub(formulas.trace(body), formulas.product(2, moment(k))));
  };
  if (same(0, 1) && same(1, 2)) {
    DrawnSolid ball;
    ball.ball = sizes.index(formulas.length(body, 2.5, dag.div(formulas.trace(body), dag.integer(3))));
    return ball;
  }
  for (int k = 0; k < 3; ++k) {
    if (!same((k + 1) % 3, (k + 2) % 3)) continue;
    const Ref length = side(k),
              radius = formulas.larger(formulas.length(body, 2, moment(k)), formulas.product(rod_radius, length));
    return formulas.cylinder(radius, formulas.larger(length, formulas.product(thinnest, radius)), about(axes, k));
  }
  std::array<Ref, 3> lengths{side(0), side(1), side(2)};
  const Ref thin = formulas.product(thinnest, formulas.larger(formulas.larger(lengths[0], lengths[1]), lengths[2]));
  for (Ref& one : lengths) one = formulas.larger(one, thin);
  return formulas.box(lengths, axes);
}

std::optional<DrawnSolid> bar_of_inertia(const DrawnBody& body, Sizes& sizes, const Vec3& spot) {
  int k = 0;
  const double mass = sizes.value(body.mass), largest = inertia_of(body, sizes).diagonal().maxCoeff(&k);
  const Point r(sizes.value(spot[0]), sizes.value(spot[1]), sizes.value(spot[2]));
  if (!(mass > 0) || !(largest > 0) || !(r.norm() > 1e-9 * std::sqrt(12 * largest / mass))) return std::nullopt;
  const Formulas formulas(sizes);
  symbolic::Dag& dag = sizes.dag();
  const auto unit = [&](const Vec3& v) {
    return symbolic::scale(dag, dag.div(dag.one(), formulas.root(symbolic::dot(dag, v, v))), v);
  };
  // The vector across that has the largest product with the bar.
  const bool is_upright = std::hypot(r.x(), r.y()) < equal * std::abs(r.z());
  const Vec3 along = unit(spot), across = unit(is_upright ? Vec3{dag.zero(), dag.neg(spot[2]), spot[1]}
                                                          : Vec3{dag.neg(spot[1]), spot[0], dag.zero()});
  const Ref length = formulas.length(body, 12, formulas.moment(body, Point::Unit(k)));
  return formulas.cylinder(formulas.product(bar_radius, length), length,
                           {across, symbolic::cross(dag, along, across), along});
}

Point nearest_axis(const DrawnBody& body, const Sizes& sizes, const Point& spot) {
  Eigen::Index normal = 0, k = 0;
  inertia_of(body, sizes).diagonal().maxCoeff(&normal);
  Point candidates = spot.cwiseAbs();
  candidates[normal] = 0;
  if (!(candidates.maxCoeff(&k) > 0)) return Point::Zero();
  return std::copysign(1.0, spot[k]) * Point::Unit(k);
}

std::optional<Solid> evaluate(const DrawnSolid& drawn, const std::vector<double>& sizes) {
  const auto vector = [&](const DrawnVector& v) -> Point { return {sizes[v[0]], sizes[v[1]], sizes[v[2]]}; };
  Solid solid;
  solid.open = drawn.open;
  if (drawn.at) solid.at = vector(*drawn.at);
  if (drawn.ball) solid.ball = sizes[*drawn.ball];
  if (drawn.ball && !(solid.ball > 0)) return std::nullopt;
  if (drawn.tip) solid.tip = solid.at + vector(*drawn.tip);
  std::vector<Point> vertices;
  for (const DrawnVector& point : drawn.points) vertices.push_back(solid.at + vector(point));
  if (drawn.polyhedron != nullptr) {
    Axes edges;
    edges << vector(drawn.edges[0]), vector(drawn.edges[1]), vector(drawn.edges[2]);
    if (!(edges.determinant() > 0)) return std::nullopt;
    for (const Point& share : drawn.polyhedron->vertices) vertices.push_back(edges * share + solid.at);
  }
  for (const auto& face : drawn.polyhedron != nullptr ? drawn.polyhedron->faces : drawn.faces)
    solid.faces.push_back(mapped<Point>(face, [&](std::uint32_t k) { return vertices[k]; }));
  return solid;
}

}  // namespace eomgen::analysis
