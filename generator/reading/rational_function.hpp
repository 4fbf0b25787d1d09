// SPDX-License-Identifier: GPL-3.0-or-later
// Quotients of small polynomials. GiNaC factors them, with fresh symbols in place of our atoms.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "reading/sum.hpp"

namespace eomgen::reading {

/// Combines and cancels denominators that are sums, if that makes the sum shorter.
Sum cancel(const Sum& sum);

/// u^2/sqrt(u^2 + v^2) + v^2/sqrt(u^2 + v^2) -> sqrt(u^2 + v^2): absorbs the common cofactor of the terms into a root
/// that all of them share.
Sum absorb_roots(const Sum& sum);

/// a / b, if it is a sum without b in a denominator.
std::optional<Sum> exact_quotient(const Sum& a, const Sum& b);

/// Content times irreducible factors (primitive, of canonical sign, in canonical order). Large sums are not factored.
struct Factorisation {
  Content content;
  int sign = 1;
  std::vector<std::pair<Sum, long>> factors;
};
Factorisation factorise(const Sum& sum);

/// a / b, cancelled. Throws std::domain_error if b = 0.
Sum quotient(const Sum& a, const Sum& b);

}  // namespace eomgen::reading
