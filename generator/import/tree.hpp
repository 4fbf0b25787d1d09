// SPDX-License-Identifier: GPL-3.0-or-later
// Links and joints as one tree. Throws Error for missing links, links with two joints above them, several roots, and
// cycles; and for mimics of unknown joints or of one another.
#pragma once

#include <cstddef>
#include <vector>

#include "import/robot.hpp"

namespace eomgen::import {

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

}  // namespace eomgen::import
