// SPDX-License-Identifier: GPL-3.0-or-later
// NAME_taylor for the lanes of a block: the text of PREFIXtaylor_block and its helper functions.
#pragma once

#include <functional>
#include <string>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// Whether the series of all lanes fit on the stack.
bool taylor_fits_lanes(const program::Taylor& taylor, std::size_t states);

/// `names`: identifiers of lane functions. kernel(function, text): the text of PREFIXFUNCTION_block, for taylor_start
/// and taylor_next.
std::string taylor_block(const program::Program& program, const ModelNames& names, const EmissionContext& context,
                         const Dialect& dialect,
                         const std::function<std::string(const std::string&, const FunctionText&)>& kernel);

}  // namespace eomgen::emit
