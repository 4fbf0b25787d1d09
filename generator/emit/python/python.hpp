// SPDX-License-Identifier: GPL-3.0-or-later
// Target python: NAME.py beside NAME.c, NAME.h of target c and NAME_simulate.c, an integrator. The module compiles the
// C when it is imported; names, units and defaults are those of NAME_info.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_python(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
