// SPDX-License-Identifier: GPL-3.0-or-later
// URDF, the Unified Robot Description Format. liburdfdom, its reference reader, gives no lines of the file and reports
// errors on a log of its own, so the file is read here on an XML library.
// In: <robot> with <link>, <joint>, <transmission>. Out: Robot; the rest is in its findings.
#pragma once

#include "import/import.hpp"
#include "import/robot.hpp"
#include "import/xml.hpp"

namespace eomgen::import {

/// Throws Error for wrong values; links and joints are not yet compared with one another.
Robot read_urdf(const Element& root, const ImportOptions& options);

}  // namespace eomgen::import
