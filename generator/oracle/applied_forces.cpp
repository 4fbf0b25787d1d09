// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/applied_forces.hpp"

#include "oracle/forces/force_law.hpp"

namespace eomgen::verify {
std::vector<Mass> list_masses(const model::Model& model) {
  std::vector<Mass> result;
  for (const model::Particle& particle : model.particles) result.push_back({particle.place, particle.mass});
  for (const model::Body& body : model.bodies) result.push_back({body.place, body.mass});
  return result;
}

Vector inertia_times(const model::Body& body, Interpreter& at, const Vector& v) {
  Vector sum;
  for (std::size_t i = 0; i < 3; ++i) {
    Jet component;
    for (std::size_t k = 0; k < 3; ++k)
      component = component + at.scalar(body.inertia[i][k]) * dot(at.axis(body.frame, k), v);
    sum = sum + component * at.axis(body.frame, i);
  }
  return sum;
}

void subtract_forces(const model::Model& model, const Precision& precision, Interpreter& now,
                     std::vector<Residual>& sums) {
  VirtualWork work(model, precision, now, sums);
  for (const model::Force& force : model.forces) forces::force_law(force.kind).add_virtual_work(force, work);
}

std::vector<Jet> potentials(const model::Model& model, const Precision& precision, Interpreter& at) {
  std::vector<Jet> terms;
  if (model.energy.potential != model::no_node) terms.push_back(at.scalar(model.energy.potential));
  Potentials sum{model, precision, at, terms};
  for (const model::Force& force : model.forces) {
    if (const auto potential = forces::force_law(force.kind).potential) potential(force, sum);
  }
  return terms;
}

}  // namespace eomgen::verify
