// SPDX-License-Identifier: GPL-3.0-or-later
// What holonomic constraints and coordinates leave to particles and bodies: surfaces, curves, rods between two, points
// about which a body turns.
#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/drawing/parts.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {

using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;
using symbolic::Vec3;

namespace {

constexpr std::uint32_t most_places = 30;  // of which each pair is tried for a rod
constexpr double parallel = 1e-9;          // of slopes in binary64, relative

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
    return s.kind == SymbolKind::time || s.kind == SymbolKind::integral || s.kind == SymbolKind::function;
  });
}

/// Those that bind a particle where it is, and no joint, contact of a body or Euler parameters.
bool binds_places(const mechanics::Mechanics& m, const mechanics::Constraint& c, const model::Constraint& of) {
  return c.holonomic() && c.need == mechanics::Need::holds && !of.joint && !of.contact && !of.unit && !of.coupled &&
         !m.dag->is_zero(c.psi);
}

const model::Constraint& written(const model::Model& model, const mechanics::Constraint& c) {
  return *std::find_if(model.constraints.begin(), model.constraints.end(),
                       [&](const model::Constraint& other) { return other.name == c.name; });
}

/// Any numbers; which they are does not matter to what holds everywhere.
double somewhere(const Symbol& s, int state) {
  const double turn = 1.3 * s.index + 0.7 * static_cast<int>(s.kind) + 2.1 * state;
  return 0.9 + 0.4 * std::sin(turn);
}

}  // namespace

void Drawing::surfaces() {
  symbolic::Dag& dag = *mechanics_.dag;
  for (const model::Particle& particle : model_.particles) {
    const std::uint32_t i = particle.place;
    if (model_.places[i].from != 0) continue;  // moves along with another, and so does its surface
    const Vec3& r = *mechanics_.place_position[i];
    DrawnSurface surface;
    for (std::size_t k = 0; k < 3; ++k) surface.position[k] = written_(r[k]);
    const std::set<std::uint32_t> own = coordinates_of(dag, {r[0], r[1], r[2]});
    if (own.size() < 2 || own.size() > 3) continue;
    bool radial = true;  // all of them hold it at a distance from the origin, and a rod is drawn
    for (const mechanics::Constraint& c : mechanics_.constraints) {
      const model::Constraint& of = written(model_, c);
      if (!binds_places(mechanics_, c, of)) continue;
      const std::set<std::uint32_t> bound = coordinates_of(dag, {c.psi});
      if (bound.empty() || !std::includes(own.begin(), own.end(), bound.begin(), bound.end())) continue;
      surface.name += (surface.name.empty() ? "" : ", ") + c.label;
      surface.psi.push_back(written_(c.psi));
      surface.touched = surface.touched || of.friction || of.unilateral;
      radial = radial && is_rod(static_cast<std::uint32_t>(&c - mechanics_.constraints.data()), 0, i);
    }
    if (surface.psi.empty() || surface.psi.size() >= own.size()) continue;
    std::vector<Ref> all = surface.psi;
    all.insert(all.end(), surface.position.begin(), surface.position.end());
    surface.moves = is_moving(dag, all);
    if (radial && !surface.touched && !surface.moves) continue;
    surface.place = i - 1;
    surface.coordinates.assign(own.begin(), own.end());
    Vec3 coordinates = symbolic::zero_vector(dag), integrals = coordinates;
    for (std::size_t k = 0; k < own.size(); ++k) coordinates[k] = mechanics_.q[surface.coordinates[k]];
    surface.at = vector(coordinates);
    const std::vector<Symbol> symbols = dag.symbols(all);
    if (std::any_of(symbols.begin(), symbols.end(),
                    [](const Symbol& s) { return s.kind == SymbolKind::integral && s.index > 2; }))
      continue;
    if (std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind == SymbolKind::integral; })) {
      for (std::uint32_t k = 0; k < std::min<std::size_t>(3, model_.integrals.size()); ++k)
        integrals[k] = dag.symbol({SymbolKind::integral, k, 0});
      surface.integrals = vector(integrals);
    }
    parts_.surfaces.push_back(std::move(surface));
  }
}

// psi is a function of their distance alone: its slopes are along those of the distance wherever they are.
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
    slopes.push_back(symbolic::partial(dag, {SymbolKind::coordinate, i, 0})(square));
  }
  for (int state = 0; state < 2; ++state) {
    const std::vector<double> v =
        symbolic::evaluate(dag, slopes, [state](const Symbol& s) { return somewhere(s, state); });
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

// They move against one another, and their distance does not change.
bool Drawing::is_rigid(std::uint32_t a, std::uint32_t b) {
  symbolic::Dag& dag = *mechanics_.dag;
  const Vec3 d = symbolic::subtract(dag, *mechanics_.place_position[b], *mechanics_.place_position[a]);
  const Ref square = symbolic::dot(dag, d, d);
  const std::set<std::uint32_t> of = coordinates_of(dag, {d[0], d[1], d[2]});
  if (of.empty() || is_moving(dag, {square})) return false;
  std::vector<Ref> slopes;
  for (const std::uint32_t i : of) slopes.push_back(symbolic::partial(dag, {SymbolKind::coordinate, i, 0})(square));
  return mechanics::vanishes(dag, slopes);
}

// With r the centre of mass and n = dw/dqdot, dr/dq = n x (r - c) about a point c that is fixed in the body.
void Drawing::pivots() {
  symbolic::Dag& dag = *mechanics_.dag;
  for (const model::Body& body : model_.bodies) {
    const model::Frame& frame = model_.frames[body.frame];
    if (frame.entries.size() != 1 || frame.stages.empty() || model_.places[body.place].chart) continue;
    const Ref angle = mechanics::lower_scalar(mechanics_, frame.entries[0]);
    const std::set<std::uint32_t> of = coordinates_of(dag, {angle});
    if (of.size() != 1) continue;
    symbolic::Derivation slope = symbolic::partial(dag, {SymbolKind::coordinate, *of.begin(), 0}),
                         rate = symbolic::partial(dag, {SymbolKind::coordinate, *of.begin(), 1});
    const Ref turn = slope(angle);  // n is the axis times this
    if (!is_of_parameters(dag, turn)) continue;
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
        changes.push_back(symbolic::partial(dag, {SymbolKind::coordinate, i, 0})(symbolic::dot(dag, arm, axis)));
    }
    if (!mechanics::vanishes(dag, changes)) continue;
    parts_.joints.push_back({"", vector(symbolic::add(dag, r, arm)), {body.place - 1, std::nullopt}});
  }
}

void Drawing::rods() {
  if (model_.places.size() > most_places) return;
  for (const model::Particle& particle : model_.particles) {
    if (model_.places[particle.place].chart) continue;
    // The nearest before it in the model, as of the links of a chain.
    for (std::uint32_t a = particle.place; a-- > 0;) {
      if (!is_rigid(a, particle.place)) continue;
      parts_.rods.push_back({static_cast<long>(a) - 1, static_cast<long>(particle.place) - 1});
      break;
    }
  }
  for (const model::Body& body : model_.bodies) {  // about the origin, on no joint
    const auto is_of = [&](const DrawnJoint& j) { return j.of[0] == body.place - 1 || j.of[1] == body.place - 1; };
    if (!model_.places[body.place].chart && std::none_of(parts_.joints.begin(), parts_.joints.end(), is_of) &&
        is_rigid(0, body.place))
      parts_.rods.push_back({-1, static_cast<long>(body.place) - 1});
  }
  for (std::uint32_t k = 0; k < mechanics_.constraints.size(); ++k) {
    const mechanics::Constraint& c = mechanics_.constraints[k];
    const model::Constraint& of = written(model_, c);
    if (!binds_places(mechanics_, c, of) || of.unilateral || of.friction) continue;
    bool found = false;
    for (std::uint32_t a = 0; a < model_.places.size() && !found; ++a) {
      for (std::uint32_t b = a + 1; b < model_.places.size() && !found; ++b) {
        found = is_rod(k, a, b);
        const DrawnPlace& place = parts_.places[b - 1];
        const bool linked = place.from && *place.from == static_cast<long>(a) - 1;
        if (found && !linked) parts_.rods.push_back({static_cast<long>(a) - 1, static_cast<long>(b) - 1});
      }
    }
  }
}

}  // namespace eomgen::analysis
