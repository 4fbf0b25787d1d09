// SPDX-License-Identifier: GPL-3.0-or-later
// Target cuda: NAME.cuh, the functions of the ABI for threads of an accelerator, and NAME_ensemble.cu, .h, which
// integrate many states there. The same text compiles as HIP, and by a C++20 compiler without either.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_cuda(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
