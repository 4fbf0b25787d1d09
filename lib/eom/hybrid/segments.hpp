// SPDX-License-Identifier: MIT
// Segments of a run that are known in advance. They end at jumps of inputs, at kinks in time and at samples, and fixed
// steps may be shorter in some. In: a Problem. Out: the segments.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/samples.hpp"

namespace eom::hybrid {

/// An interval in which fixed steps have to be shorter than requested to resolve a function of time.
struct FinerSteps {
  double begin, end, step;
};
inline constexpr double fixed_step_fraction = 0.03125;  // of a bound on adaptive steps

inline std::vector<FinerSteps> finer_steps(const Problem& problem) {
  std::vector<FinerSteps> result;
  const std::vector<StepBound>& bounds = problem.bounds;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const double step = bounds[k].step * fixed_step_fraction,
                 end = k + 1 < bounds.size() ? bounds[k + 1].t : problem.t1;
    if (step < problem.fixed_step && end > bounds[k].t) result.push_back({bounds[k].t, end, step});
  }
  return result;
}

/// An interval between two times at which something jumps or fixed steps change their size.
struct Segment {
  double end, next;  // `next`: start of the following segment, beyond `end` by rounding at a kink in time; of the last
                     // segment beyond `end` if a kink lies at the end of the run
  double step;       // of fixed steps
};

/// Samples begin segments, but for those at the start and the end. Samples at equal times, and samples at other
/// boundaries, begin one.
inline void add_samples(const Problem& problem, std::vector<Segment>& result) {
  if (problem.samples.empty()) return;
  std::vector<double> times, others;
  for (const Sample& sample : problem.samples) {
    const double from = problem.begin() + 2 * equal_times(problem.begin()),
                 until = problem.t1 - 2 * equal_times(problem.t1);
    for (std::int64_t k = first_sample(sample, from); sample_time(sample, k) < until; ++k) {
      if (sample_time(sample, k) > from) times.push_back(sample_time(sample, k));
    }
  }
  for (const Segment& segment : result) others.insert(others.end(), {segment.end, segment.next});
  std::sort(others.begin(), others.end());
  std::sort(times.begin(), times.end());
  const auto near_other = [&](double t) {
    const auto next = std::lower_bound(others.begin(), others.end(), t - equal_times(t));
    return next != others.end() && *next <= t + equal_times(t);
  };
  double last = -std::numeric_limits<double>::infinity();
  for (const double t : times) {
    if (t - last <= equal_times(t) || near_other(t)) continue;
    result.push_back({t, t, problem.fixed_step});
    last = t;
  }
}

inline std::vector<Segment> segments(const Problem& problem) {
  std::vector<Segment> result;
  const std::vector<FinerSteps> finer = finer_steps(problem);
  for (const Signal& signal : problem.inputs) {
    for (const double t : signal.times) {
      if (t > problem.t0 && t < problem.t1) result.push_back({t, t, problem.fixed_step});
    }
  }
  for (const Breakpoint& b : problem.breakpoints) result.push_back({b.before, b.after, problem.fixed_step});
  if (problem.fixed_step > 0) {
    for (const auto& [begin, end, step] : finer) {
      if (begin > problem.t0) result.push_back({begin, begin, problem.fixed_step});
      if (end < problem.t1) result.push_back({end, end, problem.fixed_step});
    }
  }
  add_samples(problem, result);
  std::sort(result.begin(), result.end(), [](const Segment& a, const Segment& b) { return a.end < b.end; });
  std::size_t kept = 0;
  for (const Segment& segment : result) {
    if (segment.end <= problem.begin() || segment.end >= problem.t1) continue;
    if (kept > 0 && segment.end <= result[kept - 1].next)
      result[kept - 1].next = std::max(result[kept - 1].next, segment.next);
    else
      result[kept++] = segment;
  }
  result.resize(kept);
  if (result.empty() || result.back().next < problem.t1) result.push_back({problem.t1, problem.t1, problem.fixed_step});
  if (problem.fixed_step > 0) {
    double from = problem.begin();
    for (Segment& segment : result) {
      for (const auto& [begin, end, step] : finer) {
        if (from < end && segment.end > begin) segment.step = std::min(segment.step, step);
      }
      from = segment.next;
    }
  }
  return result;
}

}  // namespace eom::hybrid
