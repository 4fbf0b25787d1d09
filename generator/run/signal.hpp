// SPDX-License-Identifier: GPL-3.0-or-later
// An input u(t) during a run: an expression of t and parameters, or a table that is piecewise constant or linear.
#pragma once

#include <eom/expressions/code.hpp>
#include <eom/hybrid/signal.hpp>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::run {

class Signal {
 public:
  Signal() = default;
  /// An expression in t and parameters; it is copied, so the Dag need not live on.
  Signal(const symbolic::Dag& dag, symbolic::Ref expression, const std::vector<double>& parameters);
  /// value[k] from time[k] until time[k+1], or linear in between; value[0] before time[0].
  Signal(std::vector<double> time, std::vector<double> value, bool linear);

  /// Sets new values of the parameters in its expression.
  void set_parameters(const std::vector<double>& values);

  /// The value at t. At a time of a table: on the segment that `side_of` (a time inside the current segment) lies in.
  double operator()(double t, double side_of) const;
  /// Whether the signal varies between the times of its table, or has none and varies.
  bool is_varying() const;
  bool is_linear_table() const { return signal_.linear; }
  /// Times of a table, at which it has jumps or kinks.
  const std::vector<double>& knots() const { return signal_.times; }
  const eom::hybrid::Signal& runtime_signal() const { return signal_; }

 private:
  eom::hybrid::Signal signal_;
  eom::expressions::Code code_;  // of its expression, with values of the parameters
};

}  // namespace eomgen::run
