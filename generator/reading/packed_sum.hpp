// SPDX-License-Identifier: GPL-3.0-or-later
// A sum in packed form, for operations on its sines and cosines. The exponents of a term are packed into a few words,
// one lane for each atom of the sum. The order of the words is the order of the monomials (sum.hpp), and terms are
// found by a hash. In: a Sum. Out: the same Sum with changed terms. The atoms stay the same, each sine beside its
// cosine.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "reading/sum.hpp"
#include "symbolic/hash_index.hpp"

namespace eomgen::reading {

/// The atoms of a sum, ascending, and the sines and cosines that its own may turn into.
class Lanes {
 public:
  explicit Lanes(const Sum& sum);

  /// Lanes of sin(x) and cos(x).
  struct Angle {
    std::uint32_t sine, cosine;
  };
  static constexpr std::uint32_t none = 0xffffffff;

  std::size_t size() const { return atoms_.size(); }
  std::size_t words() const { return (atoms_.size() + per_word - 1) / per_word; }
  const std::vector<Angle>& angles() const { return angles_; }               // ascending by x
  const std::vector<std::uint32_t>& trig() const { return trig_; }           // their lanes, ascending
  std::uint32_t dual(std::uint32_t lane) const { return duals_[lane]; }      // sin(x) <-> cos(x)
  std::uint32_t angle(std::uint32_t lane) const { return angle_of_[lane]; }  // into angles()
  long one() const { return one_; }                                          // exponents are multiples of 1/one()

  using Word = std::uint64_t;
  /// The exponent of a sine or cosine, in units of 1/one().
  long exponent(const Word* term, std::uint32_t lane) const {
    const long code = code_of(term, lane);
    return code == absent ? 0 : middle - code;
  }
  /// Throws TermBudget if the exponent is too large to display.
  void set_exponent(Word* term, std::uint32_t lane, long exponent) const;

  std::vector<Word> pack(const Monomial& monomial) const;
  Monomial unpack(const Word* term) const;
  /// The sum of the absolute exponents.
  Rational degree(const Word* term) const;

 private:
  // Lanes are compared from the left: present before absent, greater exponents before smaller ones.
  static constexpr std::uint32_t per_word = 4, bits = 16;
  static constexpr long absent = 0xffff, middle = 0x7fff;
  static unsigned shift(std::uint32_t lane) { return bits * (per_word - 1 - lane % per_word); }
  static long code_of(const Word* term, std::uint32_t lane) {
    return static_cast<long>(term[lane / per_word] >> shift(lane) & absent);
  }
  static void set_code(Word* term, std::uint32_t lane, long code);
  void find_duals();
  std::uint32_t place_of(const Atom& atom) const;
  Rational exponent_of(std::uint32_t lane, long code) const;

  std::vector<AtomPtr> atoms_;
  std::unordered_map<const Atom*, std::uint32_t> lane_of_;  // of the atoms of the sum; for lookup only
  std::vector<Angle> angles_;
  std::vector<std::uint32_t> trig_, duals_, angle_of_;
  std::vector<std::vector<Rational>> exponents_, sizes_;  // of atoms other than sines and cosines: descending, by code
  long one_ = 1;
};

class PackedSum {
 public:
  using Word = Lanes::Word;
  using Entry = std::uint32_t;
  static constexpr Entry none = 0xffffffff;

  explicit PackedSum(const Lanes& lanes) : lanes_(&lanes), words_(lanes.words()) {}

  const Lanes& lanes() const { return *lanes_; }
  std::size_t size() const { return alive_; }
  const Word* term(Entry entry) const { return keys_.data() + entry * words_; }
  /// 0 if the term was cancelled.
  const Rational& coefficient(Entry entry) const { return entries_[entry].coefficient; }
  bool less(Entry a, Entry b) const;
  /// The term with these exponents, present or cancelled; otherwise none.
  Entry find(const Word* term) const;
  /// Returns its entry, and whether it was not listed before.
  std::pair<Entry, bool> add(const Word* term, const Rational& coefficient);

  /// All terms, ascending. Afterwards they count as listed.
  const std::vector<Entry>& sorted();

 private:
  struct StoredTerm {
    Rational coefficient;
    bool listed = false;
  };
  std::uint64_t hash(const Word* term) const;
  const Entry* find(std::uint64_t hash, const Word* term) const;

  const Lanes* lanes_;
  std::size_t words_, alive_ = 0;
  std::vector<Word> keys_;
  std::vector<StoredTerm> entries_;
  symbolic::HashIndex index_;
  std::vector<Entry> order_, added_;  // listed, ascending; added since
};

}  // namespace eomgen::reading
