// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/tree_equations.hpp"

namespace eomgen::derive {
namespace {

/// Per link: the inertia force and weight of the particles beyond it, d(m v)/dt - m g at zero accelerations.
std::vector<Vec3> inertia_beyond(Dag& dag, const ParticleTree& b) {
  const Vec3 none = symbolic::zero_vector(dag);
  std::vector<Vec3> force(b.links.size(), none);
  symbolic::Derivation bias = b.coordinates.bias(dag);
  for (std::size_t l = b.links.size(); l-- > 0;) {
    for (const std::size_t k : b.links[l].particles) {
      const TreeParticle& particle = b.particles[k];
      const Ref mass_rate = bias(particle.mass);
      for (std::size_t i = 0; i < 3; ++i) {
        const Ref felt = dag.mul(particle.mass, dag.sub(particle.bias[i], b.gravity[i]));
        force[l][i] = dag.add(force[l][i], dag.add(felt, dag.mul(mass_rate, particle.velocity[i])));
      }
    }
    if (b.links[l].parent < 0) continue;
    Vec3& inner = force[static_cast<std::size_t>(b.links[l].parent)];
    for (std::size_t i = 0; i < 3; ++i) inner[i] = dag.add(inner[i], force[l][i]);
  }
  return force;
}

system::QuasiVelocityEquations in_theta(Dag& dag, const ParticleTree& b) {
  const std::size_t n = b.J.size();
  system::QuasiVelocityEquations result{b.coordinates.S_inverse, std::vector<Ref>(n * n, dag.zero()), {}};
  const std::vector<Vec3> force = inertia_beyond(dag, b);
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t c = 0; c <= a; ++c) {
      const std::size_t outer = b.is_beyond(b.link_of[a], b.link_of[c]) ? b.link_of[a] : b.link_of[c];
      if (!b.is_beyond(outer, b.link_of[a]) || !b.is_beyond(outer, b.link_of[c])) continue;
      const Ref entry = dag.mul(b.links[outer].mass_beyond, dot(dag, b.J[a], b.J[c]));
      result.M[a * n + c] = result.M[c * n + a] = entry;
    }
    result.f.push_back(dag.sub(b.f[a], dot(dag, b.J[a], force[b.link_of[a]])));
  }
  symbolic::Substitution back = b.coordinates.back(dag);
  for (Ref& r : result.M) r = back(r);
  for (Ref& r : result.f) r = back(r);
  return result;
}

FullEquations in_model(Dag& dag, const QuasiCoordinates& coordinates, const system::QuasiVelocityEquations& e) {
  if (coordinates.identity()) return {e.M, e.f};
  const std::size_t n = e.f.size();
  const std::vector<Rational>& S = coordinates.S;
  std::vector<Ref> half(n * n);  // M_theta S
  for (std::size_t a = 0; a < n; ++a) {
    const auto row = e.M.begin() + static_cast<std::ptrdiff_t>(a * n);
    const std::vector<Ref> product = symbolic::multiply_transposed(dag, S, {row, row + static_cast<std::ptrdiff_t>(n)});
    std::copy(product.begin(), product.end(), half.begin() + static_cast<std::ptrdiff_t>(a * n));
  }
  FullEquations result{std::vector<Ref>(n * n), symbolic::multiply_transposed(dag, S, e.f)};
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<Ref> column(n);
    for (std::size_t a = 0; a < n; ++a) column[a] = half[a * n + j];
    const std::vector<Ref> product = symbolic::multiply_transposed(dag, S, column);
    for (std::size_t i = 0; i <= j; ++i) result.M[i * n + j] = result.M[j * n + i] = product[i];
  }
  return result;
}

}  // namespace

std::optional<TreeEquations> tree_equations(Mechanics& m, const std::vector<std::uint32_t>& of, bool imposed) {
  std::optional<ParticleTree> tree = particle_tree(m, of, imposed);
  if (!tree) return std::nullopt;
  TreeEquations result{std::move(*tree), {}, {}};
  result.quasi = in_theta(*m.dag, result.tree);
  result.of_model = in_model(*m.dag, result.tree.coordinates, result.quasi);
  return result;
}

std::optional<TreeEquations> derive_tree_motion(Mechanics& m, system::Approach approach) {
  if (approach == system::Approach::one && !m.fixed.empty()) return std::nullopt;
  return tree_equations(m, m.free, true);
}

std::optional<system::EquationSystem> assemble_tree(Mechanics& m, const TreeEquations& motion, const char* formulation,
                                                    system::Approach approach) {
  if (m.fixed.empty()) return assemble(m, motion.of_model, nullptr, formulation, approach);
  const std::optional<TreeEquations> full = tree_equations(m, all_coordinates(m), false);
  if (!full) return std::nullopt;
  return assemble(m, full->of_model, &motion.of_model, formulation, approach);
}

}  // namespace eomgen::derive
