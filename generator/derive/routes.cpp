// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/routes.hpp"

#include "derive/expanded.hpp"
#include "derive/jacobian.hpp"
#include "derive/lagrange.hpp"

namespace eomgen::derive {
namespace {

bool always(const mechanics::Mechanics&, system::Approach) { return true; }

constexpr RouteEntry entries[] = {
    {"lagrange", "T and U differentiated as they stand", always, lagrange},
    {"jacobian", "velocity Jacobians, M = sum m J^T J", jacobian_applies, jacobian},
    {"expanded", "T and U expanded first, sin^2 + cos^2 = 1 used", expanded_applies, expanded},
};

}  // namespace

std::span<const RouteEntry> routes() { return entries; }

}  // namespace eomgen::derive
