// SPDX-License-Identifier: GPL-3.0-or-later
// sin^2 + cos^2 = 1, in whichever direction leaves fewer terms.
#include <cln/integer.h>

#include <algorithm>

#include "reading/packed_sum.hpp"
#include "reading/trig.hpp"
#include "symbolic/small_numbers.hpp"

namespace eomgen::reading {
namespace {

constexpr int most_square_rounds = 6;
constexpr long most_pairs = 64;  // higher powers are not expanded

/// Operation counts as for sums: one for a product of two terms or an addition of a term.
constexpr std::size_t operations_of_a_pair = 4, operations_of_a_merge = 3, operations_of_a_replacement = 5;
std::size_t operations_of_a_power(std::size_t pairs) {
  return 1 + 2 * (pairs * (pairs + 1) - 2) + 3 * (pairs + 1);  // 1, the powers of 1 - g^2, their terms
}

/// The number of factors f^2 in a term; 0 if f is under a root or in a denominator.
long pairs_of(const Lanes& lanes, const Lanes::Word* term, std::uint32_t f) {
  const long exponent = lanes.exponent(term, f);
  return exponent > 0 && exponent % lanes.one() == 0 ? exponent / lanes.one() / 2 : 0;
}

bool has_squares(const Sum& sum) {
  for (const auto& [monomial, coefficient] : sum.terms()) {
    for (const Factor& factor : monomial) {
      const bool trig = factor.atom->op == Op::sin || factor.atom->op == Op::cos;
      if (trig && is_integer(factor.exponent) && factor.exponent >= 2) return true;
    }
  }
  return false;
}

class Merging {
 public:
  explicit Merging(PackedSum& sum) : sum_(sum), lanes_(sum.lanes()), rest_(lanes_.words()), partner_(rest_) {}

  // Passes over the whole sum; the search continues behind a merged term.
  void run() {
    while (pass()) {
    }
    work::consume_budget(spent_);
  }

 private:
  using Entry = PackedSum::Entry;

  bool pass() {
    const std::vector<Entry>& order = sum_.sorted();
    const auto greater = [this](Entry a, Entry b) { return sum_.less(b, a); };
    coming_.clear();
    bool changed = false;
    for (std::size_t next = 0; next < order.size() || !coming_.empty();) {
      Entry entry = 0;
      if (coming_.empty() || (next < order.size() && sum_.less(order[next], coming_.front()))) {
        entry = order[next++];
      } else {
        std::pop_heap(coming_.begin(), coming_.end(), greater);
        entry = coming_.back();
        coming_.pop_back();
      }
      if (symbolic::is_zero(sum_.coefficient(entry)) || !merge(entry)) continue;
      changed = true;
      for (const Entry added : added_) {
        if (!sum_.less(entry, added)) continue;  // left to the next pass
        coming_.push_back(added);
        std::push_heap(coming_.begin(), coming_.end(), greater);
      }
    }
    return changed;
  }

  // If f^2 m has a partner: k (f^2 + g^2) m -> k m and k m - k f^2 m -> k g^2 m; one term fewer each time.
  bool merge(Entry self) {
    for (const std::uint32_t f : lanes_.trig()) {
      if (pairs_of(lanes_, sum_.term(self), f) > 0 && merge(self, f)) return true;
    }
    return false;
  }

  bool merge(Entry self, std::uint32_t f) {
    spent_ += operations_of_a_pair;
    const std::uint32_t g = lanes_.dual(f);
    std::copy_n(sum_.term(self), rest_.size(), rest_.begin());
    lanes_.set_exponent(rest_.data(), f, lanes_.exponent(rest_.data(), f) - 2 * lanes_.one());
    partner_ = rest_;
    lanes_.set_exponent(partner_.data(), g, lanes_.exponent(rest_.data(), g) + 2 * lanes_.one());
    const Rational k = sum_.coefficient(self);
    if (holds(partner_, k)) {
      replace(self, partner_, rest_, k);
      return true;
    }
    if (holds(rest_, -k)) {
      replace(self, rest_, partner_, -k);
      return true;
    }
    return false;
  }

  bool holds(const std::vector<Lanes::Word>& term, const Rational& coefficient) const {
    const Entry found = sum_.find(term.data());
    return found != PackedSum::none && symbolic::same(sum_.coefficient(found), coefficient);
  }

  /// Merges `self` and `other`, which has this coefficient, into a multiple of `result`.
  void replace(Entry self, const std::vector<Lanes::Word>& other, const std::vector<Lanes::Word>& result,
               const Rational& coefficient) {
    spent_ += operations_of_a_merge;
    added_.clear();
    const Rational k = sum_.coefficient(self);
    sum_.add(sum_.term(self), -k);
    sum_.add(other.data(), -coefficient);
    const auto [entry, fresh] = sum_.add(result.data(), &result == &rest_ ? k : -k);
    if (fresh) added_.push_back(entry);
  }

  PackedSum& sum_;
  const Lanes& lanes_;
  std::vector<Lanes::Word> rest_, partner_;
  std::vector<Entry> coming_, added_;
  std::size_t spent_ = 0;
};

// f^2 -> 1 - g^2 with f, g = sin, cos of one angle.
PackedSum replace_square(PackedSum& sum, std::uint32_t f) {
  const Lanes& lanes = sum.lanes();
  const std::uint32_t g = lanes.dual(f);
  PackedSum result(lanes);
  std::size_t spent = operations_of_a_replacement;
  std::vector<Lanes::Word> term(lanes.words());
  for (const PackedSum::Entry entry : sum.sorted()) {
    std::copy_n(sum.term(entry), term.size(), term.begin());
    const long pairs = pairs_of(lanes, term.data(), f);
    Rational coefficient = sum.coefficient(entry);
    if (pairs == 0) {
      ++spent;
      result.add(term.data(), coefficient);
      continue;
    }
    spent += operations_of_a_power(static_cast<std::size_t>(pairs));
    if (pairs > most_pairs) throw TermBudget();
    lanes.set_exponent(term.data(), f, lanes.exponent(term.data(), f) - 2 * pairs * lanes.one());
    const long before = lanes.exponent(term.data(), g);
    for (long k = 0; k <= pairs; ++k) {  // (1 - g^2)^pairs by the binomial theorem
      lanes.set_exponent(term.data(), g, before + 2 * k * lanes.one());
      result.add(term.data(), coefficient);
      coefficient = coefficient * Rational(k - pairs) / Rational(k + 1);
    }
    if (result.size() > term_budget) {
      work::consume_budget(spent);
      throw TermBudget();
    }
  }
  work::consume_budget(spent);
  return result;
}

/// The display length: number of terms first, then of factors.
bool shorter(PackedSum& a, PackedSum& b) {
  if (a.size() != b.size()) return a.size() < b.size();
  const auto factors = [](PackedSum& sum) {
    Rational total = 0;
    for (const PackedSum::Entry entry : sum.sorted())
      total = symbolic::plus(total, sum.lanes().degree(sum.term(entry)));
    return total;
  };
  return factors(a) < factors(b);
}

PackedSum merged(PackedSum sum) {
  Merging(sum).run();
  return sum;
}

/// Angles with a square of a sine or cosine.
std::vector<Lanes::Angle> squared_angles(PackedSum& sum) {
  const Lanes& lanes = sum.lanes();
  std::vector<bool> found(lanes.angles().size(), false);
  for (const PackedSum::Entry entry : sum.sorted()) {
    for (const std::uint32_t lane : lanes.trig())
      found[lanes.angle(lane)] = found[lanes.angle(lane)] || pairs_of(lanes, sum.term(entry), lane) > 0;
  }
  std::vector<Lanes::Angle> result;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) result.push_back(lanes.angles()[i]);
  }
  return result;
}

/// Lanes of sines and cosines in the numerator.
std::vector<std::uint32_t> trig_factors(const Lanes& lanes, const Lanes::Word* term) {
  std::vector<std::uint32_t> result;
  for (const std::uint32_t lane : lanes.trig()) {
    const long exponent = lanes.exponent(term, lane);
    if (exponent > 0 && exponent % lanes.one() == 0) result.push_back(lane);
  }
  return result;
}

/// Adopts `other` if it is shorter.
bool improve(PackedSum& best, PackedSum other) {
  if (!shorter(other, best)) return false;
  best = std::move(other);
  return true;
}

bool has_products(const Sum& sum) {
  return std::any_of(sum.terms().begin(), sum.terms().end(), [](const auto& term) {
    return std::count_if(term.first.begin(), term.first.end(), [](const Factor& factor) {
             return factor.atom->op == Op::sin || factor.atom->op == Op::cos;
           }) > 1;
  });
}

PackedSum packed(const Lanes& lanes, const Sum& sum, const Rational& factor) {
  PackedSum result(lanes);
  for (const auto& [monomial, coefficient] : sum.terms())
    result.add(lanes.pack(monomial).data(), symbolic::times(coefficient, factor));
  return result;
}

/// Whether the partner of c term, with f' in place of f in two factors, is present with coefficient c or -c.
bool has_partner(const PackedSum& sum, const Lanes::Word* term, const Rational& c, std::uint32_t a, std::uint32_t b) {
  const Lanes& lanes = sum.lanes();
  std::vector<Lanes::Word> partner(term, term + lanes.words());
  for (const std::uint32_t lane : {a, b}) {
    const std::uint32_t dual = lanes.dual(lane);
    lanes.set_exponent(partner.data(), lane, lanes.exponent(partner.data(), lane) - lanes.one());
    lanes.set_exponent(partner.data(), dual, lanes.exponent(partner.data(), dual) + lanes.one());
  }
  const PackedSum::Entry found = sum.find(partner.data());
  if (found == PackedSum::none) return false;
  const Rational& other = sum.coefficient(found);
  return symbolic::same(other, c) || symbolic::same(other, -c);
}

}  // namespace

bool may_recombine(const Sum& sum) {
  if (!has_products(sum)) return false;
  constexpr std::size_t operations = 8;
  const Lanes lanes(sum);
  PackedSum terms = packed(lanes, sum, 1);
  std::size_t spent = 0;
  for (const PackedSum::Entry entry : terms.sorted()) {
    const Lanes::Word* const term = terms.term(entry);
    const std::vector<std::uint32_t> factors = trig_factors(lanes, term);
    for (std::size_t i = 0; i < factors.size(); ++i) {
      for (std::size_t j = i + 1; j < factors.size(); ++j) {
        if (lanes.angle(factors[i]) == lanes.angle(factors[j])) continue;
        spent += operations;
        if (has_partner(terms, term, terms.coefficient(entry), factors[i], factors[j])) return true;
      }
    }
  }
  work::consume_budget(spent);
  return false;
}

Sum reduce_squares(const Sum& sum) {
  if (!has_squares(sum)) return sum;
  const Lanes lanes(sum);
  cln::cl_I denominator = 1;  // of all coefficients: integer sums are faster
  for (const auto& [monomial, coefficient] : sum.terms())
    denominator = cln::lcm(denominator, cln::denominator(coefficient));
  PackedSum best = merged(packed(lanes, sum, denominator));  // sufficient in most cases
  for (int round = 0; round < most_square_rounds; ++round) {
    bool improved = false;
    for (const Lanes::Angle& angle : squared_angles(best)) {
      PackedSum with_cos = merged(replace_square(best, angle.sine));
      PackedSum with_sin = merged(replace_square(best, angle.cosine));
      improved = improve(best, std::move(with_sin)) || improved;
      improved = improve(best, std::move(with_cos)) || improved;
    }
    if (!improved) break;
  }
  std::vector<std::pair<Monomial, Rational>> terms;
  for (const PackedSum::Entry entry : best.sorted())
    terms.emplace_back(lanes.unpack(best.term(entry)), best.coefficient(entry) / denominator);
  return Sum::ascending(std::move(terms));
}

}  // namespace eomgen::reading
