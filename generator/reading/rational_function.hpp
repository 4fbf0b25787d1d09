// SPDX-License-Identifier: GPL-3.0-or-later
// Quotients of small polynomials; GiNaC factors, on fresh symbols in place of our atoms.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "reading/sum.hpp"

namespace eomgen::reading {

/// Denominators that are sums are brought together and cancelled where that makes the sum shorter.
Sum cancel(const Sum& sum);

/// u^2/sqrt(u^2 + v^2) + v^2/sqrt(u^2 + v^2) -> sqrt(u^2 + v^2): a root that all terms have takes in what is left of
/// them.
Sum absorb_roots(const Sum& sum);

/// a / b if it is a sum without b in a denominator.
std::optional<Sum> exact_quotient(const Sum& a, const Sum& b);

/// Content times irreducible factors (primitive, of canonical sign, in our order); large sums are left whole.
struct Factorisation {
  Content content;
  int sign = 1;
  std::vector<std::pair<Sum, long>> factors;
};
Factorisation factorise(const Sum& sum);

/// a / b, cancelled; throws std::domain_error for b = 0.
Sum quotient(const Sum& a, const Sum& b);

}  // namespace eomgen::reading
