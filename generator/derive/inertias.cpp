// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/inertias.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "derive/imposition.hpp"

namespace eomgen::derive {

system::Inertias inertias(Mechanics& m) {
  Dag& dag = *m.dag;
  const model::Model& model = *m.model;
  symbolic::Substitution imposed = constraint_substitution(m), written = time_function_substitution(m);
  std::map<Symbol, Ref> none;
  for (const std::uint32_t i : m.free) none[{SymbolKind::coordinate, i, 2}] = dag.zero();
  symbolic::Substitution at_rest(dag, std::move(none));
  const auto finish = [&](Ref r) { return written(imposed(at_rest(r))); };
  symbolic::Derivation ddt = symbolic::total_time_derivative(dag, m.q.size(), model.functions.size());

  system::Inertias result{{}, symbolic::zero_vector(dag)};
  for (const model::Force& force : model.forces)
    if (force.acceleration() != model::no_node)
      result.gravity = symbolic::add(dag, result.gravity, mechanics::lower_vector(m, force.acceleration()));
  for (Ref& component : result.gravity) component = finish(component);
  for (const mechanics::PointMass& mass : m.masses) {
    system::Inertia one{mass.place - 1, finish(mass.mass), {}};
    const auto body = std::find_if(model.bodies.begin(), model.bodies.end(),
                                   [&](const model::Body& b) { return b.place == mass.place; });
    if (body != model.bodies.end()) {
      system::BodyInertia& spinning = one.body.emplace();
      for (std::size_t i = 0, place = 0; i < 3; ++i) {
        for (std::size_t k = i; k < 3; ++k)
          spinning.tensor[place++] = finish(mechanics::lower_scalar(m, body->inertia[i][k]));
        // The rate of w along the axes that turn with it: w x w = 0.
        const Ref w = m.angular_velocity[body->frame][i];
        spinning.spin[i] = finish(w);
        spinning.bias[i] = finish(ddt(w));
      }
    }
    result.of.push_back(std::move(one));
  }
  return result;
}

std::vector<std::string> inertial_parameter_names(const model::Model& model) {
  std::vector<std::string> names;
  for (const model::Particle& particle : model.particles) names.push_back(model.places[particle.place].name + ".mass");
  for (const model::Body& body : model.bodies) {
    const std::string& name = model.places[body.place].name;
    for (int i = 1; i <= 3; ++i)
      for (int k = i; k <= 3; ++k) names.push_back(fmt::format("{}.inertia{}{}", name, i, k));
    for (int i = 1; i <= 3; ++i) names.push_back(fmt::format("{}.moment{}", name, i));
    names.push_back(name + ".mass");
  }
  return names;
}

}  // namespace eomgen::derive
