// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/uses.hpp"

#include <unordered_set>

namespace eomgen::verify {

bool uses(const model::Model& model, model::NodeId expression, const std::function<bool(const model::Node&)>& is_it) {
  using model::Op;
  std::vector<model::NodeId> open{expression};
  std::unordered_set<model::NodeId> seen;
  while (!open.empty()) {
    const model::NodeId id = open.back();
    open.pop_back();
    if (id == model::no_node || !seen.insert(id).second) continue;
    const model::Node& node = model.arena[id];
    if (is_it(node)) return true;
    open.insert(open.end(), node.args.begin(), node.args.end());
    switch (node.op) {
      case Op::definition: open.push_back(model.definitions[node.index].expression); break;
      case Op::place:
      case Op::place_velocity:
      case Op::place_acceleration:
      case Op::unit_basis:
      case Op::covariant_basis:
      case Op::contravariant_basis: open.push_back(model.places[node.index].position); break;
      case Op::axis: open.push_back(model.frames[node.index].stages[node.order / 3].e[node.order % 3]); break;
      case Op::angular_velocity:
        if (node.index > 0)
          open.insert(open.end(), model.frames[node.index].stages.back().e.begin(),
                      model.frames[node.index].stages.back().e.end());
        break;
      default: break;
    }
  }
  return false;
}

}  // namespace eomgen::verify
