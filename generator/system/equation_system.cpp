// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/equation_system.hpp"

namespace eomgen::system {

const char* name(Approach approach) { return approach == Approach::one ? "I" : "II"; }

}  // namespace eomgen::system
