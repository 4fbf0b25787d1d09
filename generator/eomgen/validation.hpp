// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of options before a call starts: the ranges of the command line. Not installed.
#pragma once

#include <cstddef>

#include "eomgen/benchmark.hpp"
#include "eomgen/certificate.hpp"
#include "eomgen/motion.hpp"
#include "eomgen/simulation.hpp"
#include "eomgen/steady.hpp"

namespace eomgen {

/// Each throws Error{stage "library"} for a number that the command line refuses too. The error names the option.
void require_valid(const RunOptions& options);
void require_valid(const InverseOptions& options);
void require_valid(const SimulationOptions& options);
void require_valid(const LineariseOptions& options);
void require_valid(const SteadyOptions& options);
void require_valid(const BenchmarkOptions& options);
void require_valid(const StressOptions& options);
void require_valid(const VerifyOptions& options);

/// Throws Error if rows from t0 to t1 are not distinct. Throws Error if they need more memory than a program should
/// give them, where they are `stored` with `columns` values each. `option`: the name of the interval.
void require_rows(double t0, double t1, double every, std::size_t columns, bool stored, const char* option);

}  // namespace eomgen
