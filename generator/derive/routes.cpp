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

bool always(mechanics::Mechanics&, system::Approach) { return true; }

constexpr RouteEntry entries[] = {
    {"lagrange", "T and U differentiated as they stand", always, lagrange},
    {"jacobian", "velocity Jacobians, M = sum m J^T J", jacobian_applies, jacobian},
    {"recursive", "a tree of particles: composite masses, forces from the tips inwards", recursive_applies, recursive},
    {"articulated", "a tree of particles: the tensions of the links first, no mass matrix", articulated_applies, articulated},
    {"christoffel", "M(q), Christoffel symbols of the first kind, expanded", christoffel_applies, christoffel},
    {"expanded", "T and U expanded first, sin^2 + cos^2 = 1 used", expanded_applies, expanded},
};

}  // namespace

std::span<const RouteEntry> routes() { return entries; }

}  // namespace eomgen::derive
