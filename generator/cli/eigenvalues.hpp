// SPDX-License-Identifier: GPL-3.0-or-later
// Eigenvalues and values of many digits as `linearize` and `equilibria` show them.
#pragma once

#include <string>

#include "analysis/steady.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

using analysis::shown;

/// "-1.5 +- 2i", or "0.3", with what its digits are good for where that is less than usual.
Json eigenvalue_json(const linear::Eigenvalue& eigenvalue);
std::string eigenvalue_text(const linear::Spectrum& spectrum, std::size_t i);

}  // namespace eomgen::cli
