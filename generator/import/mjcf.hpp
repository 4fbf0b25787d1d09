// SPDX-License-Identifier: GPL-3.0-or-later
// MJCF, the XML format of MuJoCo. Its bodies are nested, and a body may have several joints, none of which has to be at
// its origin.
// In: <mujoco> with <compiler>, <default>, <option>, <worldbody>, <actuator>, <equality>. Out: Robot; the rest is in
// its findings.
#pragma once

#include "import/import.hpp"
#include "import/robot.hpp"
#include "import/xml.hpp"

namespace eomgen::import {

/// Throws Error for wrong values and for --floating: the file states which bodies are free.
Robot read_mjcf(const Element& root, const ImportOptions& options);

}  // namespace eomgen::import
