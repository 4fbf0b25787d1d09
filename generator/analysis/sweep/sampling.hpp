// SPDX-License-Identifier: GPL-3.0-or-later
// Values of parameters at samples: --sample k=1:100 --sample m=1:0.1:normal --samples 1000 --design sobol. Each point
// follows from its number, the seed and what was asked alone, so that any process makes any of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::cli {

class Sampling {
 public:
  Sampling() = default;
  /// Each of `axes` is NAME=FROM:TO, NAME=FROM:TO:log or NAME=MEAN:DEVIATION:normal. `design`: random; latin
  /// (hypercube: each axis in as many equal parts as there are samples, one sample in each); sobol (a digitally shifted
  /// Sobol' sequence, of at most 10 axes). Throws Error.
  Sampling(const std::vector<std::string>& axes, std::size_t count, const std::string& design, std::uint64_t seed);

  std::vector<std::string> names() const;
  std::size_t size() const { return count_; }
  /// In the order of the names.
  std::vector<symbolic::Rational> point(std::size_t index) const;
  /// Where a sample lies in [0, 1) along an axis.
  double place(std::size_t axis, std::size_t index) const;

 private:
  enum class Kind : std::uint8_t { even, logarithmic, normal };
  enum class Design : std::uint8_t { random, latin, sobol };
  struct Axis {
    std::string name;
    double a = 0, b = 0;
    Kind kind = Kind::even;
    std::vector<std::uint32_t> order = {};  // of a Latin hypercube: the part that each sample lies in
  };
  void read(const std::string& text);
  double random(std::size_t axis, std::uint64_t index) const;

  std::vector<Axis> axes_;
  std::size_t count_ = 1;
  Design design_ = Design::random;
  std::uint64_t seed_ = 1;
};

/// The value below which a normal distribution of mean 0 and deviation 1 has this part of itself; to 1e-15 of itself.
double normal_quantile(double part);

}  // namespace eomgen::cli
