// SPDX-License-Identifier: GPL-3.0-or-later
// Random and quasi-random samples of parameter values. A sample depends only on its index, the seed and the request, so
// any process can compute any sample.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/units.hpp"
#include "symbolic/dag.hpp"

namespace eomgen::analysis {

/// Sampling plan. latin: Latin hypercube, which divides each axis into as many equal parts as there are samples, with
/// one sample in each part. sobol: Sobol' sequence with a digital shift.
enum class Design : std::uint8_t { random, latin, sobol };
const char* name(Design design);

/// Distribution of one parameter: uniform or log-uniform between a and b, or normal with mean a and standard
/// deviation b.
struct SampledAxis {
  enum class Kind : std::uint8_t { uniform, logarithmic, normal };
  std::string parameter;
  double a = 0, b = 0;
  Kind kind = Kind::uniform;
  std::optional<model::MeasuredUnit> unit{};  // in which a and b were written, if in any; they are in SI units

  /// Returns why some samples would be undefined or infinite; empty if all are finite.
  std::string domain_error() const;
};

class Sampling {
 public:
  /// Requires axes with distinct parameters and no obstacle(). Throws Error{stage "sweep"} for more samples or axes
  /// than the design supports.
  Sampling(std::vector<SampledAxis> axes, std::size_t count, Design design, std::uint64_t seed);

  const std::vector<SampledAxis>& axes() const { return axes_; }
  std::vector<std::string> names() const;
  std::size_t size() const { return count_; }
  /// Values of one sample, in the order of names().
  std::vector<symbolic::Rational> point(std::size_t index) const;

 private:
  double random(std::size_t axis, std::uint64_t index) const;
  /// Position of a sample along an axis, in [0, 1).
  double place(std::size_t axis, std::size_t index) const;

  std::vector<SampledAxis> axes_;
  std::vector<std::vector<std::uint32_t>> orders_;  // Latin hypercube: part of each axis, per sample
  std::size_t count_;
  Design design_;
  std::uint64_t seed_;
};

/// Quantile function of the standard normal distribution, `part` in (0, 1). Relative error 1e-15.
double normal_quantile(double part);

}  // namespace eomgen::analysis
