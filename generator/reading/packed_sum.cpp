// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/packed_sum.hpp"

#include <cln/integer.h>

#include <algorithm>
#include <cstdlib>

#include "symbolic/small_numbers.hpp"

namespace eomgen::reading {
namespace {

bool is_trig(const Atom& atom) { return atom.op == Op::sin || atom.op == Op::cos; }
bool before(const AtomPtr& a, const AtomPtr& b) { return compare(*a, *b) < 0; }

AtomPtr dual_of(const Atom& atom) {
  return call(atom.op == Op::sin ? Op::cos : Op::sin, {atom.args[0]}).terms().begin()->first.front().atom;
}

}  // namespace

Lanes::Lanes(const Sum& sum) {
  cln::cl_I denominator = 1;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    for (const Factor& factor : monomial) {
      if (lane_of_.emplace(factor.atom.get(), none).second) atoms_.push_back(factor.atom);
      if (is_trig(*factor.atom)) denominator = cln::lcm(denominator, cln::denominator(factor.exponent));
    }
  }
  if (denominator > middle) throw TermBudget();
  one_ = cln::cl_I_to_long(denominator);
  const std::size_t given = atoms_.size();
  for (std::size_t i = 0; i < given; ++i) {
    if (is_trig(*atoms_[i])) atoms_.push_back(dual_of(*atoms_[i]));
  }
  std::stable_sort(atoms_.begin(), atoms_.end(), before);
  const auto equal = [](const AtomPtr& a, const AtomPtr& b) { return compare(*a, *b) == 0; };
  atoms_.erase(std::unique(atoms_.begin(), atoms_.end(), equal), atoms_.end());
  for (auto& [atom, lane] : lane_of_) lane = place_of(*atom);
  find_duals();
  exponents_.resize(atoms_.size());
  for (const auto& [monomial, coefficient] : sum.terms()) {
    for (const Factor& factor : monomial) {
      const std::uint32_t lane = lane_of_.at(factor.atom.get());
      if (duals_[lane] == none) exponents_[lane].push_back(factor.exponent);
    }
  }
  for (std::vector<Rational>& known : exponents_) {
    std::sort(known.begin(), known.end(), [](const Rational& a, const Rational& b) { return cln::compare(b, a) < 0; });
    known.erase(std::unique(known.begin(), known.end(), symbolic::same), known.end());
    if (known.size() >= static_cast<std::size_t>(absent)) throw TermBudget();
  }
  sizes_ = exponents_;
  for (std::vector<Rational>& sizes : sizes_) {
    for (Rational& size : sizes) size = cln::abs(size);
  }
}

void Lanes::find_duals() {
  duals_.assign(atoms_.size(), none);
  angle_of_.assign(atoms_.size(), none);
  for (std::uint32_t lane = 0; lane < atoms_.size(); ++lane) {
    if (!is_trig(*atoms_[lane])) continue;
    trig_.push_back(lane);
    duals_[lane] = place_of(*dual_of(*atoms_[lane]));
    if (atoms_[lane]->op == Op::sin) angles_.push_back({lane, duals_[lane]});
  }
  std::sort(angles_.begin(), angles_.end(), [this](const Angle& a, const Angle& b) {
    return compare(atoms_[a.sine]->args[0], atoms_[b.sine]->args[0]) < 0;
  });
  for (std::uint32_t i = 0; i < angles_.size(); ++i) angle_of_[angles_[i].sine] = angle_of_[angles_[i].cosine] = i;
}

std::uint32_t Lanes::place_of(const Atom& atom) const {
  const auto place = std::lower_bound(atoms_.begin(), atoms_.end(), atom,
                                      [](const AtomPtr& a, const Atom& b) { return compare(*a, b) < 0; });
  return static_cast<std::uint32_t>(place - atoms_.begin());
}

void Lanes::set_code(Word* term, std::uint32_t lane, long code) {
  Word& word = term[lane / per_word];
  word = (word & ~(static_cast<Word>(absent) << shift(lane))) | static_cast<Word>(code) << shift(lane);
}

void Lanes::set_exponent(Word* term, std::uint32_t lane, long exponent) const {
  if (exponent >= middle || exponent <= -middle) throw TermBudget();
  set_code(term, lane, exponent == 0 ? absent : middle - exponent);
}

std::vector<Lanes::Word> Lanes::pack(const Monomial& monomial) const {
  std::vector<Word> term(words(), ~Word{0});
  for (const Factor& factor : monomial) {
    const std::uint32_t lane = lane_of_.at(factor.atom.get());
    if (duals_[lane] == none) {
      const std::vector<Rational>& known = exponents_[lane];
      const auto found = std::find_if(known.begin(), known.end(),
                                      [&](const Rational& e) { return symbolic::same(e, factor.exponent); });
      set_code(term.data(), lane, found - known.begin());
      continue;
    }
    const cln::cl_I units = cln::numerator(factor.exponent * one_);
    if (cln::abs(units) >= middle) throw TermBudget();
    set_exponent(term.data(), lane, cln::cl_I_to_long(units));
  }
  return term;
}

Rational Lanes::exponent_of(std::uint32_t lane, long code) const {
  if (duals_[lane] == none) return exponents_[lane][static_cast<std::size_t>(code)];
  return Rational(middle - code) / one_;
}

Monomial Lanes::unpack(const Word* term) const {
  Monomial result;
  for (std::uint32_t lane = 0; lane < atoms_.size(); ++lane) {
    const long code = code_of(term, lane);
    if (code != absent) result.push_back({atoms_[lane], exponent_of(lane, code)});
  }
  return result;
}

Rational Lanes::degree(const Word* term) const {
  Rational others = 0;
  long trig = 0;
  for (std::uint32_t lane = 0; lane < atoms_.size(); ++lane) {
    const long code = code_of(term, lane);
    if (code == absent) continue;
    if (duals_[lane] != none)
      trig += std::abs(middle - code);
    else
      others = symbolic::plus(others, sizes_[lane][static_cast<std::size_t>(code)]);
  }
  return others + Rational(trig) / one_;
}

bool PackedSum::less(Entry a, Entry b) const {
  const Word *const x = term(a), *const y = term(b);
  for (std::size_t i = 0; i < words_; ++i) {
    if (x[i] != y[i]) return x[i] < y[i];
  }
  return false;
}

std::uint64_t PackedSum::hash(const Word* term) const {
  std::uint64_t h = 0;
  for (std::size_t i = 0; i < words_; ++i) {
    h = (h ^ term[i]) * 0x9e3779b97f4a7c15ull;
    h ^= h >> 32;
  }
  return h;
}

const PackedSum::Entry* PackedSum::find(std::uint64_t hash, const Word* wanted) const {
  return index_.find(hash, [&](Entry entry) { return std::equal(wanted, wanted + words_, term(entry)); });
}

PackedSum::Entry PackedSum::find(const Word* wanted) const {
  const Entry* const found = find(hash(wanted), wanted);
  return found != nullptr ? *found : none;
}

std::pair<PackedSum::Entry, bool> PackedSum::add(const Word* wanted, const Rational& coefficient) {
  const std::uint64_t h = hash(wanted);
  const Entry* const found = find(h, wanted);
  const Entry entry = found != nullptr ? *found : static_cast<Entry>(entries_.size());
  if (found == nullptr) {
    keys_.insert(keys_.end(), wanted, wanted + words_);
    entries_.push_back({0, false});
    index_.add(h, entry);
  }
  StoredTerm& held = entries_[entry];
  const bool was = !symbolic::is_zero(held.coefficient);
  held.coefficient = was ? symbolic::plus(held.coefficient, coefficient) : coefficient;
  const bool is = !symbolic::is_zero(held.coefficient);
  alive_ = alive_ + (is ? 1 : 0) - (was ? 1 : 0);
  if (held.listed) return {entry, false};
  held.listed = true;
  added_.push_back(entry);
  return {entry, true};
}

const std::vector<PackedSum::Entry>& PackedSum::sorted() {
  const auto ascending = [this](Entry a, Entry b) { return less(a, b); };
  const auto gone = [this](Entry entry) {
    entries_[entry].listed = !symbolic::is_zero(entries_[entry].coefficient);
    return !entries_[entry].listed;
  };
  std::erase_if(order_, gone);
  std::erase_if(added_, gone);
  if (!std::is_sorted(added_.begin(), added_.end(), ascending)) std::sort(added_.begin(), added_.end(), ascending);
  const auto old = static_cast<std::ptrdiff_t>(order_.size());
  order_.insert(order_.end(), added_.begin(), added_.end());
  added_.clear();
  std::inplace_merge(order_.begin(), order_.begin() + old, order_.end(), ascending);
  return order_;
}

}  // namespace eomgen::reading
