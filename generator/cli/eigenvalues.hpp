// SPDX-License-Identifier: GPL-3.0-or-later
// Eigenvalues in the output of `linearize` and `equilibria`.
#pragma once

#include <string>

#include "analysis/steady.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

using analysis::display_value;

/// Format: "-1.5 +- 2i" or "0.3", with the number of reliable digits if it is lower than usual.
Json eigenvalue_json(const linear::Eigenvalue& eigenvalue);
std::string eigenvalue_text(const linear::Spectrum& spectrum, std::size_t i);

}  // namespace eomgen::cli
