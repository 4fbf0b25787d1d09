// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/argument.hpp"

namespace eomgen::verify {

const model::Argument* argument(const model::Force& force, std::string_view key) {
  for (const model::Argument& candidate : force.arguments) {
    if (candidate.name == key) return &candidate;
  }
  return nullptr;
}

model::NodeId argument_expression(const model::Force& force, std::string_view key) {
  const model::Argument* found = argument(force, key);
  return found == nullptr ? model::no_node : found->value;
}

}  // namespace eomgen::verify
