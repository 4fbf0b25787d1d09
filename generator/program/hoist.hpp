// SPDX-License-Identifier: GPL-3.0-or-later
// What depends on parameters only is computed once: a function in two, `prepare` (of p) and what is left (of the rest).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program/polynomials.hpp"

namespace eomgen::program {

struct Hoisted {
  Function prepare;  // results: w
  Function rest;     // reads w through Slot::prepared
};

/// The cheapest of what the equal graphs `starts` become without their parts of parameters only; nothing where that
/// saves less than a fiftieth of the cost of `whole`. `shape` as in `schedule`.
std::optional<Hoisted> hoist(const std::vector<Polynomials>& starts, const Operations& whole, const std::string& name,
                             const std::vector<ResultShape>& shape);

}  // namespace eomgen::program
