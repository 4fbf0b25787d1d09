// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/primitives.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lists.hpp"
#include "numeric/numbers.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {

using symbolic::Scalar;
using symbolic::Symbol;
using symbolic::Vec3;

namespace {

using Row = std::vector<double>;  // values of all vectors

constexpr double same_place = 1e-9;     // relative to the distance from the origin, in m
constexpr double same_length = 1e-6;    // relative tolerance of a rod
constexpr double part_of_run = 0.23;    // between sampled states
constexpr double parallel_axes = 1e-6;  // sine of the angle between axes of wheels
constexpr double belt_radius = 0.3;     // of a pulley of unknown size, relative to the distance of the centres

/// Values of the leaves of vectors: coordinates, their rates, time, `delay` after the start. Integrals are 0 there.
double value_of(const Symbol& s, const run::Scene& scene, const std::vector<double>& q, double delay) {
  switch (s.kind) {
    case SymbolKind::time: return scene.t0 + delay;
    case SymbolKind::coordinate: return s.order == 0 ? q[s.index] : s.order == 1 ? scene.qdot[s.index] : std::nan("");
    case SymbolKind::parameter: return scene.parameters[s.index];
    default: return s.kind == SymbolKind::integral ? delay : std::nan("");
  }
}

/// The start of everything that vectors depend on, except parameters.
std::map<Symbol, Ref> start_values(const Drawing& drawing, symbolic::Dag& dag, const run::Scene& scene) {
  std::map<Symbol, Ref> result;
  for (const Symbol& s : dag.symbols(drawing.expressions())) {
    const double value = value_of(s, scene, scene.q, 0);
    if (s.kind != SymbolKind::parameter && std::isfinite(value)) result[s] = dag.constant(numeric::exact(value));
  }
  return result;
}

std::vector<double> values(const Drawing& drawing, const symbolic::Dag& dag, const run::Scene& scene,
                           const std::vector<double>& q, double delay) {
  return symbolic::evaluate(dag, drawing.expressions(), [&](const Symbol& s) { return value_of(s, scene, q, delay); });
}

Point point(const Row& row, std::size_t at) { return Point(row.data() + at); }

bool is_near(const Point& a, const Point& b) { return (a - b).norm() < same_place * (1 + a.norm()); }

class Decision {
 public:
  Decision(const Drawing& drawing, symbolic::Dag& dag, const run::Scene& scene, const std::vector<Row>& rows)
      : drawing_(drawing),
        parts_(drawing.parts()),
        dag_(dag),
        rows_(rows),
        sizes_(dag, scene.parameters),
        start_(dag, start_values(drawing, dag, scene)),
        states_(sampled_values(drawing, dag, scene, part_of_run * (scene.t1 - scene.t0))) {}

  Primitives run() {
    solids();
    links();
    supports();
    for (const DrawnCoupling& coupling : parts_.couplings) wheels(coupling);
    result_.sizes = sizes_.expressions();
    result_.size_values = sizes_.values();
    return std::move(result_);
  }

 private:
  const Row& start() const { return states_.front(); }
  Point place(const Row& row, long i) const {
    return i < 0 ? Point(Point::Zero()) : point(row, parts_.places[static_cast<std::size_t>(i)].at);
  }

  void solids() {
    for (const DrawnBody& body : parts_.bodies) {
      std::vector<DrawnSolid> list = shapes_of(body.place);
      if (list.empty()) {
        std::optional<DrawnSolid> solid = solid_of_inertia(body, sizes_);
        if (!solid) solid = bar_of_inertia(body, sizes_, attached(body));
        if (solid) list.push_back(*solid);
      }
      result_.solids.push_back({body.place, body.axes, std::move(list)});
    }
    for (std::size_t i = 0; i < parts_.places.size(); ++i) {
      const auto is_this = [i](const DrawnBody& body) { return body.place == i; };
      if (std::any_of(parts_.bodies.begin(), parts_.bodies.end(), is_this)) continue;
      if (std::vector<DrawnSolid> list = shapes_of(i); !list.empty())
        result_.solids.push_back({i, std::nullopt, std::move(list)});
    }
  }
  std::vector<DrawnSolid> shapes_of(std::size_t place) {
    std::vector<DrawnSolid> result;
    for (const DrawnShape& shape : parts_.shapes) {
      if (shape.place == place) result.push_back(solid_of_shape(shape, sizes_));
    }
    return result;
  }
  /// Position of a joint, a point or a contact on a body in body axes. If it has none, the axis of the body towards the
  /// origin: the origin need not be fixed in the body.
  Vec3 attached(const DrawnBody& body) {
    const Vec3 centre = at_start(parts_.places[body.place].at), e1 = at_start(body.axes[0]),
               e2 = at_start(body.axes[1]), e3 = symbolic::cross(dag_, e1, e2);
    const auto in_body = [&](const Vec3& r) {
      const Vec3 arm = symbolic::subtract(dag_, r, centre);
      return Vec3{symbolic::dot(dag_, arm, e1), symbolic::dot(dag_, arm, e2), symbolic::dot(dag_, arm, e3)};
    };
    for (const DrawnJoint& joint : parts_.joints) {
      if (joint.of[0] == body.place || joint.of[1] == body.place) return in_body(at_start(joint.at));
    }
    for (const DrawnPlace& other : parts_.places) {
      if (other.from == static_cast<long>(body.place)) return in_body(at_start(other.at));
    }
    for (const DrawnContact& contact : parts_.contacts) {
      if (contact.of == body.place) return in_body(at_start(contact.at));
    }
    const Vec3 origin = in_body(symbolic::zero_vector(dag_));
    const Point axis =
        nearest_axis(body, sizes_, {sizes_.value(origin[0]), sizes_.value(origin[1]), sizes_.value(origin[2])});
    return {number(axis[0]).ref, number(axis[1]).ref, number(axis[2]).ref};
  }

  /// Lines to places, and rods between two places. A spring between the same ends replaces the line.
  void links() {
    const auto add = [&](long from, long to, bool is_rod) {
      const Point a = place(start(), from), b = place(start(), to);
      const bool sprung = std::any_of(parts_.springs.begin(), parts_.springs.end(), [&](const DrawnLine& spring) {
        const Point p = point(start(), spring.a), q = point(start(), spring.b);
        return (is_near(p, a) && is_near(q, b)) || (is_near(q, a) && is_near(p, b));
      });
      if (!sprung) result_.links.push_back({from, to, is_rod});
    };
    for (std::size_t i = 0; i < parts_.places.size(); ++i) {
      if (const auto from = parts_.places[i].from) add(*from, static_cast<long>(i), is_rod(*from, i));
    }
    for (const DrawnRod& rod : parts_.rods) add(rod.a, rod.b, true);
  }
  bool is_rod(long from, std::size_t to) const {
    if (parts_.places[to].is_held) return true;
    const auto length = [&](const Row& row) { return (place(row, static_cast<long>(to)) - place(row, from)).norm(); };
    const auto moves = [&](const DrawnSurface& s) { return s.place == to && (s.has_contact || s.is_moving); };
    return std::none_of(parts_.surfaces.begin(), parts_.surfaces.end(), moves) &&
           std::none_of(states_.begin(), states_.end(), [&](const Row& row) {
             return std::abs(length(row) - length(start())) > same_length * length(start());
           });
  }

  /// Fixed origins of rods, fixed ends of springs and dampers, joints with the ground.
  void supports() {
    std::vector<long> held;
    for (const DrawnLink& link : result_.links) {
      if (link.is_rod && link.from == -1) held.push_back(link.to);
    }
    if (!held.empty())
      support(std::nullopt, [&](const Row& row) { return mapped(held, [&](long to) { return place(row, to); }); });
    for (const auto* lines : {&parts_.springs, &parts_.dampers}) {
      for (const DrawnLine& line : *lines) {
        for (const auto& [end, other] : {std::pair{line.a, line.b}, std::pair{line.b, line.a}}) {
          if (is_fixed(end) && !is_fixed(other))
            support(end, [&, i = other](const Row& row) { return std::vector<Point>{point(row, i)}; });
        }
      }
    }
    for (const DrawnJoint& joint : parts_.joints) {
      if (joint.of[0].has_value() == joint.of[1].has_value() || !is_fixed(joint.at)) continue;
      const auto of = static_cast<long>(joint.of[0] ? *joint.of[0] : *joint.of[1]);
      support(joint.at, [&, of](const Row& row) { return std::vector<Point>{place(row, of)}; });
    }
  }
  bool is_fixed(std::size_t at) const {
    return std::all_of(states_.begin(), states_.end(), [&](const Row& row) {
      return !point(row, at).allFinite() || is_near(point(start(), at), point(row, at));
    });
  }
  /// `others`: points that it holds. The direction is the mean over the motion.
  template <class Others>
  void support(std::optional<std::size_t> at, const Others& others) {
    const auto position = [&](std::optional<std::size_t> of) -> Point {
      return of ? point(start(), *of) : Point(Point::Zero());
    };
    const Point here = position(at);
    const auto is_here = [&](const DrawnSupport& other) { return is_near(here, position(other.at)); };
    if (!here.allFinite() || std::any_of(result_.supports.begin(), result_.supports.end(), is_here)) return;
    Point mean = Point::Zero();
    const std::vector<Row> only{start()};
    for (const Row& row : rows_.empty() ? only : rows_) {
      for (const Point& other : others(row)) {
        if (other.allFinite()) mean += other - here;
      }
    }
    int k = 0;
    for (int i = 1; i < 3; ++i) {
      if (std::abs(mean[i]) > std::abs(mean[k]) + same_place) k = i;
    }
    if (mean[k] != 0) result_.supports.push_back({at, std::copysign(1.0, mean[k]) * Point::Unit(k)});
  }

  /// No wheels if the axes are not parallel or no such wheels exist.
  void wheels(const DrawnCoupling& coupling) {
    const auto axis = [&](const Row& row, std::size_t k) { return point(row, coupling.axes[k]).normalized(); };
    const auto are_parallel = [&](const Row& row) { return axis(row, 0).cross(axis(row, 1)).norm() < parallel_axes; };
    if (!are_parallel(start())) return;
    const double side = std::copysign(1.0, axis(start(), 0).dot(axis(start(), 1)));
    const double ratio = side * sizes_.value(coupling.ratio);
    const Ref distance = distance_of(coupling);
    if (!(sizes_.value(distance) > 0) || ratio == 0 || !std::isfinite(ratio)) return;
    const Scalar d{&dag_, distance}, one = number(1);
    const Scalar speed = Scalar{&dag_, coupling.ratio}, size = sizes_.value(coupling.ratio) < 0 ? -speed : speed;
    DrawnWheels result{coupling.of, coupling.axes[0], {}, std::nullopt};
    if (ratio < 0 || coupling.carried) {
      if (ratio == 1) return;
      const Scalar share = ratio < 0 ? one + size : ratio > 1 ? size - one : one - size;
      result.radii = {sizes_.index((d / share).ref), sizes_.index((d * size / share).ref)};
    } else {
      const std::array<Ref, 2> radii = pulleys(coupling, ratio, size, d);
      const Scalar cosine = (Scalar{&dag_, radii[0]} - Scalar{&dag_, radii[1]}) / d;
      result.radii = {sizes_.index(radii[0]), sizes_.index(radii[1])};
      if (std::abs(sizes_.value(cosine.ref)) < 1) result.belt = sizes_.index(cosine.ref);
    }
    result_.wheels.push_back(result);
  }
  std::array<Ref, 2> pulleys(const DrawnCoupling& coupling, double ratio, Scalar size, Scalar distance) const {
    const auto is_wheel = [&](const DrawnShape& shape, std::size_t k) {
      return shape.place == coupling.of[k] && (shape.kind == "disk" || shape.kind == "cylinder");
    };
    for (const DrawnShape& a : parts_.shapes) {
      for (const DrawnShape& b : parts_.shapes) {
        if (!is_wheel(a, 0) || !is_wheel(b, 1)) continue;
        const double r = sizes_.value(b.lengths[0]);
        if (std::abs(r - ratio * sizes_.value(a.lengths[0])) < same_length * r) return {a.lengths[0], b.lengths[0]};
      }
    }
    const Scalar larger = number(belt_radius) * distance;
    return ratio > 1 ? std::array{(larger / size).ref, larger.ref} : std::array{larger.ref, (larger * size).ref};
  }
  /// Distance of the axes at the coordinates of the start, as an expression in parameters.
  Ref distance_of(const DrawnCoupling& coupling) {
    const Vec3 n = at_start(coupling.axes[0]),
               between = symbolic::subtract(dag_, at_start(parts_.places[coupling.of[1]].at),
                                            at_start(parts_.places[coupling.of[0]].at));
    const Ref along = symbolic::dot(dag_, n, between);
    return dag_.call(symbolic::Op::sqrt, dag_.sub(symbolic::dot(dag_, between, between), dag_.mul(along, along)));
  }
  /// A vector at the coordinates of the start, in parameters.
  Vec3 at_start(std::size_t at) {
    const auto value = [&](std::size_t k) { return start_(drawing_.expressions()[at + k]); };
    return {value(0), value(1), value(2)};
  }
  Scalar number(double value) const { return {&dag_, dag_.constant(numeric::exact(value))}; }

  const Drawing& drawing_;
  const DrawnParts& parts_;
  symbolic::Dag& dag_;
  const std::vector<Row>& rows_;
  Sizes sizes_;
  symbolic::Substitution start_;
  const std::vector<Row> states_;
  Primitives result_;
};

}  // namespace

std::vector<double> values_at(const Drawing& drawing, const symbolic::Dag& dag, const run::Scene& scene,
                              const std::vector<double>& q) {
  return values(drawing, dag, scene, q, 0);
}

std::vector<std::vector<double>> sampled_values(const Drawing& drawing, const symbolic::Dag& dag,
                                                const run::Scene& scene, double delay) {
  std::vector<Row> result;
  for (int state = 0; state < 3; ++state) {
    std::vector<double> q = scene.q;
    for (std::size_t i = 0; i < q.size(); ++i)
      q[i] += state * (0.31 + 0.17 * std::sin(static_cast<double>(i + 1))) * (1 + std::abs(q[i]));
    result.push_back(values(drawing, dag, scene, q, state * delay));
  }
  return result;
}

Primitives primitives(const Drawing& drawing, symbolic::Dag& dag, const run::Scene& scene,
                      const std::vector<std::vector<double>>& rows) {
  return Decision(drawing, dag, scene, rows).run();
}

}  // namespace eomgen::analysis
