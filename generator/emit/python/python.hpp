// SPDX-License-Identifier: GPL-3.0-or-later
// Target python: NAME.py, NAME.c and NAME.h of target c, and the integrator NAME_simulate.c. The module compiles the C
// code on import. Names, units and defaults are those of NAME_info.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_python(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
