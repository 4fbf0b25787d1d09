// SPDX-License-Identifier: GPL-3.0-or-later
// Power series of expressions along a curve, in many digits: coefficient after coefficient, so that the curve may be
// the solution of an equation in which the expressions stand.
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

  /// Adds derivatives of functions to the Dag.
  PowerSeries(Dag& dag, std::vector<Ref> roots, int digits);

  /// Coefficient k of every root, k = 0, 1, 2, .. from call to call; `lookup` gives coefficient k of a symbol. Throws
  /// std::domain_error where a function leaves its domain.
  void extend(const Lookup& lookup);
  const std::vector<cln::cl_R>& operator[](std::size_t root) const { return series_.at(roots_[root]).c; }

 private:
  struct Series {
    std::array<Ref, 2> slope{};  // of a function by its arguments
    std::vector<cln::cl_R> c;
  };
  bool is_function(const Node& node) const;
  std::array<Ref, 2> slopes(Ref r);
  cln::cl_R next(Ref r, const Lookup& lookup) const;
  const std::vector<cln::cl_R>& of(Ref r) const { return series_.at(r).c; }

  Dag& dag_;
  std::vector<Ref> roots_;
  int digits_;
  std::size_t order_ = 0;         // coefficients that are there
  std::map<Ref, Series> series_;  // operands before users
};

}  // namespace eomgen::symbolic
