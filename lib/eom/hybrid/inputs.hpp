// SPDX-License-Identifier: MIT
// The inputs of a run as functions of time. In: a Problem. Out: one number per input.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "eom/hybrid/problem.hpp"

namespace eom::hybrid {

/// The inputs of a run as functions of time.
class Inputs {
 public:
  /// Copies the signals of the problem.
  explicit Inputs(const Problem& problem) : signals_(problem.inputs) {
    for (const Signal& signal : signals_)
      codes_.push_back(signal.expression.empty() ? expressions::Code()
                                                 : expressions::Code(signal.expression, problem.parameters));
  }

  /// Number of inputs.
  std::size_t size() const { return signals_.size(); }

  /// Input i at t. Of a table: on the segment that contains `side`, a time inside the current segment.
  double operator()(std::size_t i, double t, double side) const {
    const Signal& signal = signals_[i];
    if (codes_[i].roots() > 0) return codes_[i].value({&t, 1});
    if (signal.times.empty()) return signal.function ? signal.function(t) : 0.0;
    return table_value(signal, t, side).value;
  }

 private:
  std::span<const Signal> signals_;
  std::vector<expressions::Code> codes_;
};

}  // namespace eom::hybrid
