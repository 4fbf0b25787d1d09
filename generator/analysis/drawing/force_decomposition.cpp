// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/force_decomposition.hpp"

#include "mechanics/particle_force.hpp"
#include "mechanics/vanishes.hpp"

namespace eomgen::analysis {

using symbolic::Ref;
using symbolic::SymbolKind;
using symbolic::Vec3;

void ForceDecomposition::add_potential(Ref U) {
  for (std::uint32_t c = 0; c < Q_.size(); ++c)
    Q_[c] = m_.dag->sub(Q_[c], symbolic::partial_derivative(*m_.dag, {SymbolKind::coordinate, c, 0})(U));
}

void ForceDecomposition::subtract(const Vec3& force, const Vec3& at) {
  for (std::uint32_t c = 0; c < Q_.size(); ++c) {
    symbolic::Derivation by = symbolic::partial_derivative(*m_.dag, {SymbolKind::coordinate, c, 0});
    Q_[c] = m_.dag->sub(Q_[c], symbolic::dot(*m_.dag, force, {by(at[0]), by(at[1]), by(at[2])}));
  }
}

void ForceDecomposition::subtract(const BodyMoment& moment) {
  for (std::uint32_t c = 0; c < Q_.size(); ++c) Q_[c] = m_.dag->sub(Q_[c], moments_.generalised_force(moment, c));
}

std::vector<BodyMoment> ForceDecomposition::moments_about_angle(Ref angle) {
  std::vector<Ref> of_angle(Q_.size(), m_.dag->zero());
  for (const symbolic::Symbol& s : m_.dag->symbols({angle})) {
    if (s.kind == SymbolKind::coordinate && s.order == 0) of_angle[s.index] = Q_[s.index];
  }
  std::vector<BodyMoment> result = moments_.moments_about_angle(of_angle, angle);
  for (const BodyMoment& turn : result) subtract(turn);
  return result;
}

std::vector<std::pair<std::size_t, Vec3>> ForceDecomposition::forces_on_masses() {
  std::vector<std::pair<std::size_t, Vec3>> result;
  for (std::size_t p = 0; p < m_.masses.size(); ++p) {
    const auto value = mechanics::force_on_particle(m_, p, Q_);
    if (!value || mechanics::vanishes(*m_.dag, {(*value)[0], (*value)[1], (*value)[2]})) continue;
    result.emplace_back(p, *value);
    subtract(*value, m_.masses[p].position);
  }
  return result;
}

std::vector<BodyMoment> ForceDecomposition::moments_on_attitudes() {
  std::vector<BodyMoment> result;
  for (std::size_t b = 0; b < m_.body_rotations.size(); ++b) {
    const auto value = moments_.moment_on_attitude(b, Q_);
    if (!value || mechanics::vanishes(*m_.dag, {(*value)[0], (*value)[1], (*value)[2]})) continue;
    result.push_back({b, *value});
    subtract(result.back());
    // Euler parameters have one surplus direction, along which nothing moves.
    for (std::uint32_t c = 0; c < Q_.size(); ++c) {
      if (moments_.rotates_only(b, c)) Q_[c] = m_.dag->zero();
    }
  }
  return result;
}

}  // namespace eomgen::analysis
