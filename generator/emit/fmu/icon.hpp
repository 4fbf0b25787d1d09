// SPDX-License-Identifier: GPL-3.0-or-later
// The icon of an FMU: a pendulum.
#pragma once

#include <string>

namespace eomgen::emit {

/// A PNG of 64 x 64 grey pixels.
std::string icon_png();

}  // namespace eomgen::emit
