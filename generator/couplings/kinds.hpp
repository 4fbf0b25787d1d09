// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "couplings/coupling.hpp"

namespace eomgen::couplings {

#define COUPLING(name) Coupling name();
#include "couplings/registry.inc"
#undef COUPLING

}  // namespace eomgen::couplings
