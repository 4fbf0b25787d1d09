// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers that are identical with every compiler and library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace eomgen::random_models {

class RandomSource {
 public:
  explicit RandomSource(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 0x632BE59BD9B4E019u) {}

  /// splitmix64 (Steele, Lea, Flood 2014).
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(next() % n); }
  bool chance(int percent) { return below(100) < static_cast<std::size_t>(percent); }
  template <class T>
  const T& pick(const std::vector<T>& from) {
    return from[below(from.size())];
  }
  /// A decimal with two places from [low, high] hundredths.
  std::string decimal(int low, int high) {
    const int n = low + static_cast<int>(below(static_cast<std::size_t>(high - low + 1)));
    const int a = n < 0 ? -n : n;
    const std::string cents = std::to_string(a % 100);
    return (n < 0 ? "-" : "") + std::to_string(a / 100) + "." + (cents.size() < 2 ? "0" : "") + cents;
  }

 private:
  std::uint64_t state_;
};

}  // namespace eomgen::random_models
