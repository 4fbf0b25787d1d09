// SPDX-License-Identifier: GPL-3.0-or-later
// Part of target rust.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

/// The function `start` of the module, but for the functions start_values and start_rows.
std::string rust_start(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
