// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the equations still hold after a coordinate leaves the range of its coordinate system, such as a radius that
// becomes negative on a wire through the centre. In: the model, compiled code or equations, a state. Out: true if these
// agree on both sides with equations that are derived without the range and regular at its end.
#pragma once

#include "pipeline/pipeline.hpp"
#include "run/runner.hpp"

namespace eomgen::pipeline {

bool equations_hold_beyond_range(const DerivedModel& derived, const run::Scene& scene, const run::Code& code,
                                 std::uint32_t coordinate, double t, std::span<const double> x);

/// The coordinates for which this is true near the start of the scene, by the equations alone, without compiled code.
std::vector<std::uint32_t> coordinates_valid_beyond_range(const DerivedModel& derived, const run::Scene& scene);

}  // namespace eomgen::pipeline
