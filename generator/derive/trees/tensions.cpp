// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/tensions.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "derive/equations.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::derive {
namespace {

constexpr std::uint32_t first_tension = 1u << 24;  // index of the symbols of tensions: beyond those of theta
constexpr std::size_t small = 40;                  // terms: expressions within one link have few

/// Expands short expressions, with sin^2 + cos^2 = 1; leaves others unchanged.
class Tidy {
 public:
  explicit Tidy(Dag& dag)
      : dag_(dag), expand_(dag, small), forces_(dag, small, nullptr, symbolic::PowersOfDifferences::kept) {}
  Ref operator()(Ref r) { return expand_.expand_or_keep(r); }
  Ref dot(const Vec3& a, const Vec3& b) { return (*this)(symbolic::dot(dag_, a, b)); }
  Ref component(const Vec3& direction, const Vec3& force) {
    return forces_.expand_or_keep(symbolic::dot(dag_, direction, force));
  }

 private:
  Dag& dag_;
  symbolic::Expander expand_, forces_;
};

/// Summands of a sum with their factors, so that those shared with the parent cancel exactly.
void gather(const Dag& dag, Ref root, const symbolic::Rational& factor, std::map<Ref, symbolic::Rational>& sum) {
  std::vector<std::pair<Ref, symbolic::Rational>> open{{root, factor}};
  while (!open.empty()) {
    const auto [r, c] = open.back();
    open.pop_back();
    const symbolic::Node& node = dag[r];
    switch (node.op) {
      case symbolic::Op::add:
      case symbolic::Op::sub:
        open.emplace_back(node.args[0], c);
        open.emplace_back(node.args[1], node.op == symbolic::Op::add ? c : -c);
        break;
      case symbolic::Op::neg: open.emplace_back(node.args[0], -c); break;
      default: sum[r] = sum[r] + c;
    }
  }
}

Ref difference(Dag& dag, Ref a, Ref b) {
  std::map<Ref, symbolic::Rational> sum;
  gather(dag, a, 1, sum);
  gather(dag, b, -1, sum);
  Ref result = dag.zero();
  for (const auto& [r, c] : sum) result = dag.add(result, dag.mul(dag.constant(c), r));
  return result;
}

/// +- v / |v| if |v| is a simple expression, otherwise v.
Vec3 unit_if_plain(Dag& dag, Tidy& tidy, const Vec3& v) {
  Ref length = dag.call(symbolic::Op::sqrt, tidy.dot(v, v));
  if (dag[length].op == symbolic::Op::abs) length = dag[length].args[0];
  if (dag[length].op == symbolic::Op::sqrt) return v;
  Vec3 unit;
  for (std::size_t i = 0; i < 3; ++i) unit[i] = tidy(dag.div(v[i], length));
  return unit;
}

/// The axis along which nothing moves, if there is one: the tree is planar then.
std::optional<std::size_t> still_axis(const Dag& dag, const ParticleTree& tree) {
  for (std::size_t axis = 3; axis-- > 0;) {
    if (std::all_of(tree.J.begin(), tree.J.end(), [&](const Vec3& J) { return dag.is_zero(J[axis]); })) return axis;
  }
  return std::nullopt;
}

Vec3 unit(Dag& dag, std::size_t axis) {
  Vec3 e = symbolic::zero_vector(dag);
  e[axis] = dag.one();
  return e;
}

/// Directions normal to all J of a link and to one another, none along the axis `still`: the link itself if it is one,
/// otherwise cross products. Empty if the J leave a plane without a simple basis.
std::optional<std::vector<Vec3>> normals(Dag& dag, Tidy& tidy, const TensionLink& loaded, const Vec3& along,
                                         std::optional<std::size_t> still) {
  const std::size_t left = (still ? 2 : 3) - loaded.J.size();
  if (left == 0) return std::vector<Vec3>{};
  const bool is_rod = !is_zero(dag, along) && std::all_of(loaded.J.begin(), loaded.J.end(), [&](const Vec3& J) {
    return dag.is_zero(tidy.dot(along, J));
  });
  if (left == 1 && is_rod) return std::vector<Vec3>{unit_if_plain(dag, tidy, along)};
  if (left == 1) {
    const Vec3 second = still ? unit(dag, *still) : loaded.J[1];
    return std::vector<Vec3>{unit_if_plain(dag, tidy, cross(dag, loaded.J[0], second))};
  }
  for (std::size_t axis = 3; axis-- > 0 && left == 2;) {  // J in a plane: its normal, and one in the plane
    if (!dag.is_zero(loaded.J[0][axis])) continue;
    const Vec3 e = unit(dag, axis);
    return std::vector<Vec3>{e, unit_if_plain(dag, tidy, cross(dag, loaded.J[0], e))};
  }
  return std::nullopt;
}

/// The linear system of the tensions, and the accelerations that follow.
class Tensions {
 public:
  Tensions(Dag& dag, const ParticleTree& tree, const TensionLinks& links)
      : dag_(dag), tidy_(dag), tree_(tree), links_(links) {
    for (std::size_t k = 0; k < links_.links.size(); ++k) {
      free_.push_back(free_force(links_.links[k]));
      for (const Vec3& N : links_.links[k].N) tension_directions_.push_back({k, N});
    }
  }

  system::Solution solve() {
    system::Solution result{std::vector<Ref>(tree_.J.size()), {}, {}};
    auto [S, b] = equations();
    symbolic::Factorisation factors(dag_, std::move(S), b.size(), symbolic::Ties::descending);
    tension_ = factors.backward(factors.forward(b));
    result.pivots = factors.pivots();
    for (std::size_t k = 0; k < links_.links.size(); ++k) second_rates(k, result);
    return result;
  }

  system::InternalForces unknowns() {
    system::InternalForces result;
    solve();
    result.values = tension_;
    std::tie(result.matrix, result.side) = equations();
    for (std::uint32_t i = 0; i < tension_.size(); ++i) {
      result.symbols.push_back({symbolic::SymbolKind::auxiliary, first_tension + i, 0});
      tension_[i] = dag_.symbol(result.symbols.back());
    }
    system::Solution accelerations{std::vector<Ref>(tree_.J.size()), {}, {}};
    for (std::size_t k = 0; k < links_.links.size(); ++k) second_rates(k, accelerations);
    result.qddot = std::move(accelerations.qddot);
    return result;
  }

 private:
  /// S and b of S T = b.
  std::pair<std::vector<Ref>, std::vector<Ref>> equations() {
    const std::size_t n = tension_directions_.size();
    std::vector<Ref> S(n * n), b;
    for (std::size_t i = 0; i < n; ++i) {
      const auto& [k, N] = tension_directions_[i];
      for (std::size_t j = 0; j <= i; ++j) {
        S[i * n + j] = S[j * n + i] = response(k, N, tension_directions_[j].first, tension_directions_[j].second);
      }
      b.push_back(dag_.neg(relative(k, N)));
    }
    return {std::move(S), std::move(b)};
  }

  /// W_k / m_first: the force along the J that is equivalent to f_k on theta_k.
  Vec3 free_force(const TensionLink& loaded) {
    const Vec3 none = symbolic::zero_vector(dag_);
    std::vector<Ref> f;
    for (const std::size_t a : loaded.joints) f.push_back(dag_.div(tree_.f[a], links_.first_mass));
    if (std::all_of(f.begin(), f.end(), [this](Ref r) { return dag_.is_zero(r); })) return none;
    const std::vector<Ref> x = along_joints(loaded, f, nullptr);
    Vec3 W = none;
    for (std::size_t a = 0; a < x.size(); ++a) {
      for (std::size_t i = 0; i < 3; ++i) W[i] = dag_.add(W[i], dag_.mul(loaded.J[a][i], x[a]));
    }
    return W;
  }

  /// x with J_a . sum_b J_b x_b = r_a.
  std::vector<Ref> along_joints(const TensionLink& loaded, const std::vector<Ref>& r,
                                std::vector<symbolic::Pivot>* pivots) {
    const std::size_t n = loaded.J.size();
    std::vector<Ref> gram(n * n);
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b <= a; ++b) gram[a * n + b] = gram[b * n + a] = tidy_.dot(loaded.J[a], loaded.J[b]);
    }
    symbolic::Factorisation factors(dag_, std::move(gram), n, symbolic::Ties::ascending);
    if (pivots != nullptr) pivots->insert(pivots->end(), factors.pivots().begin(), factors.pivots().end());
    return factors.backward(factors.forward(r));
  }

  /// The acceleration of particle k relative to its parent along `direction`, per unit of tension or free force of link
  /// `source` along `force`.
  Ref response(std::size_t k, const Vec3& direction, std::size_t source, const Vec3& force) {
    // `force` acts on the particle of `source` and, reversed, on its parent.
    const auto weight_at = [&](int particle) {
      Ref w = dag_.zero();
      if (particle == static_cast<int>(source)) w = dag_.add(w, links_.links[source].inverse_mass_ratio);
      if (particle >= 0 && particle == links_.links[source].parent) {
        w = dag_.sub(w, links_.links[static_cast<std::size_t>(particle)].inverse_mass_ratio);
      }
      return w;
    };
    const Ref w = dag_.sub(weight_at(static_cast<int>(k)), weight_at(links_.links[k].parent));
    if (dag_.is_zero(w)) return w;
    // Within one link sines and cosines combine to squares, and normals are orthogonal.
    const Ref along = k == source ? tidy_.component(direction, force) : dot(dag_, direction, force);
    return dag_.mul(w, along);
  }

  /// a_k - a_parent - c_k along `direction` without tensions.
  Ref relative(std::size_t k, const Vec3& direction) {
    const TensionLink& loaded = links_.links[k];
    Ref sum = dag_.neg(tidy_.dot(direction, loaded.c));
    if (loaded.parent < 0) sum = dag_.add(sum, dot(dag_, direction, tree_.gravity));
    for (std::size_t s = 0; s < links_.links.size(); ++s) sum = dag_.add(sum, response(k, direction, s, free_[s]));
    return sum;
  }

  void second_rates(std::size_t k, system::Solution& result) {
    const TensionLink& loaded = links_.links[k];
    std::vector<Ref> r;
    for (const Vec3& J : loaded.J) {
      Ref sum = relative(k, J);
      for (std::size_t i = 0; i < tension_directions_.size(); ++i) {
        const auto& [source, N] = tension_directions_[i];
        if (source != k) sum = dag_.add(sum, dag_.mul(response(k, J, source, N), tension_[i]));
      }
      r.push_back(sum);
    }
    const std::vector<Ref> x = along_joints(loaded, r, &result.pivots);
    for (std::size_t a = 0; a < x.size(); ++a) result.qddot[loaded.joints[a]] = x[a];
  }

  Dag& dag_;
  Tidy tidy_;
  const ParticleTree& tree_;
  const TensionLinks& links_;
  std::vector<Vec3> free_;                                        // W of each link
  std::vector<std::pair<std::size_t, Vec3>> tension_directions_;  // link, direction
  std::vector<Ref> tension_;                                      // T / m_first, for each of these
};

}  // namespace

std::optional<TensionLinks> tension_links(Dag& dag, const ParticleTree& tree) {
  Tidy tidy(dag);
  const std::optional<std::size_t> still = still_axis(dag, tree);
  const std::size_t dimensions = still ? 2 : 3;
  symbolic::Derivation bias = tree.coordinates.bias(dag);
  TensionLinks result;
  for (const Link& link : tree.links) {
    if (link.particles.size() != 1 || link.joints.size() > dimensions) return {};
    const TreeParticle& particle = tree.particles[link.particles[0]];
    if (dag.is_zero(particle.mass) || !dag.is_zero(bias(particle.mass))) return {};
    TensionLink loaded{link.parent, {}, link.joints, {}, {}, {}};
    if (result.links.empty()) result.first_mass = particle.mass;
    loaded.inverse_mass_ratio = dag.div(result.first_mass, particle.mass);
    for (const std::size_t a : link.joints) loaded.J.push_back(tree.J[a]);
    Vec3 along = particle.position;
    if (link.parent >= 0) {
      const Link& parent = tree.links[static_cast<std::size_t>(link.parent)];
      const Vec3& from = tree.particles[parent.particles[0]].position;
      for (std::size_t i = 0; i < 3; ++i) along[i] = difference(dag, along[i], from[i]);
    }
    for (std::size_t i = 0; i < 3; ++i) loaded.c[i] = bias(bias(along[i]));
    const std::optional<std::vector<Vec3>> N = normals(dag, tidy, loaded, along, still);
    if (!N) return {};
    loaded.N = *N;
    result.links.push_back(std::move(loaded));
  }
  return result;
}

system::Solution tree_accelerations(Dag& dag, const ParticleTree& tree, const TensionLinks& links) {
  return Tensions(dag, tree, links).solve();
}

std::optional<system::InternalForces> tree_tensions(Mechanics& m) {
  if (!m.active.empty()) return std::nullopt;
  Dag& dag = *m.dag;
  const std::optional<ParticleTree> tree = particle_tree(m, m.free, true);
  if (!tree || tree->links.size() < 2) return std::nullopt;  // of one particle the mass would no longer cancel
  const std::optional<TensionLinks> links = tension_links(dag, *tree);
  if (!links) return std::nullopt;
  // The applied forces are not expanded: norms in them keep their sums of squares (symbolic/norm_slope.hpp).
  ParticleTree plain = *tree;
  std::map<symbolic::Symbol, Ref> applied;
  for (std::uint32_t a = 0; a < plain.f.size(); ++a) {
    if (dag.is_zero(plain.f[a])) continue;
    const symbolic::Symbol force{symbolic::SymbolKind::auxiliary, first_tension + a, 1};
    applied[force] = plain.f[a];
    plain.f[a] = dag.symbol(force);
  }
  system::InternalForces forces = Tensions(dag, plain, *links).unknowns();
  if (forces.symbols.empty()) return std::nullopt;
  symbolic::Substitution as_applied(dag, std::move(applied)), back = tree->coordinates.back(dag);
  for (auto* list : {&forces.matrix, &forces.side, &forces.values, &forces.qddot}) {
    for (Ref& r : *list) r = back(as_applied(r));
  }
  if (!tree->coordinates.identity()) forces.qddot = symbolic::multiply(dag, tree->coordinates.S_inverse, forces.qddot);
  return forces;
}

}  // namespace eomgen::derive
