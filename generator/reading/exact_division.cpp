// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/exact_division.hpp"

#include <cln/integer.h>

#include <algorithm>
#include <unordered_map>

#include "symbolic/small_numbers.hpp"
#include "symbolic/small_vector.hpp"

namespace eomgen::reading {
namespace {

// Packed exponents, those of the first atom leftmost; the highest bit of each lane is spare.
using Word = std::uint64_t;
using Powers = symbolic::SmallVector<Word, 4>;
constexpr std::uint32_t per_word = 4, bits = 16;
constexpr Word spare = 0x8000800080008000u, lane_mask = 0xffff;
constexpr long largest = 0x3fff;

struct Term {
  Powers powers;
  Rational coefficient;
};
using Terms = std::vector<Term>;  // greatest powers first

unsigned shift(std::uint32_t lane) { return bits * (per_word - 1 - lane % per_word); }

/// a / b; no exponent of b is greater than that of a.
std::optional<Powers> polynomial_quotient(const Powers& a, const Powers& b) {
  Powers result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Word difference = (a[i] | spare) - b[i];
    if ((difference & spare) != spare) return std::nullopt;
    result.push_back(difference & ~spare);
  }
  return result;
}

Powers polynomial_product(const Powers& a, const Powers& b) {
  Powers result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(a[i] + b[i]);
  return result;
}

/// The atoms of two sums, ascending.
class Letters {
 public:
  Letters(const Sum& a, const Sum& b) {
    for (const Sum* sum : {&a, &b}) {
      for (const auto& [monomial, coefficient] : sum->terms()) {
        for (const Factor& factor : monomial) {
          if (lane_of_.emplace(factor.atom.get(), 0).second) atoms_.push_back(factor.atom);
        }
      }
    }
    const auto before = [](const AtomPtr& x, const AtomPtr& y) { return compare(*x, *y) < 0; };
    const std::vector<AtomPtr> met = atoms_;
    std::sort(atoms_.begin(), atoms_.end(), before);
    const auto equal = [](const AtomPtr& x, const AtomPtr& y) { return compare(*x, *y) == 0; };
    atoms_.erase(std::unique(atoms_.begin(), atoms_.end(), equal), atoms_.end());
    for (const AtomPtr& atom : met) {
      const auto place = std::lower_bound(atoms_.begin(), atoms_.end(), atom, before);
      lane_of_[atom.get()] = static_cast<std::uint32_t>(place - atoms_.begin());
    }
  }

  /// The least exponent of each atom, 0 if a term does not contain it.
  std::vector<Rational> common(const Sum& sum) const {
    std::vector<Rational> least(atoms_.size(), Rational(0));
    std::vector<std::size_t> times(atoms_.size(), 0);
    for (const auto& [monomial, coefficient] : sum.terms()) {
      for (const Factor& factor : monomial) {
        const std::uint32_t lane = lane_of_.at(factor.atom.get());
        if (times[lane]++ == 0 || factor.exponent < least[lane]) least[lane] = factor.exponent;
      }
    }
    for (std::size_t lane = 0; lane < least.size(); ++lane) {
      if (times[lane] < sum.size() && cln::plusp(least[lane])) least[lane] = 0;
    }
    return least;
  }

  /// The sum without its common factor, in the order of its terms, which is that of their powers.
  std::optional<Terms> polynomial(const Sum& sum, const std::vector<Rational>& common) const {
    const std::size_t words = (atoms_.size() + per_word - 1) / per_word;
    // An absent exponent is 0, which is greater than a negative common one.
    Powers absent;
    for (std::size_t i = 0; i < words; ++i) absent.push_back(0);
    std::vector<bool> needed(atoms_.size(), false);  // in every term
    std::ptrdiff_t needed_ones = 0;
    for (std::uint32_t lane = 0; lane < common.size(); ++lane) {
      needed[lane] = cln::minusp(common[lane]) && !set(absent, lane, -common[lane]);
      needed_ones += needed[lane] ? 1 : 0;
    }
    Terms result;
    for (const auto& [monomial, coefficient] : sum.terms()) {
      Term term{absent, coefficient};
      std::ptrdiff_t missing = needed_ones;
      for (const Factor& factor : monomial) {
        const std::uint32_t lane = lane_of_.at(factor.atom.get());
        missing -= needed[lane] ? 1 : 0;
        if (!set(term.powers, lane, factor.exponent - common[lane])) return std::nullopt;
      }
      if (missing != 0) return std::nullopt;
      result.push_back(std::move(term));
    }
    const auto greater = [](const Term& a, const Term& b) { return b.powers < a.powers; };
    if (!std::is_sorted(result.begin(), result.end(), greater)) std::sort(result.begin(), result.end(), greater);
    return result;
  }

  /// Whether a power of a sum gets an integer exponent without the common factor: then it is expanded.
  bool expands_power(const Sum& sum, const std::vector<Rational>& common) const {
    const auto opened = [&](const Factor& factor) {
      if (factor.atom->op != Op::add && factor.atom->op != Op::abs) return false;
      const Rational rest = factor.exponent - common[lane_of_.at(factor.atom.get())];
      return is_integer(rest) && cln::plusp(rest);
    };
    return std::any_of(sum.terms().begin(), sum.terms().end(),
                       [&](const auto& term) { return std::any_of(term.first.begin(), term.first.end(), opened); });
  }

  Monomial monomial(const std::vector<Rational>& exponents) const {
    Monomial result;
    for (std::size_t lane = 0; lane < exponents.size(); ++lane) {
      if (!cln::zerop(exponents[lane])) result.push_back({atoms_[lane], exponents[lane]});
    }
    return result;
  }

  Sum sum(const Terms& terms) const {
    std::vector<std::pair<Monomial, Rational>> result;
    for (const Term& term : terms) {
      Monomial monomial;
      for (std::uint32_t lane = 0; lane < atoms_.size(); ++lane) {
        const auto exponent = static_cast<long>(term.powers[lane / per_word] >> shift(lane) & lane_mask);
        if (exponent != 0) monomial.push_back({atoms_[lane], exponent});
      }
      result.emplace_back(std::move(monomial), term.coefficient);
    }
    return Sum::ascending(std::move(result));
  }

 private:
  static bool set(Powers& powers, std::uint32_t lane, const Rational& exponent) {
    if (!is_integer(exponent) || cln::minusp(exponent) || exponent > largest) return false;
    Word& word = powers[lane / per_word];
    word = (word & ~(lane_mask << shift(lane))) | static_cast<Word>(to_long(exponent)) << shift(lane);
    return true;
  }

  std::vector<AtomPtr> atoms_;
  std::unordered_map<const Atom*, std::uint32_t> lane_of_;  // for lookup only
};

/// rest - by divisor, without the leading terms of both, which cancel.
Terms remainder(Terms& rest, const Term& by, const Terms& divisor) {
  Terms result;
  result.reserve(rest.size() + divisor.size());
  auto i = rest.begin() + 1;
  for (auto j = divisor.begin() + 1; j != divisor.end(); ++j) {
    Term term{polynomial_product(by.powers, j->powers), -(by.coefficient * j->coefficient)};
    while (i != rest.end() && term.powers < i->powers) result.push_back(std::move(*i++));
    if (i != rest.end() && i->powers == term.powers)
      term.coefficient = symbolic::plus(term.coefficient, (i++)->coefficient);
    if (!symbolic::is_zero(term.coefficient)) result.push_back(std::move(term));
  }
  std::move(i, rest.end(), std::back_inserter(result));
  return result;
}

/// The greatest exponent of each atom.
Powers degrees(const Terms& terms) {
  Powers result = terms.front().powers;
  for (const Term& term : terms) {
    for (std::uint32_t lane = 0; lane < per_word * result.size(); ++lane) {
      const Word of_this_lane = lane_mask << shift(lane);
      Word& most = result[lane / per_word];
      const Word here = term.powers[lane / per_word] & of_this_lane;
      if (here > (most & of_this_lane)) most = (most & ~of_this_lane) | here;
    }
  }
  return result;
}

/// Empty if there is a remainder. If the division is exact, first and last terms divide, and degrees subtract.
std::optional<Terms> divide_polynomials(Terms rest, const Terms& divisor) {
  Terms result;
  if (!polynomial_quotient(rest.front().powers, divisor.front().powers) ||
      !polynomial_quotient(rest.back().powers, divisor.back().powers))
    return std::nullopt;
  const std::optional<Powers> most = polynomial_quotient(degrees(rest), degrees(divisor));
  if (!most) return std::nullopt;
  while (!rest.empty()) {
    std::optional<Powers> powers = polynomial_quotient(rest.front().powers, divisor.front().powers);
    if (!powers || !polynomial_quotient(*most, *powers)) return std::nullopt;
    result.push_back({*std::move(powers), rest.front().coefficient / divisor.front().coefficient});
    rest = remainder(rest, result.back(), divisor);
  }
  return result;
}

}  // namespace

std::size_t display_operation_count(const Sum& sum) {
  constexpr std::size_t of_a_symbol = 1, of_a_power = 5, of_a_product = 2;
  std::size_t result = 0;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    const std::size_t parts = monomial.size() + (is_one(coefficient) ? 0 : 1);
    std::size_t each = parts > 1 ? 1 + of_a_product * parts : 0;
    for (const Factor& factor : monomial) each += is_one(factor.exponent) ? of_a_symbol : of_a_power;
    if (!is_one(coefficient)) each += of_a_symbol;
    result += each + (sum.size() > 1 ? 1 : 0);
  }
  return result;
}

namespace {

std::optional<Sum> divide_polynomials(const Letters& letters, const Sum& a, const std::vector<Rational>& common_a,
                                      const Sum& b, const std::vector<Rational>& common_b) {
  const std::optional<Terms> divisor = letters.polynomial(b, common_b);
  if (!divisor) return std::nullopt;
  std::optional<Terms> dividend = letters.polynomial(a, common_a);
  if (!dividend) return std::nullopt;
  const std::optional<Terms> terms = divide_polynomials(*std::move(dividend), *divisor);
  if (!terms) return std::nullopt;
  Sum whole = letters.sum(*terms);
  work::consume_budget(display_operation_count(whole) + 2 * whole.size());
  return whole;
}

std::optional<Sum> divide_expanded(const Sum& a, const Content& common_a, const Sum& b, const Content& common_b) {
  const Sum dividend = divide(a, common_a), divisor = divide(b, common_b);
  const Letters letters(dividend, divisor);
  const std::vector<Rational> none = letters.common(Sum());
  const std::optional<Sum> whole = divide_polynomials(letters, dividend, none, divisor, none);
  if (!whole) return std::nullopt;
  return Sum(common_a.monomial, common_a.number / common_b.number) * multiply(inverse(common_b.monomial), {}) * *whole;
}

}  // namespace

std::optional<Sum> divide_exactly(const Sum& a, const Sum& b) {
  const Letters letters(a, b);
  const std::vector<Rational> common_a = letters.common(a), common_b = letters.common(b);
  if (letters.expands_power(a, common_a) || letters.expands_power(b, common_b))
    return divide_expanded(a, content(a), b, content(b));
  // The operations of extracting the common factors.
  work::consume_budget(2 * (a.size() + b.size()));
  const std::optional<Sum> whole = divide_polynomials(letters, a, common_a, b, common_b);
  if (!whole) return std::nullopt;
  return Sum(letters.monomial(common_a), 1) * multiply(inverse(letters.monomial(common_b)), {}) * *whole;
}

}  // namespace eomgen::reading
