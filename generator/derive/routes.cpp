// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/routes.hpp"

#include "derive/articulated.hpp"
#include "derive/christoffel.hpp"
#include "derive/expanded.hpp"
#include "derive/jacobian.hpp"
#include "derive/lagrange.hpp"
#include "derive/recursive.hpp"

namespace eomgen::derive {
namespace {

// The one route that applies to every model.
std::optional<system::EquationSystem> by_lagrange(mechanics::Mechanics& m, system::Approach approach) { return lagrange(m, approach); }

constexpr RouteEntry entries[] = {
    {"lagrange", "T and U differentiated as they stand", by_lagrange},
    {"jacobian", "velocity Jacobians, M = sum m J^T J", jacobian},
    {"recursive", "a tree of particles or bodies: composite masses, forces from the tips inwards", recursive},
    {"articulated", "a tree of particles or bodies: link after link, no mass matrix", articulated},
    {"christoffel", "M(q), Christoffel symbols of the first kind, expanded", christoffel},
    {"expanded", "T and U expanded first, sin^2 + cos^2 = 1 used", expanded},
};

}  // namespace

std::span<const RouteEntry> routes() { return entries; }

}  // namespace eomgen::derive
