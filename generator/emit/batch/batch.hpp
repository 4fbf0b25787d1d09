// SPDX-License-Identifier: GPL-3.0-or-later
// Target batch: NAME_batch.c and NAME_batch.h in addition to NAME.c and NAME.h. The functions of the C ABI for many
// states as structures of arrays. States are computed in the lanes of SIMD registers, with the same bits as each state
// alone.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_batch(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
