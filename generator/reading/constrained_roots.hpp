// SPDX-License-Identifier: GPL-3.0-or-later
// Powers of sums whose value a constraint gives: with sqrt(x^2 + y^2) = L, x/sqrt(x^2 + y^2) is x/L. In: the left-hand
// sides psi of holonomic constraints psi = 0. Out: sums that are equal wherever the constraints hold, and shorter.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "reading/sum.hpp"

namespace eomgen::reading {

class ConstrainedRoots {
 public:
  /// psi: called once, if a sum has such powers.
  explicit ConstrainedRoots(std::function<std::vector<Sum>()> psi) : find_(std::move(psi)) {}

  /// The sum with these values. Only roots and denominators are replaced, no polynomial, so that equations keep their
  /// terms. The result holds only where the constraints do: it is not differentiated afterwards.
  Sum operator()(const Sum& sum) const;

 private:
  std::function<std::vector<Sum>()> find_;
  mutable std::optional<std::vector<Sum>> psi_;
};

/// By the holonomic constraints of a system that cannot open, without those that are too long to be displayed.
/// The result refers to the system.
ConstrainedRoots constrained_roots(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
