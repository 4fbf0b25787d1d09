// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the energy of a run is accounted for. In: a finished run with its error estimate. Out: the outcome
// balance_open where it is not, by more than the estimate explains.
#pragma once

#include "run/runner.hpp"

namespace eomgen::run {

void require_balance(const RunRequest& request, RunResult& result);

}  // namespace eomgen::run
