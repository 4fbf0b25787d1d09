// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/particle_force.hpp"

#include <algorithm>

#include "mechanics/imposition.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/factorisation.hpp"

namespace eomgen::mechanics {
namespace {

using symbolic::Symbol;
using symbolic::SymbolKind;

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

/// Coordinates that move the particle and nothing else, if they span all its motions: they are all coordinates of its
/// position, or three, or two of a chart in a plane.
std::vector<std::uint32_t> moving_it_alone(const Mechanics& m, std::size_t p) {
  const std::vector<std::uint32_t> all = coordinates_of(m, m.masses[p]);
  std::vector<std::uint32_t> alone = all;
  for (std::size_t other = 0; other < m.masses.size() && !alone.empty(); ++other) {
    if (other == p) continue;
    const std::vector<std::uint32_t> others = coordinates_of(m, m.masses[other]);
    std::erase_if(alone, [&](std::uint32_t i) { return has(others, i); });
  }
  std::erase_if(alone, [&](std::uint32_t i) { return turns(m, i); });
  const std::optional<model::Chart>& chart = m.model->places[m.masses[p].place].chart;
  const bool spans = alone.size() == 3 || alone.size() == all.size() || (chart && chart->planar && alone.size() == 2);
  return spans && alone.size() <= 3 ? alone : std::vector<std::uint32_t>{};
}

}  // namespace

std::optional<Vec3> force_on_particle(Mechanics& m, std::size_t p, const std::vector<Ref>& Q) {
  Dag& dag = *m.dag;
  if (!dag.is_zero(m.kinetic_given)) return std::nullopt;
  const std::vector<std::uint32_t> own = moving_it_alone(m, p);
  const std::size_t n = own.size();
  if (n == 0) return std::nullopt;
  symbolic::Substitution imposed = constraint_substitution(m), written = time_function_substitution(m);
  std::vector<Ref> J(3 * n), N(n * n, dag.zero()), components;
  for (std::size_t i = 0; i < n; ++i) {
    symbolic::Derivation by = symbolic::partial_derivative(dag, {SymbolKind::coordinate, own[i], 0});
    for (std::size_t k = 0; k < 3; ++k) J[k * n + i] = written(imposed(by(m.masses[p].position[k])));
    components.push_back(Q[own[i]]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < 3; ++k) N[i * n + j] = dag.add(N[i * n + j], dag.mul(J[k * n + i], J[k * n + j]));
      if (i != j && vanishes(dag, {N[i * n + j]})) N[i * n + j] = dag.zero();
    }
  }
  const symbolic::Factorisation factors(dag, N, n, symbolic::Ties::ascending);
  const std::vector<Ref> along = factors.backward(factors.forward(components));  // the a_i
  Vec3 force = symbolic::zero_vector(dag);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < n; ++i) force[k] = dag.add(force[k], dag.mul(J[k * n + i], along[i]));
  }
  return force;
}

}  // namespace eomgen::mechanics
