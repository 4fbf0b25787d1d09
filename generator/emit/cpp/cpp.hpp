// SPDX-License-Identifier: GPL-3.0-or-later
// Target cpp: NAME.hpp, templates over the scalar type in namespace eom::NAME, and the C sources beside it.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_cpp(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
