// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/particle_force.hpp"

#include <algorithm>

#include "mechanics/imposition.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/factorisation.hpp"

namespace eomgen::mechanics {
namespace {

/// Coordinates that occur in the position.
std::vector<std::uint32_t> coordinates_of(const Mechanics& m, const PointMass& mass) {
  std::vector<std::uint32_t> result;
  for (const Symbol& s : m.dag->symbols({mass.position[0], mass.position[1], mass.position[2]})) {
    if (s.kind == SymbolKind::coordinate && s.order == 0) result.push_back(s.index);
  }
  return result;
}

bool has(const std::vector<std::uint32_t>& list, std::uint32_t i) {
  return std::find(list.begin(), list.end(), i) != list.end();
}

bool turns(const Mechanics& m, std::uint32_t i) {
  symbolic::Derivation by = symbolic::partial_derivative(*m.dag, {SymbolKind::coordinate, i, 1});
  return std::any_of(m.body_rotations.begin(), m.body_rotations.end(), [&](const BodyRotation& spin) {
    return !vanishes(*m.dag, {by(spin.w[0]), by(spin.w[1]), by(spin.w[2])});
  });
}

/// Particles that hang on one another: the chain of those whose force is being determined.
using Chain = std::vector<std::size_t>;

std::optional<Vec3> force(Mechanics& m, std::size_t p, const std::vector<Ref>& Q, Chain chain);

/// Whether these coordinates span all motions of the particle in space, or in the plane of its chart.
bool is_spanned_by(const Mechanics& m, std::size_t p, const std::vector<std::uint32_t>& coordinates) {
  const std::optional<model::Chart>& chart = m.model->places[m.masses[p].place].chart;
  return coordinates.size() == 3 || (chart && chart->planar && coordinates.size() == 2);
}

/// A particle that moves with another one, and the force on it.
struct Carried {
  std::size_t mass;
  Vec3 force;
};

/// Coordinates by which the particle moves, if they span all its motions: they are all coordinates of its position, or
/// three, or two of a chart in a plane. Those that move other masses too count if the forces on these are known.
std::vector<std::uint32_t> moving_it(Mechanics& m, std::size_t p, const std::vector<Ref>& Q, const Chain& chain,
                                     std::vector<Carried>& carried) {
  const std::vector<std::uint32_t> all = coordinates_of(m, m.masses[p]);
  std::vector<std::uint32_t> own = all;
  for (std::size_t other = 0; other < m.masses.size() && !own.empty(); ++other) {
    if (other == p) continue;
    const std::vector<std::uint32_t> others = coordinates_of(m, m.masses[other]);
    if (std::none_of(own.begin(), own.end(), [&](std::uint32_t i) { return has(others, i); })) continue;
    std::optional<Vec3> known;
    // Of two particles with the same coordinates, neither is carried by the other.
    const bool hangs = std::any_of(others.begin(), others.end(), [&](std::uint32_t i) { return !has(all, i); });
    if (hangs && std::find(chain.begin(), chain.end(), other) == chain.end()) known = force(m, other, Q, chain);
    if (known)
      carried.push_back({other, *known});
    else
      std::erase_if(own, [&](std::uint32_t i) { return has(others, i); });
  }
  std::erase_if(own, [&](std::uint32_t i) { return turns(m, i); });
  const bool spans = is_spanned_by(m, p, own) || own.size() == all.size();
  return spans && own.size() <= 3 ? own : std::vector<std::uint32_t>{};
}

std::optional<Vec3> force(Mechanics& m, std::size_t p, const std::vector<Ref>& Q, Chain chain) {
  Dag& dag = *m.dag;
  const bool is_carried = !chain.empty();
  chain.push_back(p);
  std::vector<Carried> carried;
  const std::vector<std::uint32_t> own = moving_it(m, p, Q, chain, carried);
  const std::size_t n = own.size();
  // Coordinates that leave out a direction leave out the force along it.
  if (n == 0 || (is_carried && !is_spanned_by(m, p, own))) return std::nullopt;
  symbolic::Substitution imposed = constraint_substitution(m), written = time_function_substitution(m);
  std::vector<Ref> J(3 * n), N(n * n, dag.zero()), components;
  for (std::size_t i = 0; i < n; ++i) {
    symbolic::Derivation by = symbolic::partial_derivative(dag, {SymbolKind::coordinate, own[i], 0});
    for (std::size_t k = 0; k < 3; ++k) J[k * n + i] = written(imposed(by(m.masses[p].position[k])));
    Ref rest = Q[own[i]];
    for (const Carried& other : carried) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Ref slope = written(imposed(by(m.masses[other.mass].position[k])));
        rest = dag.sub(rest, dag.mul(other.force[k], slope));
      }
    }
    components.push_back(rest);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < 3; ++k) N[i * n + j] = dag.add(N[i * n + j], dag.mul(J[k * n + i], J[k * n + j]));
      if (i != j && vanishes(dag, {N[i * n + j]})) N[i * n + j] = dag.zero();
    }
  }
  const symbolic::Factorisation factors(dag, N, n, symbolic::Ties::ascending);
  const std::vector<Ref> along = factors.backward(factors.forward(components));  // the a_i
  Vec3 result = symbolic::zero_vector(dag);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < n; ++i) result[k] = dag.add(result[k], dag.mul(J[k * n + i], along[i]));
  }
  return result;
}

}  // namespace

std::optional<Vec3> force_on_particle(Mechanics& m, std::size_t p, const std::vector<Ref>& Q) {
  if (!m.dag->is_zero(m.kinetic_given)) return std::nullopt;
  return force(m, p, Q, {});
}

}  // namespace eomgen::mechanics
