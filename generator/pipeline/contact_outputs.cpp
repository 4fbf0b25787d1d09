// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/contact_outputs.hpp"

namespace eomgen::pipeline {

using system::OutputKind;

std::vector<run::ContactOutputs> contact_outputs(const system::EquationSystem& system) {
  std::vector<run::ContactOutputs> result;
  if (system.contacts.empty()) return result;
  for (const system::Contact& contact : system.contacts) {
    result.emplace_back().slopes.resize(contact.slip.size());
    if (contact.unilateral) result.back().constraint = *contact.unilateral;
  }
  for (const system::Output& output : system.outputs) {
    switch (output.kind) {
      case OutputKind::slip: result[output.index].slip.push_back(output.name); break;
      case OutputKind::friction_component: result[output.index].phi.push_back(output.name); break;
      case OutputKind::slip_slope: result[output.index].slopes[output.part].push_back(output.name); break;
      case OutputKind::restitution: result[output.index].restitution = output.name; break;
      case OutputKind::normal_scale: result[output.index].normal_scale = output.name; break;
      default: break;
    }
  }
  return result;
}

std::vector<std::string> output_names(const run::ContactOutputs& contact) {
  std::vector<std::string> names = contact.slip;
  names.insert(names.end(), contact.phi.begin(), contact.phi.end());
  for (const std::vector<std::string>& slopes : contact.slopes) names.insert(names.end(), slopes.begin(), slopes.end());
  if (!contact.restitution.empty()) names.push_back(contact.restitution);
  if (!contact.normal_scale.empty()) names.push_back(contact.normal_scale);
  return names;
}

}  // namespace eomgen::pipeline
