// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a drawing that follow from holonomic constraints and coordinates: surfaces and curves of particles and
// bodies, rods between places, fixed points of rotating bodies.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string_view>

#include "analysis/drawing/parts.hpp"
#include "analysis/drawing/sample_value.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {

using symbolic::Symbol;
using symbolic::Vec3;

namespace {

constexpr std::uint32_t most_places = 200;  // each pair of them is tested for a rod
constexpr double parallel = 1e-9;           // relative tolerance of gradients in binary64

std::set<std::uint32_t> coordinates_of(const symbolic::Dag& dag, const std::vector<Ref>& expressions) {
  std::set<std::uint32_t> result;
  for (const Symbol& s : dag.symbols(expressions)) {
    if (s.kind == SymbolKind::coordinate) result.insert(s.index);
  }
  return result;
}

bool is_moving(const symbolic::Dag& dag, const std::vector<Ref>& expressions) {
  const std::vector<Symbol> symbols = dag.symbols(expressions);
  return std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) {
    return s.kind == SymbolKind::time || s.kind == SymbolKind::integral || s.kind == SymbolKind::function ||
           s.kind == SymbolKind::state;
  });
}

/// Constraints on the position of a particle: not those of joints, contacts of bodies and Euler parameters.
bool binds_places(const mechanics::Mechanics& m, const mechanics::Constraint& c, const model::Constraint& of) {
  return c.holonomic() && c.redundancy == mechanics::Redundancy::independent && !of.joint && !of.contact && !of.unit &&
         !of.coupled && !m.dag->is_zero(c.psi);
}

const model::Constraint& written(const model::Model& model, const mechanics::Constraint& c) {
  return *std::find_if(model.constraints.begin(), model.constraints.end(),
                       [&](const model::Constraint& other) { return other.name == c.name; });
}

/// Whether two gradients, with interleaved components, are parallel at two sample states.
bool are_parallel(const symbolic::Dag& dag, const std::vector<Ref>& slopes) {
  for (int state = 0; state < 2; ++state) {
    const std::vector<double> v =
        symbolic::evaluate(dag, slopes, [state](const Symbol& s) { return sample_value(s, state); });
    double pp = 0, ps = 0, ss = 0;
    for (std::size_t k = 0; k < v.size(); k += 2) {
      pp += v[k] * v[k];
      ps += v[k] * v[k + 1];
      ss += v[k + 1] * v[k + 1];
    }
    if (!(pp > 0 && ss > 0 && ps * ps > (1 - parallel) * pp * ss)) return false;
  }
  return true;
}

/// Distances of places at sample states. They exclude a rod for most pairs of places without any derivative.
class SampledDistances {
 public:
  explicit SampledDistances(const mechanics::Mechanics& m) {
    std::vector<Ref> all;
    for (const auto& r : m.place_position) {
      all.insert(all.end(), r->begin(), r->end());
      coordinates_.push_back(coordinates_of(*m.dag, {(*r)[0], (*r)[1], (*r)[2]}));
    }
    for (int state = 0; state < 2; ++state) {
      positions_.push_back(symbolic::evaluate(*m.dag, all, [state](const Symbol& s) {
        return sample_value(s, s.kind == SymbolKind::parameter ? 0 : state);  // same parameters
      }));
    }
  }
  /// Whether two places have the same distance at both states, numerically.
  bool may_be_rigid(std::size_t a, std::size_t b) const {
    const double before = square(0, a, b), after = square(1, a, b);
    return !(std::abs(before - after) > parallel * (before + after));
  }
  /// Positions that depend on all of these coordinates.
  bool have(std::size_t a, std::size_t b, const std::set<std::uint32_t>& coordinates) const {
    return std::all_of(coordinates.begin(), coordinates.end(),
                       [&](std::uint32_t c) { return coordinates_[a].contains(c) || coordinates_[b].contains(c); });
  }

 private:
  double square(std::size_t state, std::size_t a, std::size_t b) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = positions_[state][3 * a + k] - positions_[state][3 * b + k];
      sum += d * d;
    }
    return sum;
  }
  std::vector<std::vector<double>> positions_;
  std::vector<std::set<std::uint32_t>> coordinates_;
};

}  // namespace

std::set<std::uint32_t> Drawing::coordinates_of_place(std::uint32_t place) const {
  const model::Place& of = model_.places[place];
  if (!of.chart) {
    const Vec3& r = *mechanics_.place_position[place];
    return coordinates_of(*mechanics_.dag, {r[0], r[1], r[2]});
  }
  std::vector<Ref> entries;
  for (const model::NodeId entry : of.chart->entries) {
    if (entry != model::no_node) entries.push_back(mechanics::lower_scalar(mechanics_, entry));
  }
  return coordinates_of(*mechanics_.dag, entries);
}

void Drawing::surfaces() {
  std::vector<Bound> bound;
  for (std::uint32_t i = 1; i < model_.places.size(); ++i) {
    if (parts_.places[i - 1].kind != std::string_view("point")) bound.push_back({i, coordinates_of_place(i)});
  }
  for (const Bound& one : bound) {
    if (one.own.size() == 2 || one.own.size() == 3) surface(one, bound);
  }
}

// The constraint must depend on two coordinates of this place. It may also depend on coordinates of other places, as
// for a bead on a sliding wedge. A constraint that binds two places in this way is a rod or has no surface.
bool Drawing::is_bound(const Bound& one, const std::vector<Bound>& all, std::uint32_t constraint) {
  const std::set<std::uint32_t> of = coordinates_of(*mechanics_.dag, {mechanics_.constraints[constraint].psi});
  const auto common = [&](const Bound& place) {
    return std::count_if(of.begin(), of.end(), [&](std::uint32_t c) { return place.own.contains(c); });
  };
  if (of.empty() || common(one) == 0) return false;
  if (std::includes(one.own.begin(), one.own.end(), of.begin(), of.end())) return true;
  const bool of_places = std::all_of(of.begin(), of.end(), [&](std::uint32_t c) {
    return std::any_of(all.begin(), all.end(), [c](const Bound& place) { return place.own.contains(c); });
  });
  const auto several = std::count_if(all.begin(), all.end(), [&](const Bound& place) { return common(place) > 1; });
  return of_places && several == 1 && common(one) > 1 && !is_radial(one, constraint);
}

// A thread: the gradient along these coordinates is parallel to that of the distance from the reference place.
bool Drawing::is_radial(const Bound& one, std::uint32_t constraint) {
  symbolic::Dag& dag = *mechanics_.dag;
  const Vec3 d = symbolic::subtract(dag, *mechanics_.place_position[one.place],
                                    *mechanics_.place_position[model_.places[one.place].from]);
  const Ref square = symbolic::dot(dag, d, d);
  std::vector<Ref> slopes;
  for (const std::uint32_t i : one.own) {
    slopes.push_back(mechanics_.constraints[constraint].gradient[i]);
    slopes.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 0})(square));
  }
  return are_parallel(dag, slopes);
}

void Drawing::surface(const Bound& one, const std::vector<Bound>& all_places) {
  symbolic::Dag& dag = *mechanics_.dag;
  const std::uint32_t i = one.place, from = model_.places[i].from;
  const Vec3& r = *mechanics_.place_position[i];
  const Vec3 relative = symbolic::subtract(dag, r, *mechanics_.place_position[from]);
  DrawnSurface surface;
  for (std::size_t k = 0; k < 3; ++k) surface.position[k] = written_(r[k]);
  bool radial = true;  // all constraints fix the distance from its reference place; a rod is drawn instead
  for (std::uint32_t c = 0; c < mechanics_.constraints.size(); ++c) {
    const mechanics::Constraint& constraint = mechanics_.constraints[c];
    const model::Constraint& of = written(model_, constraint);
    if (!binds_places(mechanics_, constraint, of) || !is_bound(one, all_places, c)) continue;
    surface.name += (surface.name.empty() ? "" : ", ") + constraint.label;
    surface.psi.push_back(written_(constraint.psi));
    surface.has_contact = surface.has_contact || of.friction || of.unilateral;
    radial = radial && is_rod(c, from, i);
  }
  if (surface.psi.empty() || surface.psi.size() >= one.own.size()) return;
  std::vector<Ref> seen = surface.psi;
  for (const Ref& part : relative) seen.push_back(written_(part));
  const bool changes = is_moving(dag, seen);
  if (radial && !surface.has_contact && !changes) return;
  seen.insert(seen.end(), surface.position.begin(), surface.position.end());
  surface.place = i - 1;
  surface.coordinates.assign(one.own.begin(), one.own.end());
  const std::set<std::uint32_t> of_shape = coordinates_of(dag, surface.psi), of_all = coordinates_of(dag, seen);
  std::set_difference(of_all.begin(), of_all.end(), one.own.begin(), one.own.end(), std::back_inserter(surface.others));
  surface.changes_shape =
      is_moving(dag, surface.psi) || !std::includes(one.own.begin(), one.own.end(), of_shape.begin(), of_shape.end());
  surface.is_moving = surface.changes_shape || !surface.others.empty() || is_moving(dag, seen);
  surface.at = values_of(surface.coordinates).front();
  for (const std::size_t at : values_of(surface.others)) surface.others_at.push_back(at);
  const std::vector<Symbol> symbols = dag.symbols(seen);
  if (std::any_of(symbols.begin(), symbols.end(),
                  [](const Symbol& s) { return s.kind == SymbolKind::integral && s.index > 2; }))
    return;
  if (std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind == SymbolKind::integral; })) {
    Vec3 integrals = symbolic::zero_vector(dag);
    for (std::uint32_t k = 0; k < std::min<std::size_t>(3, model_.states.size()); ++k)
      integrals[k] = dag.symbol(mechanics::state_symbol(model_, k));
    surface.integrals = vector(integrals);
  }
  parts_.surfaces.push_back(std::move(surface));
}

// Groups the values in vectors of three.
std::vector<std::size_t> Drawing::values_of(const std::vector<std::uint32_t>& coordinates) {
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < coordinates.size(); k += 3) {
    Vec3 three = symbolic::zero_vector(*mechanics_.dag);
    const std::size_t count = std::min<std::size_t>(3, coordinates.size() - k);
    for (std::size_t i = 0; i < count; ++i) three[i] = mechanics_.q[coordinates[k + i]];
    const std::size_t first = vector(three);
    for (std::size_t i = 0; i < count; ++i) result.push_back(first + i);
  }
  return result;
}

// psi is a function of the distance alone: its gradient is parallel to that of the distance in all states.
bool Drawing::is_rod(std::uint32_t constraint, std::uint32_t a, std::uint32_t b) {
  symbolic::Dag& dag = *mechanics_.dag;
  const mechanics::Constraint& c = mechanics_.constraints[constraint];
  const Vec3 d = symbolic::subtract(dag, *mechanics_.place_position[b], *mechanics_.place_position[a]);
  const Ref square = symbolic::dot(dag, d, d);
  const std::set<std::uint32_t> of_psi = coordinates_of(dag, {c.psi}), of_square = coordinates_of(dag, {square});
  if (of_psi.empty() || !std::includes(of_square.begin(), of_square.end(), of_psi.begin(), of_psi.end()) ||
      is_moving(dag, {c.psi, square}))
    return false;
  std::vector<Ref> slopes;
  for (const std::uint32_t i : of_square) {
    slopes.push_back(c.gradient[i]);
    slopes.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 0})(square));
  }
  return are_parallel(dag, slopes);
}

// The two places move relative to each other at constant distance.
bool Drawing::is_rigid(std::uint32_t a, std::uint32_t b) {
  symbolic::Dag& dag = *mechanics_.dag;
  const Vec3 d = symbolic::subtract(dag, *mechanics_.place_position[b], *mechanics_.place_position[a]);
  const Ref square = symbolic::dot(dag, d, d);
  const std::set<std::uint32_t> of = coordinates_of(dag, {d[0], d[1], d[2]});
  if (of.empty() || is_moving(dag, {square})) return false;
  std::vector<Ref> slopes;
  for (const std::uint32_t i : of)
    slopes.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 0})(square));
  return mechanics::vanishes(dag, slopes);
}

// With r the centre of mass and n = dw/dqdot, dr/dq = n x (r - c) for a point c fixed in the body.
void Drawing::pivots() {
  symbolic::Dag& dag = *mechanics_.dag;
  for (const model::Body& body : model_.bodies) {
    const model::Frame& frame = model_.frames[body.frame];
    if (frame.entries.size() != 1 || frame.stages.empty() || model_.places[body.place].chart) continue;
    const Ref angle = mechanics::lower_scalar(mechanics_, frame.entries[0]);
    const std::set<std::uint32_t> of = coordinates_of(dag, {angle});
    if (of.size() != 1) continue;
    symbolic::Derivation slope = symbolic::partial_derivative(dag, {SymbolKind::coordinate, *of.begin(), 0}),
                         rate = symbolic::partial_derivative(dag, {SymbolKind::coordinate, *of.begin(), 1});
    const Ref turn = slope(angle);  // n is the axis times this
    if (!depends_on_parameters_only(dag, turn)) continue;
    std::array<Vec3, 3> e;
    Vec3 n = symbolic::zero_vector(dag), turned;
    const Vec3& r = *mechanics_.place_position[body.place];
    for (std::size_t k = 0; k < 3; ++k) {
      e[k] = mechanics::lower_vector(mechanics_, frame.stages.back().e[k]);
      n = symbolic::add(dag, n, symbolic::scale(dag, rate(mechanics_.angular_velocity[body.frame][k]), e[k]));
      turned[k] = slope(r[k]);
    }
    if (mechanics::vanishes(dag, {turned[0], turned[1], turned[2]})) continue;
    // From the centre of mass to the point.
    const Vec3 arm = symbolic::scale(dag, dag.div(dag.one(), dag.mul(turn, turn)), symbolic::cross(dag, n, turned));
    std::vector<Ref> changes;
    for (const std::uint32_t i : coordinates_of(dag, {arm[0], arm[1], arm[2]})) {
      for (const Vec3& axis : e)
        changes.push_back(
            symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 0})(symbolic::dot(dag, arm, axis)));
    }
    if (!mechanics::vanishes(dag, changes)) continue;
    parts_.joints.push_back({"", vector(symbolic::add(dag, r, arm)), {body.place - 1, std::nullopt}});
  }
}

void Drawing::rods() {
  parts_.rods_incomplete = model_.places.size() > most_places;
  if (parts_.rods_incomplete) return;
  const SampledDistances distances(mechanics_);
  for (const model::Particle& particle : model_.particles) {
    if (model_.places[particle.place].chart) continue;
    // The closest earlier place in the model, as for the links of a chain.
    for (std::uint32_t a = particle.place; a-- > 0;) {
      if (!distances.may_be_rigid(a, particle.place) || !is_rigid(a, particle.place)) continue;
      parts_.rods.push_back({static_cast<long>(a) - 1, static_cast<long>(particle.place) - 1});
      break;
    }
  }
  for (const model::Body& body : model_.bodies) {  // rotates about the origin without a joint
    const auto is_of = [&](const DrawnJoint& j) { return j.of[0] == body.place - 1 || j.of[1] == body.place - 1; };
    if (!model_.places[body.place].chart && std::none_of(parts_.joints.begin(), parts_.joints.end(), is_of) &&
        is_rigid(0, body.place))
      parts_.rods.push_back({-1, static_cast<long>(body.place) - 1});
  }
  for (std::uint32_t k = 0; k < mechanics_.constraints.size(); ++k) {
    const mechanics::Constraint& c = mechanics_.constraints[k];
    const model::Constraint& of = written(model_, c);
    if (!binds_places(mechanics_, c, of) || of.unilateral || of.friction) continue;
    const std::set<std::uint32_t> coordinates = coordinates_of(*mechanics_.dag, {c.psi});
    bool found = false;
    for (std::uint32_t a = 0; a < model_.places.size() && !found; ++a) {
      for (std::uint32_t b = a + 1; b < model_.places.size() && !found; ++b) {
        found = distances.have(a, b, coordinates) && is_rod(k, a, b);
        DrawnPlace& place = parts_.places[b - 1];
        const bool linked = place.from && *place.from == static_cast<long>(a) - 1;
        place.is_held = place.is_held || (found && linked);
        if (found && !linked) parts_.rods.push_back({static_cast<long>(a) - 1, static_cast<long>(b) - 1});
      }
    }
  }
}

}  // namespace eomgen::analysis
