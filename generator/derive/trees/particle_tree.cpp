// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/particle_tree.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "derive/equations.hpp"
#include "derive/trees/tree_forces.hpp"
#include "mechanics/mechanics.hpp"
#include "symbolic/antiderivative.hpp"

namespace eomgen::derive {

using mechanics::Mechanics;
using mechanics::PointMass;
using symbolic::Dag;
using symbolic::Op;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;
using symbolic::Vec3;

namespace {

// A kinetic energy that is a sum of squares of velocities of points is that of particles: sum m/2 (x_dot^2 + y_dot^2 +
// z_dot^2), however it is written. In: Mechanics with an energy and no masses. Out: particles with the same energy, in
// an abstract space.

constexpr std::size_t worth_looking = 4;  // coordinates

/// m/2 x_dot^2 with x_dot = sum_j J_j q_j_dot.
struct Square {
  Ref mass;
  std::map<std::uint32_t, Ref> J;  // those that are not 0
};

/// A particle under construction: squares along the axes, each with a sign.
struct Placed {
  std::array<const Square*, 3> axis{};
  std::array<int, 3> sign{1, 1, 1};
};

class Recognition {
 public:
  explicit Recognition(Mechanics& m) : m_(m), dag_(*m.dag) {
    for (std::uint32_t j = 0; j < m.q.size(); ++j)
      by_rate_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, j, 1}));
  }

  std::optional<std::vector<PointMass>> run() {
    if (!collect(m_.kinetic_given, dag_.integer(2))) return std::nullopt;
    std::vector<PointMass> result;
    for (const Placed& placed : placed_squares()) {
      PointMass mass;
      mass.position = mass.velocity = symbolic::zero_vector(dag_);
      for (std::size_t k = 0; k < 3; ++k) {
        if (placed.axis[k] == nullptr) continue;
        mass.mass = placed.axis[k]->mass;
        const std::optional<Ref> x = integral(*placed.axis[k]);
        if (!x) return std::nullopt;
        mass.position[k] = placed.sign[k] < 0 ? dag_.neg(*x) : *x;
      }
      result.push_back(std::move(mass));
    }
    return result;
  }

 private:
  bool has(Ref r, std::uint8_t least_order) const {
    const std::vector<Symbol> symbols = dag_.symbols({r});
    return std::any_of(symbols.begin(), symbols.end(),
                       [=](const Symbol& s) { return s.kind == SymbolKind::coordinate && s.order >= least_order; });
  }

  /// Collects the squares in `factor` times `energy`. False if there is any other term.
  bool collect(Ref energy, Ref factor) {
    const symbolic::Node node = dag_[energy];
    switch (node.op) {
      case Op::add: return collect(node.args[0], factor) && collect(node.args[1], factor);
      case Op::sub: return collect(node.args[0], factor) && collect(node.args[1], dag_.neg(factor));
      case Op::neg: return collect(node.args[0], dag_.neg(factor));
      case Op::mul:
        for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
          if (!has(node.args[i], 0)) return collect(node.args[1 - i], dag_.mul(factor, node.args[i]));
        return false;
      case Op::div: return !has(node.args[1], 0) && collect(node.args[0], dag_.div(factor, node.args[1]));
      case Op::power: return node.payload == 2 && add(factor, node.args[0]);
      default: return dag_.is_zero(energy);
    }
  }

  bool add(Ref mass, Ref velocity) {
    Square square{mass, {}};
    Ref rest = velocity;
    for (std::uint32_t j = 0; j < by_rate_.size(); ++j) {
      const Ref J = by_rate_[j](velocity);
      if (dag_.is_zero(J)) continue;
      if (has(J, 1)) return false;
      square.J.emplace(j, J);
    }
    std::map<Symbol, Ref> at_rest;
    for (const auto& entry : square.J) at_rest[{SymbolKind::coordinate, entry.first, 1}] = dag_.zero();
    if (!dag_.is_zero(symbolic::Substitution(dag_, at_rest)(rest))) return false;
    squares_.push_back(std::move(square));
    return true;
  }

  /// x with dx/dq_j = J_j, integrated by one coordinate after another and proven.
  std::optional<Ref> integral(const Square& square) {
    Ref x = dag_.zero();
    for (const auto& [j, J] : square.J) {
      const auto [known, is_new] = integrals_.try_emplace({J, j});
      if (is_new) {
        for (const Symbol& s : dag_.symbols({J}))
          if (s.kind == SymbolKind::time || s.kind == SymbolKind::function ||
              (s.kind == SymbolKind::coordinate && s.index != j))
            return std::nullopt;
        known->second = symbolic::antiderivative(dag_, J, {SymbolKind::coordinate, j, 0});
      }
      if (!known->second) return std::nullopt;
      x = dag_.add(x, *known->second);
    }
    return x;
  }

  /// Groups squares of the same mass that move with the same coordinates, up to three.
  std::vector<Placed> placed_squares() {
    std::vector<Placed> result;
    std::vector<bool> taken(squares_.size(), false);
    for (std::size_t i = 0; i < squares_.size(); ++i) {
      if (taken[i]) continue;
      std::vector<const Square*> group;
      for (std::size_t k = i; k < squares_.size() && group.size() < 3; ++k) {
        const auto alike = [](const auto& a, const auto& b) { return a.first == b.first; };
        const Square &a = squares_[i], &b = squares_[k];
        if (taken[k] || a.mass != b.mass || !std::equal(a.J.begin(), a.J.end(), b.J.begin(), b.J.end(), alike))
          continue;
        taken[k] = true;
        group.push_back(&b);
      }
      result.push_back(best(group));
      for (const auto& entry : group.front()->J) known_.try_emplace(entry.first, moved(result.back(), entry.first));
    }
    return result;
  }

  Vec3 moved(const Placed& placed, std::uint32_t j) {
    Vec3 result = symbolic::zero_vector(dag_);
    for (std::size_t k = 0; k < 3; ++k) {
      if (placed.axis[k] == nullptr) continue;
      const Ref J = placed.axis[k]->J.at(j);
      result[k] = placed.sign[k] < 0 ? dag_.neg(J) : J;
    }
    return result;
  }

  /// The order and the signs with which the most coordinates move this particle as they move others.
  Placed best(const std::vector<const Square*>& group) {
    std::array<const Square*, 3> order{};
    std::copy(group.begin(), group.end(), order.begin());
    std::array<std::size_t, 3> place{0, 1, 2};
    Placed result{order, {1, 1, 1}};
    std::size_t most = 0;
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Placed trial;
        for (std::size_t k = 0; k < 3; ++k) {
          trial.axis[k] = order[place[k]];
          trial.sign[k] = (signs >> k & 1) != 0 ? -1 : 1;
        }
        std::size_t fits = 0;
        for (const auto& entry : group.front()->J) {
          const auto known = known_.find(entry.first);
          fits += known != known_.end() && known->second == moved(trial, entry.first) ? 1 : 0;
        }
        if (fits <= most) continue;
        most = fits;
        result = trial;
      }
    } while (std::next_permutation(place.begin(), place.end()));
    return result;
  }

  Mechanics& m_;
  Dag& dag_;
  std::vector<symbolic::Derivation> by_rate_;
  std::vector<Square> squares_;
  std::map<std::pair<Ref, std::uint32_t>, std::optional<Ref>> integrals_;
  std::map<std::uint32_t, Vec3> known_;
};

/// Empty for any other energy, or if there are too few coordinates for a gain. Squares that move with the same
/// coordinates and have the same mass become x, y, z of one particle. Their order and signs are chosen such that a
/// coordinate moves as many particles as possible by the same vector. The particles have no name and no place.
std::optional<std::vector<PointMass>> particles_of_energy(Mechanics& m) {
  if (!m.masses.empty() || !m.body_rotations.empty() || m.dag->is_zero(m.kinetic_given) || m.q.size() < worth_looking)
    return std::nullopt;
  return Recognition(m).run();
}

/// J of each theta and the particles that it moves. False if it moves two of them differently, or none.
bool find_joints(Dag& dag, ParticleTree& b, std::vector<std::set<std::size_t>>& moved) {
  for (const Symbol& theta : b.coordinates.theta) {
    symbolic::Derivation by = symbolic::partial_derivative(dag, theta);
    Vec3 common{};
    moved.emplace_back();
    for (std::size_t k = 0; k < b.particles.size(); ++k) {
      const Vec3& r = b.particles[k].position;
      const Vec3 J{by(r[0]), by(r[1]), by(r[2])};
      if (is_zero(dag, J)) continue;
      if (!moved.back().empty() && J != common) return false;
      common = J;
      moved.back().insert(k);
    }
    if (moved.back().empty()) return false;
    b.J.push_back(common);
  }
  return true;
}

/// Links from the sets of moved particles, which must be nested or disjoint.
bool find_links(Dag& dag, ParticleTree& b, const std::vector<std::set<std::size_t>>& moved) {
  std::vector<std::size_t> order(moved.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t x, std::size_t y) { return moved[x].size() > moved[y].size(); });
  std::vector<const std::set<std::size_t>*> sets;
  b.link_of.resize(moved.size());
  for (const std::size_t a : order) {
    int parent = -1;
    bool known = false;
    for (std::size_t l = 0; l < sets.size() && !known; ++l) {
      const bool inside = std::includes(sets[l]->begin(), sets[l]->end(), moved[a].begin(), moved[a].end());
      std::vector<std::size_t> common;
      std::set_intersection(sets[l]->begin(), sets[l]->end(), moved[a].begin(), moved[a].end(),
                            std::back_inserter(common));
      if (!inside && !common.empty()) return false;
      known = inside && sets[l]->size() == moved[a].size();
      if (known) b.link_of[a] = l;
      if (inside) parent = static_cast<int>(l);  // sets shrink, so the last containing set is the smallest
    }
    if (!known) {
      b.link_of[a] = b.links.size();
      b.links.push_back({{}, {}, parent, dag.zero()});
      sets.push_back(&moved[a]);
    }
    b.links[b.link_of[a]].joints.push_back(a);
  }
  for (std::size_t k = 0; k < b.particles.size(); ++k) {
    int innermost = -1;
    for (std::size_t l = 0; l < sets.size(); ++l) {
      if (!sets[l]->contains(k)) continue;
      innermost = static_cast<int>(l);
      b.links[l].mass_beyond = dag.add(b.links[l].mass_beyond, b.particles[k].mass);
    }
    if (innermost >= 0) b.links[static_cast<std::size_t>(innermost)].particles.push_back(k);
  }
  for (Link& link : b.links) std::sort(link.joints.begin(), link.joints.end());
  return true;
}

}  // namespace

bool ParticleTree::is_beyond(std::size_t outer, std::size_t inner) const {
  for (int l = static_cast<int>(outer); l >= 0; l = links[static_cast<std::size_t>(l)].parent) {
    if (static_cast<std::size_t>(l) == inner) return true;
  }
  return false;
}

std::optional<ParticleTree> particle_tree(Mechanics& m, const std::vector<std::uint32_t>& of, bool imposed) {
  Dag& dag = *m.dag;
  std::vector<mechanics::PointMass> masses = m.masses;
  if (masses.empty())
    masses = particles_of_energy(m).value_or(std::vector<mechanics::PointMass>{});
  else if (!dag.is_zero(m.kinetic_given))
    return std::nullopt;
  if (masses.empty() || !m.body_rotations.empty()) return std::nullopt;
  ImposedExpansion expanded(m, imposed);
  std::vector<Vec3> positions;
  for (const mechanics::PointMass& mass : masses) positions.push_back(expanded(mass.position));
  ParticleTree b;
  b.coordinates = quasi_coordinates(dag, of, positions);
  symbolic::Derivation bias = b.coordinates.bias(dag);
  for (std::size_t k = 0; k < positions.size(); ++k) {
    TreeParticle particle{expanded(masses[k].mass), positions[k], {}, {}};
    for (std::size_t i = 0; i < 3; ++i) particle.velocity[i] = bias(positions[k][i]);
    for (std::size_t i = 0; i < 3; ++i) particle.bias[i] = bias(particle.velocity[i]);
    b.particles.push_back(particle);
  }
  std::vector<std::set<std::size_t>> moved;
  if (!find_joints(dag, b, moved) || !find_links(dag, b, moved)) return std::nullopt;
  Ref potential;
  b.gravity = extract_gravity(m, expanded, potential);
  b.f = non_gravity_forces(m, of, expanded, potential);
  if (!b.coordinates.identity()) b.f = symbolic::multiply_transposed(dag, b.coordinates.S_inverse, b.f);
  return b;
}

}  // namespace eomgen::derive
