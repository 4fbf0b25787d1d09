// SPDX-License-Identifier: GPL-3.0-or-later
// Power series of expressions along a curve, in many digits. Coefficients are computed one order at a time, so that the
// curve may be the solution of an equation that contains the expressions.
#pragma once

#include <cln/real.h>

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

class PowerSeries {
 public:
  using Lookup = std::function<cln::cl_R(const Symbol&, std::size_t)>;

  /// Prepares the series of `roots`. Adds derivatives of functions to the Dag.
  PowerSeries(Dag& dag, std::vector<Ref> roots, int digits);

  /// Computes coefficient k of every root; k = 0, 1, 2, .. increases with each call. `lookup` returns coefficient k of
  /// a symbol. Throws std::domain_error outside the domain of a function.
  void extend(const Lookup& lookup);
  const std::vector<cln::cl_R>& operator[](std::size_t root) const { return series_.at(roots_[root]).c; }

 private:
  struct Series {
    std::array<Ref, 2> slope{};  // partial derivatives of a function
    std::vector<cln::cl_R> c;
  };
  bool is_function(const Node& node) const;
  std::array<Ref, 2> slopes(Ref r);
  cln::cl_R next(Ref r, const Lookup& lookup) const;
  const std::vector<cln::cl_R>& of(Ref r) const { return series_.at(r).c; }

  Dag& dag_;
  std::vector<Ref> roots_;
  int digits_;
  std::size_t order_ = 0;         // number of known coefficients
  std::map<Ref, Series> series_;  // operands before users
};

}  // namespace eomgen::symbolic
