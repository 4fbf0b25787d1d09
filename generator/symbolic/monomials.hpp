// SPDX-License-Identifier: GPL-3.0-or-later
// Products of powers and sums of them, for the three kinds of sums of products: of the compiled form
// (symbolic/polynomial), of the optimiser (program/polynomials) and of the display form (reading/sum). They differ in
// their bases and exponents only. A list of powers is ascending, with each base once and no exponent 0.
#pragma once

#include <cstdint>
#include <utility>

namespace eomgen::symbolic {

/// Calls take(x, y) for each base of two lists of powers, ascending, with pointers to its powers; null in the list that
/// lacks it. `compare(p, q)`: negative, 0 or positive by the bases. Ends with false once `take` returns false.
template <class Powers, class Compare, class Take>
bool merge_powers(const Powers& a, const Powers& b, const Compare& compare, const Take& take) {
  auto i = a.begin(), j = b.begin();
  while (i != a.end() || j != b.end()) {
    const int c = i == a.end() ? 1 : j == b.end() ? -1 : compare(*i, *j);
    const auto *const x = c <= 0 ? &*i++ : nullptr, *const y = c >= 0 ? &*j++ : nullptr;
    if (!take(x, y)) return false;
  }
  return true;
}

/// a b^power_of_b for lists of powers, which are ascending by `base`, with each base once and no exponent 0.
template <auto base, class Powers>
Powers product_of_powers(const Powers& a, const Powers& b, std::int32_t power_of_b = 1) {
  Powers result;
  result.reserve(a.size() + b.size());
  auto i = a.begin(), j = b.begin();
  const auto end_i = a.end(), end_j = b.end();
  while (i != end_i && j != end_j) {
    auto factor = *i;
    if (factor.*base < (*j).*base) {
      ++i;
    } else if ((*j).*base < factor.*base) {
      factor = *j++;
      factor.exponent *= power_of_b;
    } else {
      factor.exponent += j->exponent * power_of_b;
      ++i, ++j;
      if (factor.exponent == 0) continue;
    }
    result.push_back_unchecked(factor);
  }
  for (; i != end_i; ++i) result.push_back_unchecked(*i);
  for (; j != end_j; ++j) {
    auto factor = *j;
    factor.exponent *= power_of_b;
    result.push_back_unchecked(factor);
  }
  return result;
}

/// Adds a term to a map of monomials with nonzero coefficients. `plus`, `is_zero`: of coefficients.
template <class Terms, class Monomial, class Coefficient, class Plus, class IsZero>
void add_like_term(Terms& terms, Monomial&& monomial, const Coefficient& coefficient, const Plus& plus,
                   const IsZero& is_zero) {
  const auto [place, is_new] = terms.try_emplace(std::forward<Monomial>(monomial), coefficient);
  if (is_new) return;
  place->second = plus(place->second, coefficient);
  if (is_zero(place->second)) terms.erase(place);
}

}  // namespace eomgen::symbolic
