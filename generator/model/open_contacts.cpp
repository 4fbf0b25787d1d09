// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/open_contacts.hpp"

#include <algorithm>

namespace eomgen::model {

std::shared_ptr<const Model> without_open_contacts(const Model& model, const std::vector<std::string>& open) {
  auto result = std::make_shared<Model>(model);
  result->content_hash.clear();
  result->constraints.clear();
  constexpr std::uint32_t removed = 0xffffffffu;
  std::vector<std::uint32_t> index;  // of each constraint in the result
  for (const Constraint& constraint : model.constraints) {
    const bool leaves = constraint.unilateral && std::find(open.begin(), open.end(), constraint.name) != open.end();
    index.push_back(leaves ? removed : static_cast<std::uint32_t>(result->constraints.size()));
    if (!leaves) result->constraints.push_back(constraint);
  }
  for (Joint& joint : result->joints) joint.constraint = index[joint.constraint];
  for (Node& node : result->arena.nodes) {
    if (node.op != Op::reaction) continue;
    const std::uint32_t now = index[node.index];
    if (now != removed) {
      node.index = now;
      continue;
    }
    const Span span = node.span;
    node = Node{};
    node.span = span;
  }
  return result;
}

}  // namespace eomgen::model
