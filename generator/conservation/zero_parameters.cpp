// SPDX-License-Identifier: GPL-3.0-or-later
#include "conservation/zero_parameters.hpp"

#include <algorithm>
#include <map>

#include "symbolic/calculus.hpp"

namespace eomgen::conservation {
namespace {

using mechanics::Vec3;

using Parameters = std::vector<std::uint32_t>;

Parameters zero_parameters(const Mechanics& m) {
  Parameters result;
  for (std::uint32_t i = 0; i < m.parameter_value.size(); ++i) {
    if (m.dag->is_zero(m.parameter_value[i])) result.push_back(i);
  }
  return result;
}

/// Mechanics and equations with some parameters replaced by 0, as far as the search for conserved quantities reads
/// them.
class Replaced {
 public:
  Replaced(const Mechanics& m, const system::EquationSystem& s, const Parameters& parameters)
      : mechanics(m), system(s), at_zero_(*m.dag, zeros(m, parameters)) {
    replace_forces();
    replace_masses();
    for (mechanics::FixedCoordinate& fixed : mechanics.fixed) replace({&fixed.value, &fixed.rate, &fixed.acceleration});
    replace_all(mechanics.function_value);
    mechanics.integrals.clear();  // known already
    replace({&system.energy, &system.kinetic, &system.potential, &system.power});
    replace_all(system.A);
    replace_all(system.b);
  }

  Mechanics mechanics;
  system::EquationSystem system;

 private:
  static std::map<symbolic::Symbol, Ref> zeros(const Mechanics& m, const Parameters& parameters) {
    std::map<symbolic::Symbol, Ref> result;
    for (const std::uint32_t i : parameters) result[{SymbolKind::parameter, i, 0}] = m.dag->zero();
    return result;
  }
  void replace_forces() {
    for (std::vector<Ref>& components : mechanics.force_components) replace_all(components);
    for (mechanics::Load& load : mechanics.loads) {
      for (Vec3* v : {&load.force, &load.at, &load.at_velocity}) replace_vector(*v);
    }
    for (mechanics::Constraint& constraint : mechanics.constraints) {
      replace({&constraint.psi, &constraint.rate});
      replace_all(constraint.gradient);
    }
    replace_all(mechanics.potential_by_force);
    replace({&mechanics.potential, &mechanics.stored});
  }
  void replace_masses() {
    replace({&mechanics.kinetic_given, &mechanics.kinetic});
    for (mechanics::PointMass& mass : mechanics.masses) {
      replace({&mass.mass});
      replace_vector(mass.position), replace_vector(mass.velocity);
    }
    for (mechanics::BodyRotation& body : mechanics.body_rotations) {
      for (Vec3& axis : body.axes) replace_vector(axis);
      for (auto& row : body.J) {
        for (Ref& entry : row) replace({&entry});
      }
      for (Ref& w : body.w) replace({&w});
      for (Ref& w : body.axes_angular_velocity) replace({&w});
    }
  }
  void replace(std::initializer_list<Ref*> expressions) {
    for (Ref* r : expressions) *r = at_zero_(*r);
  }
  void replace_all(std::vector<Ref>& expressions) {
    for (Ref& r : expressions) r = at_zero_(r);
  }
  void replace_vector(Vec3& v) {
    for (Ref& r : v) r = at_zero_(r);
  }

  symbolic::Substitution at_zero_;
};

bool has(const std::vector<ConservedQuantity>& all, const std::string& name) {
  return std::any_of(all.begin(), all.end(), [&](const ConservedQuantity& c) { return c.name == name; });
}

std::vector<ConservedQuantity> conserved_at(const Mechanics& m, const system::EquationSystem& s,
                                            const Parameters& parameters) {
  Replaced replaced(m, s, parameters);
  return conserved_quantities(replaced.mechanics, replaced.system);
}

}  // namespace

std::vector<ConservedQuantity> conserved_where_zero(const Mechanics& m, const system::EquationSystem& s,
                                                    const std::vector<ConservedQuantity>& known) {
  const Parameters all = zero_parameters(m);
  if (all.empty()) return {};
  std::vector<ConservedQuantity> result;
  for (ConservedQuantity& c : conserved_at(m, s, all)) {
    // The Jacobi integral is that energy, if the energy is conserved too.
    if (has(known, c.name) || (c.kind == system::OutputKind::jacobi && has(known, "energy"))) continue;
    c.zero_parameters = all;
    result.push_back(std::move(c));
  }
  if (all.size() > most_zero_parameters) return result;
  std::map<Parameters, std::vector<ConservedQuantity>> tried;
  for (ConservedQuantity& c : result) {
    for (const std::uint32_t parameter : all) {
      Parameters fewer = c.zero_parameters;
      std::erase(fewer, parameter);
      if (fewer.empty()) continue;
      auto found = tried.find(fewer);
      if (found == tried.end()) found = tried.emplace(fewer, conserved_at(m, s, fewer)).first;
      if (has(found->second, c.name)) c.zero_parameters = fewer;
    }
  }
  return result;
}

}  // namespace eomgen::conservation
