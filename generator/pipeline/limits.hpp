// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges of the whole numbers that the command line and the library accept.
#pragma once

namespace eomgen::limits {

/// Both ends are allowed.
struct CountRange {
  unsigned long long least, most;
};

inline constexpr CountRange run_steps{1, 1'000'000'000'000'000};  // of a run, an advance, an inverse problem
inline constexpr CountRange stress_steps{100, 1'000'000'000};     // of a run of a stress test
inline constexpr CountRange search_starts{1, 100'000};            // of a search for steady motions
inline constexpr CountRange verification_digits{20, 300};
inline constexpr CountRange verification_points{1, 10'000};

}  // namespace eomgen::limits
