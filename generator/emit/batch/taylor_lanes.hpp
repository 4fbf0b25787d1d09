// SPDX-License-Identifier: GPL-3.0-or-later
// NAME_taylor for the lanes of a block: the text of PREFIXtaylor_block and of what it is made of.
#pragma once

#include <functional>
#include <string>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// Whether the series of so many lanes fit the stack.
bool taylor_fits_lanes(const program::Taylor& taylor, std::size_t states);

/// `names`: as functions for lanes know them. kernel(function, text): the text of PREFIXFUNCTION_block; used for
/// taylor_start and taylor_next.
std::string taylor_block(const program::Program& program, const ModelNames& names, const EmissionContext& context,
                         const Dialect& dialect,
                         const std::function<std::string(const std::string&, const FunctionText&)>& kernel);

}  // namespace eomgen::emit
