// SPDX-License-Identifier: GPL-3.0-or-later
// Powers of sums whose value a constraint gives: with sqrt(x^2 + y^2) = L, x/sqrt(x^2 + y^2) is x/L. In: the left-hand
// sides psi of holonomic constraints psi = 0. Out: sums that are equal wherever the constraints hold, and shorter.
#pragma once

#include <vector>

#include "reading/sum.hpp"

namespace eomgen::reading {

class ConstrainedRoots {
 public:
  explicit ConstrainedRoots(std::vector<Sum> psi) : psi_(std::move(psi)) {}

  /// The sum with these values. Only roots and denominators are replaced, no polynomial, so that equations keep their
  /// terms. The result holds only where the constraints do: it is not differentiated afterwards.
  Sum operator()(const Sum& sum) const;

 private:
  std::vector<Sum> psi_;
};

}  // namespace eomgen::reading
