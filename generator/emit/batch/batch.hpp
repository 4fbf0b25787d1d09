// SPDX-License-Identifier: GPL-3.0-or-later
// Target batch: NAME_batch.c and NAME_batch.h beside NAME.c and NAME.h. The functions of the C ABI for any number of
// states at once, as structures of arrays: some lanes of a register side by side, with the bits that each state has
// alone.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_batch(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
