// SPDX-License-Identifier: MIT
// The modes in a saved state of a StepwiseRun, which stepwise_run.hpp only declares.
#pragma once

#include "eom/hybrid/integration.hpp"

namespace eom::hybrid {

struct StepwiseModes : Integration::State {};

}  // namespace eom::hybrid
