// SPDX-License-Identifier: MIT
// Times of samples, and their random numbers. In: the period, a seed, the number of the sample. Out: the same numbers
// in every run and on every machine: they depend on the seed and the number of the sample only.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "eom/hybrid/problem.hpp"

namespace eom::hybrid {

inline constexpr double most_samples = 1e7;  // of one kind in one run
inline constexpr std::int64_t none_taken = std::numeric_limits<std::int64_t>::min();

inline double sample_time(const Sample& sample, std::int64_t k) {
  return sample.offset + static_cast<double>(k) * sample.every;
}

/// Times that differ by less are equal: multiples of two periods meet up to rounding.
inline double equal_times(double t) { return 8 * std::numeric_limits<double>::epsilon() * std::abs(t); }

/// The first sample at or after `from`.
inline std::int64_t first_sample(const Sample& sample, double from) {
  auto k = static_cast<std::int64_t>(std::ceil((from - sample.offset) / sample.every));
  while (sample_time(sample, k) < from) ++k;
  while (sample_time(sample, k - 1) >= from) --k;
  return k;
}

/// The sample that belongs to these times, or none.
inline std::optional<std::int64_t> sample_between(const Sample& sample, double from, double until) {
  const std::int64_t k = first_sample(sample, from - equal_times(from));
  if (sample_time(sample, k) <= until + equal_times(until)) return k;
  return std::nullopt;
}

/// Evaluates the periods and offsets that follow from parameters. Throws std::invalid_argument, and changes nothing, if
/// a period is not positive.
inline void evaluate_sample_times(std::vector<Sample>& samples, std::span<const double> parameters) {
  std::vector<std::array<double, 2>> times(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    times[i] = {samples[i].every, samples[i].offset};
    if (!samples[i].times.empty()) expressions::Code(samples[i].times, parameters).values({}, times[i]);
    if (!(times[i][0] > 0) || !std::isfinite(times[i][0]) || !std::isfinite(times[i][1]))
      throw std::invalid_argument("eom::hybrid: the period of '" + samples[i].name + "' is " +
                                  std::to_string(times[i][0]) + " s with these parameters; it has to be positive");
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].every = times[i][0];
    samples[i].offset = times[i][1];
  }
}

/// The last sample that counts as taken at t, after the times of samples have changed from `before` to `now`: one at t
/// is taken again only if none was at t.
inline std::int64_t last_taken(const Sample& before, std::int64_t taken, const Sample& now, double t) {
  const std::int64_t next = first_sample(now, t - equal_times(t));
  const bool is_at_t = sample_time(now, next) <= t + equal_times(t);
  const bool was_at_t = taken != none_taken && sample_time(before, taken) >= t - equal_times(t);
  return is_at_t && was_at_t ? next : next - 1;
}
/// The same for all samples.
inline void move_taken(std::vector<std::int64_t>& taken, const std::vector<Sample>& before,
                       const std::vector<Sample>& now, double t) {
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (!now[i].times.empty()) taken[i] = last_taken(before[i], taken[i], now[i], t);
}

/// A random integer from a counter (the finalizer of SplitMix64; Steele, Lea, Flood 2014).
inline std::uint64_t random_bits(std::uint64_t counter) {
  std::uint64_t z = (counter + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

/// The random number of sample k: normal with mean 0 and deviation 1 (Box and Muller 1958), or uniform from -1 to 1.
inline double random_number(const Noise& noise, std::int64_t k) {
  const std::uint64_t stream = random_bits(noise.seed);
  const auto uniform = [&](std::uint64_t i) {  // in (0, 1)
    const std::uint64_t bits = random_bits(stream ^ (2 * static_cast<std::uint64_t>(k) + i));
    return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
  };
  if (!noise.normal) return 2 * uniform(0) - 1;
  return std::sqrt(-2 * std::log(uniform(0))) * std::cos(2 * std::numbers::pi * uniform(1));
}

}  // namespace eom::hybrid
