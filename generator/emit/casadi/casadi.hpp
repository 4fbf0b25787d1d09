// SPDX-License-Identifier: GPL-3.0-or-later
// Target casadi: the C sources, and NAME_casadi.c with functions that CasADi loads by `external`.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

/// Throws Error if single precision is requested: CasADi's numbers are double.
std::vector<EmittedFile> emit_casadi(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
