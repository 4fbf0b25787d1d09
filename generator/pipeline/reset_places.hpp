// SPDX-License-Identifier: GPL-3.0-or-later
// In: resets of events and samples as expressions; the periods of a scene. Out: their places in the state x and in the
// array r of the function resets.
#pragma once

#include <eom/hybrid/reset_types.hpp>
#include <vector>

#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

struct ResetPlaces {
  std::vector<eom::hybrid::Reset> events;  // per Model::events; empty if the event changes nothing
  std::vector<eom::hybrid::Sample> samples;
};

ResetPlaces reset_places(const DerivedModel& derived, const run::Scene& scene);

}  // namespace eomgen::pipeline
