// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "forces/kind.hpp"

namespace eomgen::forces {

#define FORCE(name) Kind name();
#include "forces/registry.inc"
#undef FORCE

}  // namespace eomgen::forces
