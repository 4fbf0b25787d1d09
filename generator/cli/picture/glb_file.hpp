// SPDX-License-Identifier: GPL-3.0-or-later
// Encoder of glTF 2.0 in one binary file (Khronos, glTF 2.0 Specification, section 4): meshes with keyframes, which
// studios such as Blender and browsers show.
#pragma once

#include <string>

#include "analysis/drawing/animation.hpp"

namespace eomgen::cli {

/// Returns the bytes of the file. Times are relative to the first keyframe, in single precision as all numbers of the
/// file; of keyframes that fall together the last one counts. At least one node and one keyframe.
std::string encode_glb(const analysis::Animation& animation, const std::string& title);

}  // namespace eomgen::cli
