// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// "number", "pi", "symbol", "+", "-", "*", "/", "neg", "^", "if", or the function's name in the model language.
const char* op_name(Op op);

}  // namespace eomgen::symbolic
