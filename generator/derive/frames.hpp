// SPDX-License-Identifier: GPL-3.0-or-later
// In: Mechanics. Out: the motion of every place but the origin. Velocities and accelerations follow the tree of places
// and axes, with d(e)/dt = w x e for an axis e: no rotation matrix is differentiated.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/frame.hpp"

namespace eomgen::derive {

/// In the order of Model::places, in t, q and qdot of the free coordinates. A body has its own axes. A point has those
/// of the body in which it is fixed, if its position names an axis of that body. A particle and any other point have
/// the fixed axes.
std::vector<system::Frame> frames(mechanics::Mechanics& mechanics);
/// Their names.
std::vector<std::string> frame_names(const model::Model& model);

}  // namespace eomgen::derive
