// SPDX-License-Identifier: GPL-3.0-or-later
// A sum while its sines and cosines are worked on: the exponents of a term stand side by side in a few words, one lane
// for each atom of the sum, such that the order of the words is the order of the monomials (sum.hpp); terms are found
// by a hash. In: a Sum. Out: the same Sum with its terms changed; the atoms stay what they are, each sine beside its
// cosine.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "reading/sum.hpp"

namespace eomgen::reading {

/// The atoms of a sum, ascending, and those that their sines and cosines may become.
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
  std::uint32_t dual(std::uint32_t lane) const { return duals_[lane]; }      // of cos(x) that of sin(x)
  std::uint32_t angle(std::uint32_t lane) const { return angle_of_[lane]; }  // into angles()
  long one() const { return one_; }                                          // exponents are multiples of 1/one()

  using Word = std::uint64_t;
  /// Of a sine or cosine, in units of 1/one().
  long exponent(const Word* term, std::uint32_t lane) const {
    const long code = code_of(term, lane);
    return code == absent ? 0 : middle - code;
  }
  /// Throws TermBudget beyond what anybody reads.
  void set_exponent(Word* term, std::uint32_t lane, long exponent) const;

  std::vector<Word> pack(const Monomial& monomial) const;
  Monomial unpack(const Word* term) const;
  /// The sum of the absolute exponents.
  Rational degree(const Word* term) const;

 private:
  // Lanes are compared from the left: what is there before what is absent, greater exponents before less.
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
  std::unordered_map<const Atom*, std::uint32_t> lane_of_;  // of the atoms that the sum holds; looked up only
  std::vector<Angle> angles_;
  std::vector<std::uint32_t> trig_, duals_, angle_of_;
  std::vector<std::vector<Rational>> exponents_, sizes_;  // of atoms that are no sines and cosines: descending, by code
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
  /// 0: the term is gone.
  const Rational& coefficient(Entry entry) const { return entries_[entry].coefficient; }
  bool less(Entry a, Entry b) const;
  /// The term with these exponents, there or gone; or none.
  Entry find(const Word* term) const;
  /// Returns where it is, and whether it was not listed before.
  std::pair<Entry, bool> add(const Word* term, const Rational& coefficient);

  /// All terms, ascending; from here on they are listed.
  const std::vector<Entry>& sorted();

 private:
  struct Held {
    std::uint64_t hash;
    Rational coefficient;
    bool listed = false;
  };
  std::uint64_t hash(const Word* term) const;
  void grow();

  const Lanes* lanes_;
  std::size_t words_, alive_ = 0;
  std::vector<Word> keys_;
  std::vector<Held> entries_;
  std::vector<Entry> slots_;          // a power of 2 of them, half of them open
  std::vector<Entry> order_, added_;  // listed: ascending; since then
};

}  // namespace eomgen::reading
