// SPDX-License-Identifier: GPL-3.0-or-later
// The tree with links on fixed joints fused into those that move, and joints without a mass behind them held.
#pragma once

#include <cstddef>
#include <vector>

#include "import/robot.hpp"

namespace eomgen::import {

// Links and joints as one tree. Throws Error for missing links, links with two joints above them, several roots, and
// cycles; and for mimics of unknown joints or of one another.

inline constexpr std::size_t no_index = static_cast<std::size_t>(-1);

struct Tree {
  std::size_t root;  // index of a link
  std::vector<std::size_t>
      joint_above;                  // of each link, the index of the joint whose child it is; `no_index` of the root
  std::vector<std::size_t> parent;  // of each link, the link that this joint hangs on
  std::vector<std::size_t> order;   // links, parents first, siblings in the order of their joints
  std::vector<std::size_t> master;  // of each joint with a mimic, the joint that it follows; else `no_index`
};

Tree build_tree(const Robot& robot);

/// A link that moves relative to the ground, or the root, with what is rigidly connected to it.
struct Part {
  std::size_t link;                // whose axes and origin these are
  std::size_t parent = no_index;   // index of a part before this one; `no_index` of the root
  std::size_t joint = no_index;    // of the robot, to the parent; `no_index` of the root
  Pose attachment;                 // of the joint at zero, in the parent's axes
  Inertia inertia;                 // in own axes, of all links
  std::vector<std::size_t> fused;  // further links
  std::vector<Pose> poses;         // of each of them, in own axes
};

struct Assembly {
  std::vector<Part> parts;    // parents first; parts[0] is the root
  std::vector<bool> is_held;  // of each joint: it moves no mass, and is fixed at zero
};

/// Reports held joints as findings of the robot.
Assembly assemble(Robot& robot, const Tree& tree);

}  // namespace eomgen::import
