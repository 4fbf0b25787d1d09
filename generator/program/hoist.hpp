// SPDX-License-Identifier: GPL-3.0-or-later
// Hoists computations that depend on parameters only. One function becomes two: `prepare` (a function of p) and the
// rest.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "program/polynomials.hpp"

namespace eomgen::program {

struct Hoisted {
  Function prepare;  // results: w
  Function rest;     // reads w through Slot::prepared
};

/// The cheapest split of the equivalent graphs `starts`. Returns nothing if the split saves less than a fiftieth of the
/// cost of `whole`. `shape` as in `schedule`.
std::optional<Hoisted> hoist(const std::vector<PolynomialGraph>& starts, const Operations& whole,
                             const std::string& name, const std::vector<ResultShape>& shape);

}  // namespace eomgen::program
