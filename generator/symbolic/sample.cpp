// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/sample.hpp"

namespace eomgen::symbolic {
namespace {

constexpr long steps = 1000003;  // a prime, so that the values have no common factors with small numbers

/// A hash in 0 .. steps - 1: the finaliser of splitmix64 over the identity of the symbol and the point.
long scattered(const Symbol& symbol, std::uint64_t point) {
  std::uint64_t x = (point + 1) * 0x9e3779b97f4a7c15ull + (static_cast<std::uint64_t>(symbol.kind) << 40) +
                    (std::uint64_t{symbol.order} << 32) + symbol.index;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return static_cast<long>((x ^ (x >> 31)) % static_cast<std::uint64_t>(steps));
}

}  // namespace

Rational sample(const Symbol& symbol, std::uint64_t point) {
  return Rational(scattered(symbol, point)) / steps + Rational(1) / 5;
}

double sample_double(const Symbol& symbol, std::uint64_t point) {
  return 0.2 + static_cast<double>(scattered(symbol, point)) / static_cast<double>(steps);
}

}  // namespace eomgen::symbolic
