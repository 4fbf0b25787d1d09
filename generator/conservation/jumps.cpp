// SPDX-License-Identifier: GPL-3.0-or-later
#include "conservation/jumps.hpp"

namespace eomgen::conservation {

using symbolic::Op;
using symbolic::Ref;

std::vector<Ref> jump_surfaces(symbolic::Dag& dag, const std::vector<Ref>& roots) {
  std::vector<Ref> result;
  for (const Ref r : dag.reachable(roots)) {
    const symbolic::Node node = dag[r];
    if (node.op == Op::sign) result.push_back(node.args[0]);
    if (node.op == Op::select) result.push_back(dag.sub(node.args[0], node.args[1]));
  }
  return result;
}

}  // namespace eomgen::conservation
