// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/prescribed_forces.hpp"

#include <algorithm>

#include "mechanics/imposition.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/factorisation.hpp"

namespace eomgen::analysis {

using mechanics::Mechanics;

namespace {

using mechanics::impose;
using mechanics::Vec3;
using mechanics::write_out;
using symbolic::Dag;
using symbolic::Ref;
using symbolic::SymbolKind;
using system::OutputKind;

class Forces {
 public:
  Forces(Mechanics& m, const system::EquationSystem& s, const std::vector<std::string>& labels)
      : m_(m),
        dag_(*m.dag),
        imposed_(impose(m)),
        written_(write_out(m)),
        Q_(m.q.size(), dag_.zero()),
        power_(dag_.zero()) {
    for (const system::Reaction& reaction : s.reactions) {
      if (std::find(labels.begin(), labels.end(), reaction.label) == labels.end()) continue;
      const mechanics::Constraint& constraint = m.constraints[reaction.constraint];
      for (std::size_t i = 0; i < Q_.size(); ++i) {
        Q_[i] = dag_.add(Q_[i], dag_.mul(reaction.value, finish(constraint.gradient[i])));
      }
      power_ = dag_.sub(power_, dag_.mul(reaction.value, finish(constraint.rate)));
    }
  }

  std::vector<system::Output> outputs() {
    std::vector<system::Output> result;
    for (std::uint32_t i = 0; i < Q_.size(); ++i) {
      if (!mechanics::vanishes(dag_, {Q_[i]}))
        result.push_back({"force." + m_.model->coordinates[i].name, Q_[i], OutputKind::prescribed_force, i});
    }
    for (std::uint32_t p = 0; p < m_.masses.size(); ++p) {
      const std::optional<Vec3> force = on_particle(p);
      if (!force || mechanics::vanishes(dag_, {(*force)[0], (*force)[1], (*force)[2]})) continue;
      for (std::uint32_t k = 0; k < 3; ++k)
        result.push_back(
            {m_.masses[p].name + ".force" + std::to_string(k + 1), (*force)[k], OutputKind::particle_force, p, k});
    }
    result.push_back({"prescribed.power", power_, OutputKind::prescribed_power});
    return result;
  }

 private:
  Ref finish(Ref r) { return written_(imposed_(r)); }
  Ref slope(std::size_t mass, std::size_t k, std::uint32_t i) {
    return symbolic::partial(dag_, {SymbolKind::coordinate, i, 0})(m_.masses[mass].position[k]);
  }
  bool moves(std::uint32_t i, std::size_t mass) {
    return !mechanics::vanishes(dag_, {slope(mass, 0, i), slope(mass, 1, i), slope(mass, 2, i)});
  }

  bool turns(std::uint32_t i) {
    symbolic::Derivation by = symbolic::partial(dag_, {SymbolKind::coordinate, i, 1});
    return std::any_of(m_.spins.begin(), m_.spins.end(), [&](const mechanics::Spin& spin) {
      return !mechanics::vanishes(dag_, {by(spin.w[0]), by(spin.w[1]), by(spin.w[2])});
    });
  }

  // F = J (J^T J)^-1 Q: the least F with F . dr/dq_i = Q_i. What turns a body needs moments too.
  std::optional<Vec3> on_particle(std::size_t p) {
    std::vector<std::uint32_t> own;
    for (std::uint32_t i = 0; i < Q_.size(); ++i) {
      if (!moves(i, p)) continue;
      if (turns(i)) return std::nullopt;
      own.push_back(i);
      for (std::size_t other = 0; other < m_.masses.size(); ++other) {
        if (other != p && moves(i, other)) return std::nullopt;
      }
    }
    const std::size_t n = own.size();
    if (n == 0 || n > 3 || !m_.dag->is_zero(m_.kinetic_given)) return std::nullopt;
    std::vector<Ref> J(3 * n), N(n * n, dag_.zero()), Q;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < n; ++i) J[k * n + i] = finish(slope(p, k, own[i]));
    }
    for (std::size_t i = 0; i < n; ++i) {
      Q.push_back(Q_[own[i]]);
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < 3; ++k) N[i * n + j] = dag_.add(N[i * n + j], dag_.mul(J[k * n + i], J[k * n + j]));
        if (i != j && mechanics::vanishes(dag_, {N[i * n + j]})) N[i * n + j] = dag_.zero();
      }
    }
    const symbolic::Factorisation factors(dag_, N, n, symbolic::Ties::ascending);
    const std::vector<Ref> components = factors.backward(factors.forward(Q));  // along the a_i
    Vec3 force = symbolic::zero_vector(dag_);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < n; ++i) force[k] = dag_.add(force[k], dag_.mul(J[k * n + i], components[i]));
    }
    return force;
  }

  Mechanics& m_;
  Dag& dag_;
  symbolic::Substitution imposed_, written_;
  std::vector<Ref> Q_;
  Ref power_;
};

}  // namespace

std::vector<std::string> prescribing_constraints(const Mechanics& m) {
  std::vector<std::string> result;
  for (const mechanics::Constraint& constraint : m.constraints) {
    const auto fixes = [&](const mechanics::FixedCoordinate& f) {
      return m.constraints[f.constraint].label == constraint.label;
    };
    if (std::any_of(m.fixed.begin(), m.fixed.end(), fixes)) result.push_back(constraint.label);
  }
  return result;
}

std::vector<std::string> add_prescribed_forces(Mechanics& m, system::EquationSystem& s,
                                               const std::vector<std::string>& labels) {
  std::vector<std::string> names;
  for (system::Output& output : Forces(m, s, labels).outputs()) {
    names.push_back(output.name);
    s.outputs.push_back(std::move(output));
  }
  return names;
}

}  // namespace eomgen::analysis
