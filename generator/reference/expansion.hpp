// SPDX-License-Identifier: GPL-3.0-or-later
// Taylor coefficients of a motion in any precision: the recurrences of the program (program/taylor.hpp) in CLN
// arithmetic.
#pragma once

#include <cln/float.h>
#include <cln/real.h>

#include <vector>

#include "program/taylor.hpp"

namespace eomgen::reference {

using Number = cln::cl_F;

class TaylorExpansion {
 public:
  TaylorExpansion(const program::Taylor& taylor, int digits);

  /// c[k][i], k = 0..order. Throws std::domain_error if a function leaves its domain.
  std::vector<std::vector<Number>> operator()(const Number& t, const std::vector<Number>& x,
                                              const std::vector<double>& p, const std::vector<double>& u, int order);

  Number number(double value) const;  // exact

 private:
  struct Place {
    std::size_t index;
    bool negated;
  };
  struct Step {
    symbolic::Op op;
    std::vector<Place> operands;
  };
  Place place(const program::Operand& operand) const;
  Number read(const Place& place) const { return place.negated ? -values_[place.index] : values_[place.index]; }
  void run_next();

  const program::Taylor& taylor_;
  int digits_;
  cln::float_format_t format_;
  std::size_t states_ = 0, at_k_ = 0, at_x_ = 0, at_w_ = 0, at_code_ = 0;
  std::size_t sums_ = 0;  // without padding
  std::vector<Step> code_;
  std::vector<Place> a_, b_, dx_;
  std::vector<Number> values_;
};

}  // namespace eomgen::reference
