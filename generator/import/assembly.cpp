// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/assembly.hpp"

#include <fmt/format.h>

#include "import/xml.hpp"
#include "model/names.hpp"

namespace eomgen::import {
namespace {

/// Whether a link or one below it has a mass or an inertia.
std::vector<bool> links_with_mass(const Robot& robot, const Tree& tree) {
  std::vector<bool> result(robot.links.size());
  for (std::size_t i = tree.order.size(); i-- > 0;) {
    const std::size_t link = tree.order[i];
    if (!robot.links[link].inertia.is_zero()) result[link] = true;
    if (result[link] && tree.parent[link] != no_index) result[tree.parent[link]] = true;
  }
  return result;
}

void hold_massless_joints(Robot& robot, const Tree& tree, Assembly& assembly) {
  const std::vector<bool> has_mass = links_with_mass(robot, tree);
  assembly.is_held.assign(robot.joints.size(), false);
  for (const std::size_t link : tree.order) {
    const std::size_t j = tree.joint_above[link];
    if (j == no_index || has_mass[link] || robot.joints[j].type == JointType::fixed) continue;
    assembly.is_held[j] = true;
    robot.findings.add("joints that move no mass", "they are held at zero", robot.joints[j].where);
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j)
    if (tree.master[j] != no_index && !assembly.is_held[j] && assembly.is_held[tree.master[j]])
      fail(robot.joints[j].mimic->where,
           fmt::format("the joint {} follows {}, which moves no mass", model::quote(robot.joints[j].name),
                       model::quote(robot.joints[tree.master[j]].name)),
           "remove <mimic>, or give the link of that joint a mass");
}

}  // namespace

Assembly assemble(Robot& robot, const Tree& tree) {
  Assembly assembly;
  hold_massless_joints(robot, tree, assembly);
  std::vector<std::size_t> part_of(robot.links.size());
  std::vector<Pose> pose(robot.links.size());
  for (const std::size_t link : tree.order) {
    const std::size_t j = tree.joint_above[link];
    const bool is_fused = j != no_index && (robot.joints[j].type == JointType::fixed || assembly.is_held[j]);
    if (!is_fused) {
      Part part;
      part.link = link;
      part.joint = j;
      if (j != no_index) {
        part.parent = part_of[tree.parent[link]];
        part.attachment = pose[tree.parent[link]] * robot.joints[j].origin;
      }
      part_of[link] = assembly.parts.size();
      assembly.parts.push_back(std::move(part));
    } else {
      part_of[link] = part_of[tree.parent[link]];
      pose[link] = pose[tree.parent[link]] * robot.joints[j].origin;
      assembly.parts[part_of[link]].fused.push_back(link);
      assembly.parts[part_of[link]].poses.push_back(pose[link]);
    }
    Part& part = assembly.parts[part_of[link]];
    part.inertia = part.inertia + pose[link] * robot.links[link].inertia;
  }
  for (const Part& part : assembly.parts)
    if (part.inertia.mass.is_zero() && !part.inertia.is_zero())
      fail(robot.links[part.link].where,
           fmt::format("the link {} has an inertia and no mass", model::quote(robot.links[part.link].name)),
           "give it a mass above 0");
  return assembly;
}

}  // namespace eomgen::import
