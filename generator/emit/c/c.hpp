// SPDX-License-Identifier: GPL-3.0-or-later
// Target c: NAME.c and NAME.h, the C ABI of docs/abi.md in a C11 subset that C++ compiles too.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_c(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
