// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/prescribed_forces.hpp"

#include <algorithm>

#include "mechanics/imposition.hpp"
#include "mechanics/particle_force.hpp"
#include "mechanics/vanishes.hpp"

namespace eomgen::analysis {

using mechanics::Mechanics;

namespace {

using mechanics::constraint_substitution;
using mechanics::time_function_substitution;
using mechanics::Vec3;
using symbolic::Dag;
using symbolic::Ref;
using symbolic::SymbolKind;
using system::OutputKind;

class Forces {
 public:
  Forces(Mechanics& m, const system::EquationSystem& s, const std::vector<std::string>& labels)
      : m_(m),
        dag_(*m.dag),
        imposed_(constraint_substitution(m)),
        written_(time_function_substitution(m)),
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
      const std::optional<Vec3> force = mechanics::force_on_particle(m_, p, Q_);
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
