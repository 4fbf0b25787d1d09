// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/sampling.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "cli/assignments.hpp"
#include "cli/output.hpp"
#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

constexpr std::size_t most_samples = 1'000'000'000'000, most_latin = 10'000'000,
                      most_sobol = 1ULL << 32;  // latin keeps 4 bytes of each

[[noreturn]] void fail(const std::string& what) {
  throw Error(
      "sweep", {}, what,
      "write --sample NAME=FROM:TO, NAME=FROM:TO:log or NAME=MEAN:DEVIATION:normal in SI units, with --samples N");
}

// Steele, Lea and Flood's SplitMix64: a bijection of 64 bits that mixes them well.
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
constexpr unsigned digits = 32;

/// The point of this number, in units of 2^-32.
std::uint32_t sobol(std::size_t dimension, std::uint64_t index) {
  std::uint32_t v[digits];
  for (unsigned i = 0; i < digits; ++i) {
    if (dimension == 0) {
      v[i] = 1U << (digits - 1 - i);
      continue;
    }
    const Direction& d = directions[dimension - 1];
    if (i < d.degree) {
      v[i] = d.m[i] << (digits - 1 - i);
      continue;
    }
    v[i] = v[i - d.degree] ^ (v[i - d.degree] >> d.degree);
    for (unsigned k = 1; k < d.degree; ++k) v[i] ^= (d.inner >> (d.degree - 1 - k) & 1U) * v[i - k];
  }
  std::uint32_t x = 0;
  for (unsigned i = 0; index >> i != 0 && i < digits; ++i) {
    if ((index >> i & 1) != 0) x ^= v[i];
  }
  return x;
}

double number(const std::string& text, const std::string& shown) {
  return cln::double_approx(parse_decimal(text, shown));
}

}  // namespace

double normal_quantile(double part) {
  // Newton's method on the distribution function, from the middle outwards: erfc is accurate in its tail.
  const double tail = std::min(part, 1 - part);
  if (!(tail > 0)) return part < 0.5 ? -HUGE_VAL : HUGE_VAL;
  double x = tail > 0.1 ? (0.5 - tail) * std::sqrt(2 * std::numbers::pi) : std::sqrt(-2 * std::log(tail));
  for (int i = 0; i < 60; ++i) {
    const double excess = 0.5 * std::erfc(x / std::numbers::sqrt2) - tail;
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
    const double newton = excess / density, step = newton / (1 - 0.5 * newton * x);  // Halley's, which the tail needs
    x += step;
    if (std::abs(step) <= 1e-15 * std::abs(x)) break;
  }
  return part < 0.5 ? -x : x;
}

Sampling::Sampling(const std::vector<std::string>& axes, std::size_t count, const std::string& design,
                   std::uint64_t seed)
    : count_(count), seed_(seed) {
  if (axes.empty()) fail("--samples says how many, and no --sample says of what");
  if (count == 0) fail("--sample says of what, and --samples does not say how many");
  if (count > most_samples) fail(fmt::format("more than {} samples are asked for", most_samples));
  if (design == "latin")
    design_ = Design::latin;
  else if (design == "sobol")
    design_ = Design::sobol;
  else if (design != "random")
    throw Error("sweep", {}, fmt::format("there is no design {}", model::quote(design)),
                "choose random, latin or sobol");
  const std::size_t most = design_ == Design::latin ? most_latin : most_sobol;
  if (design_ != Design::random && count > most) {
    throw Error("sweep", {}, fmt::format("--design {} makes at most {} samples", design, most), "take --design random");
  }
  for (const std::string& text : axes) read(text);
  if (design_ == Design::sobol && axes_.size() > most_dimensions) {
    throw Error("sweep", {}, fmt::format("a Sobol' sequence is made for at most {} parameters", most_dimensions),
                "take --design latin or random");
  }
  for (std::size_t a = 0; a < axes_.size() && design_ == Design::latin; ++a) {
    std::vector<std::uint32_t>& order = axes_[a].order;
    order.resize(count_);
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = count_; i-- > 1;) {
      const auto other = static_cast<std::size_t>(random(a, (1ULL << 40) + i) * static_cast<double>(i + 1));
      std::swap(order[i], order[std::min(other, i)]);
    }
  }
}

void Sampling::read(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) fail(fmt::format("{} names no parameter", model::quote(text)));
  std::vector<std::string> fields{""};
  for (const char c : text.substr(equals + 1)) {
    if (c == ':')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  if (fields.size() < 2 || fields.size() > 3) fail(fmt::format("{} is no range of samples", model::quote(text)));
  Axis axis{text.substr(0, equals), number(fields[0], text), number(fields[1], text)};
  const std::string kind = fields.size() == 3 ? fields[2] : "lin";
  if (kind == "log")
    axis.kind = Kind::logarithmic;
  else if (kind == "normal")
    axis.kind = Kind::normal;
  else if (kind != "lin")
    fail(fmt::format("{} has {} where lin, log or normal is asked", model::quote(text), model::quote(kind)));
  if (axis.kind == Kind::logarithmic && !(axis.a * axis.b > 0))
    fail(fmt::format("{} goes through 0 or changes its sign, which log cannot", model::quote(text)));
  if (axis.kind == Kind::normal && !(axis.b > 0))
    fail(fmt::format("the deviation in {} is not above 0", model::quote(text)));
  for (const Axis& other : axes_) {
    if (other.name == axis.name) fail(fmt::format("{} is sampled twice", model::quote(axis.name)));
  }
  axes_.push_back(std::move(axis));
}

double Sampling::random(std::size_t axis, std::uint64_t index) const {
  return static_cast<double>(mixed(mixed(mixed(seed_) ^ axis) ^ index) >> 11) * 0x1p-53;
}

double Sampling::place(std::size_t axis, std::size_t index) const {
  switch (design_) {
    case Design::random: return random(axis, index);
    case Design::latin: return (axes_[axis].order[index] + random(axis, index)) / static_cast<double>(count_);
    case Design::sobol: break;
  }
  const auto shift = static_cast<std::uint32_t>(mixed(mixed(seed_) ^ axis) >> 32);
  return (static_cast<double>(sobol(axis, index) ^ shift) + 0.5) * 0x1p-32;
}

std::vector<std::string> Sampling::names() const {
  std::vector<std::string> result;
  for (const Axis& axis : axes_) result.push_back(axis.name);
  return result;
}

std::vector<symbolic::Rational> Sampling::point(std::size_t index) const {
  std::vector<symbolic::Rational> result;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const Axis& axis = axes_[k];
    const double u = place(k, index);
    double value = axis.a + (axis.b - axis.a) * u;
    if (axis.kind == Kind::logarithmic) value = axis.a * std::pow(axis.b / axis.a, u);
    if (axis.kind == Kind::normal) value = axis.a + axis.b * normal_quantile(std::max(u, 0x1p-54));
    if (!std::isfinite(value)) fail(fmt::format("{} leaves the range of binary64", model::quote(axis.name)));
    result.push_back(
        parse_decimal(shortest(value), axis.name));  // the decimal that is this binary64, which the table shows
  }
  return result;
}

}  // namespace eomgen::cli
