// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/assembly.hpp"

#include <fmt/format.h>

#include <map>

#include "import/xml.hpp"
#include "model/names.hpp"

namespace eomgen::import {

using Indices = std::map<std::string, std::size_t>;

namespace {

std::size_t find_name(const Indices& indices, const std::string& kind, const std::string& name,
                      const SourceLocation& where) {
  const auto found = indices.find(name);
  if (found != indices.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [candidate, index] : indices) known.push_back(candidate);
  const std::string hint = model::did_you_mean(name, known);
  fail(where, fmt::format("there is no {} {}", kind, model::quote(name)),
       hint.empty() ? fmt::format("add the {}, or correct the name", kind) : hint);
}

void attach_links(const Robot& robot, Tree& tree) {
  Indices links;
  for (std::size_t i = 0; i < robot.links.size(); ++i) links.emplace(robot.links[i].name, i);
  tree.joint_above.assign(robot.links.size(), no_index);
  tree.parent.assign(robot.links.size(), no_index);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const Joint& joint = robot.joints[j];
    const std::size_t parent = find_name(links, "link", joint.parent, joint.parent_where);
    const std::size_t child = find_name(links, "link", joint.child, joint.child_where);
    if (tree.joint_above[child] != no_index)
      fail(joint.child_where,
           fmt::format("the link {} is the child of two joints, {} and {}", model::quote(joint.child),
                       model::quote(robot.joints[tree.joint_above[child]].name), model::quote(joint.name)),
           "a robot is a tree; add the joint that closes a loop to the written model as a [[joint]]");
    tree.joint_above[child] = j;
    tree.parent[child] = parent;
  }
}

void find_root(const Robot& robot, Tree& tree) {
  tree.root = no_index;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (tree.parent[i] != no_index) continue;
    if (tree.root != no_index)
      fail(robot.links[i].where,
           fmt::format("the links {} (line {}) and {} are both roots", model::quote(robot.links[tree.root].name),
                       robot.links[tree.root].where.line, model::quote(robot.links[i].name)),
           "connect one of them by a joint; a fixed one if it does not move");
    tree.root = i;
  }
  if (tree.root == no_index)
    fail(robot.joints.front().where, "the joints form a cycle: every link is the child of a joint",
         "a robot is a tree; one link has no joint above it");
}

void order_links(const Robot& robot, Tree& tree) {
  std::vector<std::vector<std::size_t>> children(robot.links.size());
  std::vector<std::size_t> child(robot.joints.size());
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (tree.joint_above[i] != no_index) child[tree.joint_above[i]] = i;
  for (const std::size_t link : child) children[tree.parent[link]].push_back(link);
  std::vector<std::size_t> waiting{tree.root};
  while (!waiting.empty()) {
    const std::size_t link = waiting.back();
    waiting.pop_back();
    tree.order.push_back(link);
    waiting.insert(waiting.end(), children[link].rbegin(), children[link].rend());
  }
  if (tree.order.size() == robot.links.size()) return;
  std::vector<bool> reached(robot.links.size(), false);
  for (const std::size_t link : tree.order) reached[link] = true;
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (!reached[i])
      fail(robot.joints[tree.joint_above[i]].child_where,
           fmt::format("the link {} is in a cycle of joints, which the root {} does not reach",
                       model::quote(robot.links[i].name), model::quote(robot.links[tree.root].name)),
           "a robot is a tree; correct the parents of these joints");
}

void connect_mimics(const Robot& robot, Tree& tree) {
  Indices joints;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) joints.emplace(robot.joints[j].name, j);
  tree.master.assign(robot.joints.size(), no_index);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    if (!robot.joints[j].mimic) continue;
    const Mimic& mimic = *robot.joints[j].mimic;
    tree.master[j] = find_name(joints, "joint", mimic.master, mimic.where);
    const JointType type = robot.joints[tree.master[j]].type;
    if (type == JointType::fixed || type == JointType::floating || type == JointType::planar || type == JointType::ball)
      fail(
          mimic.where,
          fmt::format("{} is a {} joint, which has no coordinate to follow", model::quote(mimic.master), name_of(type)),
          "name a revolute, continuous or prismatic joint");
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    std::size_t steps = 0;
    for (std::size_t at = j; at != no_index; at = tree.master[at])
      if (++steps > robot.joints.size())
        fail(robot.joints[j].mimic->where,
             fmt::format("the joint {} follows itself", model::quote(robot.joints[j].name)),
             "one joint of those that follow one another has no <mimic>");
  }
}

}  // namespace

Tree build_tree(const Robot& robot) {
  Tree tree{};
  attach_links(robot, tree);
  find_root(robot, tree);
  order_links(robot, tree);
  connect_mimics(robot, tree);
  return tree;
}

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
