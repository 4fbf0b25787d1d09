// SPDX-License-Identifier: GPL-3.0-or-later
// Scalar types of the lanes of a block, double or float in single precision, and NAME_taylor for them: the text of
// PREFIXtaylor_block and its helper functions.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// The dialect of C with lanes; `prefix`: of the functions of templates/batch.
Dialect lane_dialect(bool single, const std::string& prefix);

/// Values for the skeletons of templates/batch: types, lanes per register, tests of all lanes at once.
std::vector<std::pair<std::string, std::string>> lane_template_values(bool single);

/// Whether the series of all lanes fit on the stack.
bool taylor_fits_lanes(const program::Taylor& taylor, std::size_t states);

/// `names`: identifiers of lane functions. kernel(function, text): the text of PREFIXFUNCTION_block, for taylor_start
/// and taylor_next.
std::string taylor_block(const program::Program& program, const ModelNames& names, const EmissionContext& context,
                         const Dialect& dialect,
                         const std::function<std::string(const std::string&, const FunctionText&)>& kernel);

}  // namespace eomgen::emit
