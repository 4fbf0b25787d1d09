// SPDX-License-Identifier: GPL-3.0-or-later
// Joints: checks that their points are fixed in the bodies, and adds their reactions. docs/theory.md, "Joints".
#include <algorithm>

#include "mechanics/stages.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/zero_proof.hpp"

namespace eomgen::mechanics {
const char* name(Redundancy need) {
  switch (need) {
    case Redundancy::independent: return "independent";
    case Redundancy::identity: return "identity";
    default: return "redundant";
  }
}

void add_joints(Mechanics& m, Lowering& lower) {
  Dag& dag = *m.dag;
  for (const model::Joint& joint : m.model->joints) {
    for (const model::NodeId drift : joint.drift) {
      if (drift == model::no_node) continue;
      const Vec3 v = lower.vector(drift);
      if (vanishes(dag, {v[0], v[1], v[2]})) continue;
      throw Error(
          "mechanics", m.model->where(m.model->arena[drift].span),
          "this point of the joint '" + joint.name + "' is not fixed in its body",
          "make it of the body, its axes and lengths, such as \"B - L/2*B.e1\", or name a [[point]] with on = \"B\"");
    }
    JointReaction reaction;
    const auto own = [&](const Constraint& c) { return c.name == joint.name; };
    reaction.first = static_cast<std::uint32_t>(std::find_if(m.constraints.begin(), m.constraints.end(), own) -
                                                m.constraints.begin());
    const std::size_t last = joint.axes == 0 ? 0 : m.model->frames[joint.axes].stages.size() - 1;
    for (std::size_t j = 0; j < reaction.along.size(); ++j) {
      const Vec3 e = lower.axis(joint.axes, last, j % 3);
      for (std::size_t k = 0; k < joint.force.size(); ++k) {
        const model::NodeId of = j < 3 ? joint.force[k] : joint.moment[k];
        reaction.along[j].push_back(of == model::no_node ? dag.zero() : lower.dot(lower.vector(of), e));
        if (m.constraints[reaction.first + k].redundancy == Redundancy::identity &&
            !vanishes(dag, {reaction.along[j].back()}))
          reaction.determined[j] = false;
      }
    }
    m.joints.push_back(std::move(reaction));
  }
}

bool holds_identically(Dag& dag, Ref psi) {
  if (vanishes(dag, {psi})) return true;
  if (is_somewhere_nonzero(dag, psi)) return false;
  symbolic::ProductBudget effort{2'000'000};
  return symbolic::is_proven_zero(dag, psi, &effort);
}

}  // namespace eomgen::mechanics
