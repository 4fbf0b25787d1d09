// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/sweep/sampling.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "analysis/shortest_decimal.hpp"
#include "error.hpp"
#include "lists.hpp"

namespace eomgen::analysis {
namespace {

constexpr std::uint64_t most_samples = 1'000'000'000'000, most_latin = 10'000'000,
                        most_sobol = 1ULL << 32;  // latin stores 4 bytes per sample

[[noreturn]] void fail(const std::string& what, const std::string& remedy) { throw Error("sweep", {}, what, remedy); }

// Steele, Lea and Flood's SplitMix64: a bijection of 64 bits with good mixing.
std::uint64_t mixed(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

// Primitive polynomials (degree, inner coefficients) and initial direction numbers of Joe and Kuo, SIAM J. Sci. Comput.
// 30 (2008) 2635, from the second dimension on; the first is van der Corput's.
struct Direction {
  unsigned degree, inner;
  std::uint32_t m[5];
};
constexpr Direction directions[] = {{1, 0, {1}},
                                    {2, 1, {1, 3}},
                                    {3, 1, {1, 3, 1}},
                                    {3, 2, {1, 1, 1}},
                                    {4, 1, {1, 1, 3, 3}},
                                    {4, 4, {1, 3, 5, 13}},
                                    {5, 2, {1, 1, 5, 5, 17}},
                                    {5, 4, {1, 1, 5, 5, 5}},
                                    {5, 7, {1, 1, 7, 11, 19}}};
constexpr std::size_t most_dimensions = 1 + std::size(directions);
constexpr unsigned binary_digits = 32;

/// The Sobol' point of this index, in units of 2^-32.
std::uint32_t sobol(std::size_t dimension, std::uint64_t index) {
  std::uint32_t v[binary_digits];
  for (unsigned i = 0; i < binary_digits; ++i) {
    if (dimension == 0) {
      v[i] = 1U << (binary_digits - 1 - i);
      continue;
    }
    const Direction& d = directions[dimension - 1];
    if (i < d.degree) {
      v[i] = d.m[i] << (binary_digits - 1 - i);
      continue;
    }
    v[i] = v[i - d.degree] ^ (v[i - d.degree] >> d.degree);
    for (unsigned k = 1; k < d.degree; ++k) v[i] ^= (d.inner >> (d.degree - 1 - k) & 1U) * v[i - k];
  }
  std::uint32_t x = 0;
  for (unsigned i = 0; index >> i != 0 && i < binary_digits; ++i) {
    if ((index >> i & 1) != 0) x ^= v[i];
  }
  return x;
}

}  // namespace

double normal_quantile(double part) {
  // Newton's method on the distribution function, from the centre outwards: erfc is accurate in the tail.
  const double tail = std::min(part, 1 - part);
  if (!(tail > 0)) return part < 0.5 ? -HUGE_VAL : HUGE_VAL;
  double x = tail > 0.1 ? (0.5 - tail) * std::sqrt(2 * std::numbers::pi) : std::sqrt(-2 * std::log(tail));
  for (int i = 0; i < 60; ++i) {
    const double excess = 0.5 * std::erfc(x / std::numbers::sqrt2) - tail;
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
    const double newton = excess / density, step = newton / (1 - 0.5 * newton * x);  // Halley's method, for the tail
    x += step;
    if (std::abs(step) <= 1e-15 * std::abs(x)) break;
  }
  return part < 0.5 ? -x : x;
}

const char* name(Design design) {
  switch (design) {
    case Design::random: return "random";
    case Design::latin: return "latin";
    case Design::sobol: break;
  }
  return "sobol";
}

std::string SampledAxis::domain_error() const {
  constexpr double farthest = 9;  // deviations from the mean: normal_quantile of any binary64 is nearer to 0
  double reach = b - a;
  switch (kind) {
    case Kind::uniform: break;
    case Kind::logarithmic:
      if (a == 0 || b == 0 || (a < 0) != (b < 0)) return "goes through 0 or changes its sign, which log cannot";
      reach = std::max(a / b, b / a);
      break;
    case Kind::normal:
      if (!(b > 0)) return "has a deviation that is not above 0";
      reach = std::abs(a) + farthest * b;
      break;
  }
  return std::isfinite(a) && std::isfinite(b) && std::isfinite(reach) ? "" : "leaves the range of binary64";
}

Sampling::Sampling(std::vector<SampledAxis> axes, std::size_t count, Design design, std::uint64_t seed)
    : axes_(std::move(axes)), count_(count), design_(design), seed_(seed) {
  if (count > most_samples) fail(fmt::format("more than {} samples are asked for", most_samples), "take fewer");
  const std::uint64_t most = design == Design::latin ? most_latin : most_sobol;
  if (design != Design::random && count > most)
    fail(fmt::format("the design {} makes at most {} samples", name(design), most), "take the design random");
  if (design == Design::sobol && axes_.size() > most_dimensions)
    fail(fmt::format("a Sobol' sequence is made for at most {} parameters", most_dimensions),
         "take the design latin or random");
  if (design != Design::latin) return;
  orders_.resize(axes_.size());
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    std::vector<std::uint32_t>& order = orders_[a];
    order.resize(count_);
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = count_; i-- > 1;) {
      const auto other = static_cast<std::size_t>(random(a, (1ULL << 40) + i) * static_cast<double>(i + 1));
      std::swap(order[i], order[std::min(other, i)]);
    }
  }
}

double Sampling::random(std::size_t axis, std::uint64_t index) const {
  return static_cast<double>(mixed(mixed(mixed(seed_) ^ axis) ^ index) >> 11) * 0x1p-53;
}

double Sampling::place(std::size_t axis, std::size_t index) const {
  switch (design_) {
    case Design::random: return random(axis, index);
    case Design::latin: return (orders_[axis][index] + random(axis, index)) / static_cast<double>(count_);
    case Design::sobol: break;
  }
  const auto shift = static_cast<std::uint32_t>(mixed(mixed(seed_) ^ axis) >> 32);
  return (static_cast<double>(sobol(axis, index) ^ shift) + 0.5) * 0x1p-32;
}

std::vector<std::string> Sampling::names() const { return mapped(axes_, &SampledAxis::parameter); }

std::vector<symbolic::Rational> Sampling::point(std::size_t index) const {
  std::vector<symbolic::Rational> result;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const SampledAxis& axis = axes_[k];
    const double u = place(k, index);
    double value = axis.a + (axis.b - axis.a) * u;
    if (axis.kind == SampledAxis::Kind::logarithmic) value = axis.a * std::pow(axis.b / axis.a, u);
    if (axis.kind == SampledAxis::Kind::normal) value = axis.a + axis.b * normal_quantile(std::max(u, 0x1p-54));
    result.push_back(shortest_decimal(value, axis.parameter));
  }
  return result;
}

}  // namespace eomgen::analysis
