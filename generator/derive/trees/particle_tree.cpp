// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/particle_tree.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "derive/equations.hpp"
#include "derive/trees/point_energies.hpp"
#include "derive/trees/tree_forces.hpp"

namespace eomgen::derive {
namespace {

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
