// SPDX-License-Identifier: GPL-3.0-or-later
// Values of parameters at samples. Each point follows from its number, the seed and what was asked alone, so that any
// process makes any of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::analysis {

/// Latin (hypercube): each axis in as many equal parts as there are samples, one sample in each. Sobol: a digitally
/// shifted Sobol' sequence.
enum class Design : std::uint8_t { random, latin, sobol };
const char* name(Design design);

/// A parameter between a and b, evenly or evenly in its logarithm; or normal, of mean a and deviation b.
struct SampledAxis {
  enum class Kind : std::uint8_t { even, logarithmic, normal };
  std::string parameter;
  double a = 0, b = 0;
  Kind kind = Kind::even;

  /// Why samples would not exist, or not as finite numbers; empty where all do.
  std::string obstacle() const;
};

class Sampling {
 public:
  /// Each axis has a parameter of its own, and no obstacle. Throws Error{stage "sweep"} for more samples or axes than
  /// the design has.
  Sampling(std::vector<SampledAxis> axes, std::size_t count, Design design, std::uint64_t seed);

  std::vector<std::string> names() const;
  std::size_t size() const { return count_; }
  /// In the order of the names.
  std::vector<symbolic::Rational> point(std::size_t index) const;

 private:
  double random(std::size_t axis, std::uint64_t index) const;
  /// Where a sample lies in [0, 1) along an axis.
  double place(std::size_t axis, std::size_t index) const;

  std::vector<SampledAxis> axes_;
  std::vector<std::vector<std::uint32_t>> orders_;  // of a Latin hypercube: the part of each axis that a sample lies in
  std::size_t count_;
  Design design_;
  std::uint64_t seed_;
};

/// The value below which a normal distribution of mean 0 and deviation 1 has this part of itself; to 1e-15 of itself.
double normal_quantile(double part);

}  // namespace eomgen::analysis
