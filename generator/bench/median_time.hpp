// SPDX-License-Identifier: GPL-3.0-or-later
// Median run time of repeated work.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

namespace eomgen::bench {

struct Median {
  double seconds = 0;
  std::size_t repeats = 0;
};

/// The median time of 3 to 31 repetitions, limited to 0.15 s in all.
template <class Work>
Median median_time(Work&& work) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t most = 31, fewest = 3;
  constexpr double longest = 0.15;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  std::vector<double> values;
  const Clock::time_point start = Clock::now();
  while (values.size() < fewest || (values.size() < most && since(start) < longest)) {
    const Clock::time_point from = Clock::now();
    work();
    values.push_back(since(from));
  }
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2, n};
}

}  // namespace eomgen::bench
