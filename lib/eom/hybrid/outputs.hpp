// SPDX-License-Identifier: MIT
// Outputs of a state of the run in any charts. In: the compiled model. Out: the array y.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "eom/hybrid/charts.hpp"
#include "eom/hybrid/model.hpp"

namespace eom::hybrid {

/// The outputs of the model in its own charts.
class Outputs {
 public:
  /// All arguments must outlive this object.
  Outputs(const Problem& problem, const Model& model, const ChartSwitch& charts)
      : problem_(problem), model_(model), charts_(charts), y_(problem.code->output_names.size()) {}

  /// Returns a code of the compiled function.
  int operator()(double t, const double* x, std::span<double> y) const {
    return evaluate(t, x, y, contacts::ForceChoice::unique);
  }

  /// The energy in J.
  double energy(double t, const double* x) {
    evaluate(t, x, y_, contacts::ForceChoice::any);
    return y_[problem_.energy];
  }

 private:
  int evaluate(double t, const double* x, std::span<double> y, contacts::ForceChoice choice) const {
    const int result = model_.outputs(t, x, y.data(), choice);
    if (charts_.second_charts() != 0) own_values(t, x, y);
    return result;
  }

  /// Outputs that second charts do not provide: the coordinates, and quantities defined or conserved in the own charts
  /// only.
  void own_values(double t, const double* x, std::span<double> y) const {
    const Code& code = model_.code();
    const std::size_t n = problem_.n();
    own_x_.resize(code.layout().size());
    charts_.to_own_charts(t, x, own_x_);
    for (std::size_t i = 0; i < n; ++i) {
      y[2 * code.free[i]] = own_x_[i];
      y[2 * code.free[i] + 1] = own_x_[n + i];
    }
    if (charts_.own_outputs().empty()) return;
    own_y_.resize(y.size());
    const int result = model_.own_outputs(t, own_x_.data(), own_y_.data());
    for (const std::uint32_t i : charts_.own_outputs())
      y[i] = result == 0 ? own_y_[i] : std::numeric_limits<double>::quiet_NaN();
  }

  const Problem& problem_;
  const Model& model_;
  const ChartSwitch& charts_;
  std::vector<double> y_;
  mutable std::vector<double> own_x_, own_y_;
};

}  // namespace eom::hybrid
