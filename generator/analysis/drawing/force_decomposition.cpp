// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/force_decomposition.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/drawing/sample_value.hpp"
#include "mechanics/particle_force.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/factorisation.hpp"

namespace eomgen::analysis {

using mechanics::Mechanics;
using symbolic::Ref;
using symbolic::SymbolKind;
using symbolic::Vec3;
using Triple = std::array<double, 3>;

namespace {

constexpr double vanishing = 1e-9;  // in binary64, for numbers of magnitude 1

double length(const Triple& a) { return std::hypot(a[0], a[1], a[2]); }
Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double volume(const Triple& a, const Triple& b, const Triple& c) {
  const Triple n = cross(a, b);
  return n[0] * c[0] + n[1] * c[1] + n[2] * c[2];
}

}  // namespace

BodyMoments::BodyMoments(Mechanics& mechanics) : m_(mechanics), moves_(mechanics.q.size(), false) {
  symbolic::Dag& dag = *m_.dag;
  turns_.resize(m_.body_rotations.size(), std::vector<Vec3>(m_.q.size(), symbolic::zero_vector(dag)));
  numbers_.resize(m_.body_rotations.size(), std::vector<Numbers>(m_.q.size()));
  std::vector<std::pair<std::size_t, std::uint32_t>> some;
  std::vector<Ref> all;
  for (std::uint32_t c = 0; c < m_.q.size(); ++c) {
    symbolic::Derivation rate = symbolic::partial_derivative(dag, {SymbolKind::coordinate, c, 1}),
                         slope = symbolic::partial_derivative(dag, {SymbolKind::coordinate, c, 0});
    for (const mechanics::PointMass& mass : m_.masses)
      moves_[c] = moves_[c] ||
                  !symbolic::is_zero(dag, {slope(mass.position[0]), slope(mass.position[1]), slope(mass.position[2])});
    for (std::size_t b = 0; b < m_.body_rotations.size(); ++b) {
      const mechanics::BodyRotation& spin = m_.body_rotations[b];
      Vec3& sum = turns_[b][c];
      for (std::size_t k = 0; k < 3; ++k)
        sum = symbolic::add(dag, sum, symbolic::scale(dag, rate(spin.w[k]), spin.axes[k]));
      if (symbolic::is_zero(dag, sum)) continue;
      some.emplace_back(b, c);
      all.insert(all.end(), sum.begin(), sum.end());
    }
  }
  for (int state = 0; state < 2; ++state) {
    const std::vector<double> v =
        symbolic::evaluate(dag, all, [state](const symbolic::Symbol& s) { return sample_value(s, state); });
    for (std::size_t i = 0; i < some.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        numbers_[some[i].first][some[i].second][static_cast<std::size_t>(state)][k] = v[3 * i + k];
    }
  }
}

std::optional<std::size_t> BodyMoments::body_of(std::uint32_t frame) const {
  const auto& bodies = m_.model->bodies;
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const model::Body& b) { return b.frame == frame; });
  return found == bodies.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - bodies.begin()));
}

Ref BodyMoments::generalised_force(const BodyMoment& moment, std::uint32_t c) {
  return symbolic::dot(*m_.dag, moment.value, turns_[moment.body][c]);
}

Vec3 BodyMoments::turn(std::optional<std::size_t> body, std::uint32_t c) const {
  return body ? turns_[*body][c] : symbolic::zero_vector(*m_.dag);
}

BodyMoments::Numbers BodyMoments::numbers(std::optional<std::size_t> body, std::uint32_t c) const {
  return body ? numbers_[*body][c] : Numbers{};
}

// Up to two directions: G a = Q with G_ij = n_i . n_j, M = sum a_i n_i. Three or more directions (Euler parameters have
// four): (sum n_i n_i^T) M = sum Q_i n_i.
Vec3 BodyMoments::least(const std::vector<Vec3>& n, const std::vector<Ref>& Q) {
  symbolic::Dag& dag = *m_.dag;
  std::vector<Ref> gram, right = Q;
  Vec3 sum = symbolic::zero_vector(dag);
  if (n.size() < 3) {
    for (const Vec3& a : n) {
      for (const Vec3& b : n) gram.push_back(symbolic::dot(dag, a, b));
    }
  } else {
    gram.assign(9, dag.zero());
    for (std::size_t i = 0; i < n.size(); ++i) {
      sum = symbolic::add(dag, sum, symbolic::scale(dag, Q[i], n[i]));
      for (std::size_t k = 0; k < 9; ++k) gram[k] = dag.add(gram[k], dag.mul(n[i][k / 3], n[i][k % 3]));
    }
    right.assign(sum.begin(), sum.end());
  }
  const symbolic::Factorisation factors(dag, gram, right.size(), symbolic::Ties::ascending);
  const std::vector<Ref> solved = factors.backward(factors.forward(right));
  if (n.size() >= 3) return {solved[0], solved[1], solved[2]};
  for (std::size_t i = 0; i < n.size(); ++i) sum = symbolic::add(dag, sum, symbolic::scale(dag, solved[i], n[i]));
  return sum;
}

// Applies if the two bodies rotate relative to each other about a single axis by this angle, or if the angle is one of
// the independent angles that rotate the body.
std::optional<Vec3> BodyMoments::about_axis(std::size_t body, std::optional<std::size_t> other,
                                            const std::vector<Ref>& Q,
                                            const std::vector<std::array<double, 2>>& slopes) {
  std::vector<std::uint32_t> of;
  std::vector<Numbers> n;
  for (std::uint32_t c = 0; c < m_.q.size(); ++c) {
    Numbers relative = numbers(body, c);
    const Numbers against = numbers(other, c);
    double size = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::size_t k = 0; k < 3; ++k) relative[s][k] -= against[s][k];
      size += length(relative[s]);
    }
    if (!(size > vanishing)) {
      if (slopes[c][0] != 0 || slopes[c][1] != 0) return std::nullopt;
      continue;
    }
    of.push_back(c);
    n.push_back(relative);
  }
  if (of.empty()) return std::nullopt;
  bool one_axis = true, independent = n.size() <= 3;
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t i = 1; i < n.size(); ++i) {
      one_axis = one_axis && length(cross(n[0][s], n[i][s])) < vanishing;
      for (std::size_t k = 0; k < 3; ++k)  // both have the same factor
        one_axis = one_axis && std::abs(slopes[of[0]][s] * n[i][s][k] - slopes[of[i]][s] * n[0][s][k]) < vanishing;
    }
    if (n.size() == 2) independent = independent && length(cross(n[0][s], n[1][s])) > vanishing;
    if (n.size() == 3) independent = independent && std::abs(volume(n[0][s], n[1][s], n[2][s])) > vanishing;
  }
  if (!one_axis && !independent) return std::nullopt;
  std::vector<Vec3> directions;
  std::vector<Ref> along;
  for (std::size_t i = 0; i < (one_axis ? 1 : of.size()); ++i) {
    directions.push_back(symbolic::subtract(*m_.dag, turn(body, of[i]), turn(other, of[i])));
    along.push_back(Q[of[i]]);
  }
  return least(directions, along);
}

std::vector<BodyMoment> BodyMoments::moments_about_angle(const std::vector<Ref>& Q, Ref angle) {
  symbolic::Dag& dag = *m_.dag;
  std::vector<Ref> slopes;
  for (std::uint32_t c = 0; c < m_.q.size(); ++c)
    slopes.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, c, 0})(angle));
  std::vector<std::array<double, 2>> at(m_.q.size());
  for (int state = 0; state < 2; ++state) {
    const std::vector<double> v =
        symbolic::evaluate(dag, slopes, [state](const symbolic::Symbol& s) { return sample_value(s, state); });
    for (std::size_t c = 0; c < v.size(); ++c) at[c][static_cast<std::size_t>(state)] = v[c];
  }
  std::vector<std::optional<std::size_t>> others{std::nullopt};
  for (std::size_t b = 0; b < m_.body_rotations.size(); ++b) others.emplace_back(b);
  for (const std::optional<std::size_t>& other : others) {  // the ground first
    for (std::size_t b = 0; b < m_.body_rotations.size(); ++b) {
      if (other == b) continue;
      const auto moment = about_axis(b, other, Q, at);
      if (!moment) continue;
      std::vector<BodyMoment> result{{b, *moment}};
      if (other) result.push_back({*other, symbolic::scale(dag, dag.integer(-1), *moment)});
      return result;
    }
  }
  return {};
}

// Three directions span all rotations. Fewer directions that have other effects too determine nothing.
std::optional<Vec3> BodyMoments::moment_on_attitude(std::size_t body, const std::vector<Ref>& Q) {
  std::vector<Vec3> directions;
  std::vector<Ref> along;
  bool alone = true;
  for (std::uint32_t c = 0; c < m_.q.size(); ++c) {
    if (!rotates(body, c)) continue;
    if (!rotates_only(body, c)) {
      alone = false;
      continue;
    }
    directions.push_back(turns_[body][c]);
    along.push_back(Q[c]);
  }
  if (directions.empty() || directions.size() > 4 || (!alone && directions.size() < 3)) return std::nullopt;
  return least(directions, along);
}

bool BodyMoments::rotates_only(std::size_t body, std::uint32_t c) const {
  for (std::size_t other = 0; other < m_.body_rotations.size(); ++other) {
    if (other != body && rotates(other, c)) return false;
  }
  return rotates(body, c) && !moves_[c];
}

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
