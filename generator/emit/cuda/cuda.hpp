// SPDX-License-Identifier: GPL-3.0-or-later
// Target cuda: NAME.cuh contains the functions of the ABI as device functions; NAME_ensemble.cu and .h integrate many
// states on the device. The same text compiles as HIP, and with a plain C++20 compiler.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_cuda(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
