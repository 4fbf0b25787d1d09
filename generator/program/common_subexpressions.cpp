// SPDX-License-Identifier: GPL-3.0-or-later
// Common subexpression elimination, independent of the order of operations. The most frequent pair of factors of all
// products becomes a node, repeatedly. Pairs of summands are treated in the same way.
#include <cln/rational.h>

#include <algorithm>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

#include "program/polynomials.hpp"
#include "symbolic/small_numbers.hpp"

namespace eomgen::program {
namespace {

// A queue of the most frequent pairs while pairs are added and removed.

/// Pairs are 64-bit keys that occur in rows. `seed` breaks ties; the order of the hash table has no influence.
class FrequentPairQueue {
 public:
  explicit FrequentPairQueue(std::uint64_t seed) : seed_(seed), entries_(std::size_t{1} << first_bits) {}

  void add(std::uint64_t key, std::uint32_t row, int count = 1) {
    Entry& entry = at(key);
    entry.count += count;
    entry.rows.push_back(row);
    if (entry.count >= 2) heap_.push({entry.count, rank(key), key});
  }
  void remove(std::uint64_t key, int count = 1) { at(key).count -= count; }

  /// Pops the most frequent pair that occurs at least twice, and the rows that may still contain it. Returns false if
  /// there is none.
  bool pop(std::uint64_t& key, std::vector<std::uint32_t>& rows) {
    while (!heap_.empty()) {
      const Candidate top = heap_.top();
      heap_.pop();
      Entry& entry = at(top.key);
      if (entry.count < 2) continue;
      if (entry.count != top.count) {  // outdated: pushed again with the current count
        heap_.push({entry.count, top.rank, top.key});
        continue;
      }
      key = top.key;
      rows.assign(entry.rows.begin(), entry.rows.end());
      entry.rows.truncate(0);
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
      return true;
    }
    return false;
  }

 private:
  struct Entry {
    std::uint64_t key = 0;
    int count = 0;
    bool taken = false;
    symbolic::SmallVector<std::uint32_t, 2> rows;
  };
  struct Candidate {
    int count;
    std::uint64_t rank, key;
    friend bool operator<(const Candidate& a, const Candidate& b) {
      if (a.count != b.count) return a.count < b.count;
      return a.rank != b.rank ? a.rank < b.rank : a.key < b.key;
    }
  };
  static constexpr int first_bits = 6;

  std::uint64_t rank(std::uint64_t key) const { return seed_ == 0 ? ~key : hash_mix(key, seed_); }

  Entry& place(std::uint64_t key) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t i = hash_mix(key, 0) & mask;
    while (entries_[i].taken && entries_[i].key != key) i = (i + 1) & mask;
    return entries_[i];
  }
  Entry& at(std::uint64_t key) {
    Entry* entry = &place(key);
    if (entry->taken) return *entry;
    if (2 * ++taken_ > entries_.size()) {
      std::vector<Entry> old = std::exchange(entries_, std::vector<Entry>(2 * entries_.size()));
      for (Entry& moved : old) {
        if (moved.taken) place(moved.key) = std::move(moved);
      }
      entry = &place(key);
    }
    entry->key = key;
    entry->taken = true;
    return *entry;
  }

  std::uint64_t seed_;
  std::vector<Entry> entries_;  // the size is a power of 2; at most half are in use
  std::size_t taken_ = 0;
  std::priority_queue<Candidate> heap_;
};

using Item = std::uint32_t;

constexpr Item number_bit = 0x80000000u;  // an index into the numbers
constexpr Item divisor_bit = 0x40000000u;

/// Numbers by index, for use in keys.
class Numbers {
 public:
  Item index(const Rational& value) {
    const std::uint64_t hash = symbolic::hash_of(value);
    const Item* const known = index_.find(hash, [&](Item i) { return symbolic::same(values_[i], value); });
    if (known != nullptr) return *known;
    values_.push_back(value);
    index_.add(hash, static_cast<Item>(values_.size() - 1));
    return static_cast<Item>(values_.size() - 1);
  }
  const Rational& operator[](Item index) const { return values_[index]; }

 private:
  std::vector<Rational> values_;
  symbolic::HashIndex index_;
};

class ProductSharing {
 public:
  ProductSharing(PolynomialGraph& graph, std::uint64_t seed) : graph_(graph), pairs_(seed) {}

  void run() {
    for (const NodeId id : graph_.topological_order()) {
      if (graph_[id].kind != Node::Kind::sum) continue;
      for (std::size_t k = 0; k < graph_[id].terms.size(); ++k) add_row(id, k);
    }
    for (std::uint32_t row = 0; row < rows_.size(); ++row) count(row, +1);
    std::uint64_t key = 0;
    std::vector<std::uint32_t> where;
    while (pairs_.pop(key, where)) extract(static_cast<Item>(key >> 32), static_cast<Item>(key), where);
    write_back();
  }

 private:
  struct Row {
    NodeId node;
    std::size_t term;
    std::vector<Item> items;  // ascending, with repetition
  };
  struct Counted {
    Item item;
    int times;
    bool wanted;
  };
  static constexpr std::size_t longest = 40;  // the number of pairs is quadratic

  void add_row(NodeId id, std::size_t k) {
    const Term& term = graph_[id].terms[k];
    Row row{id, k, {}};
    for (const Factor& f : term.factors) {
      if (std::abs(f.exponent) > 16) return;
      row.items.insert(row.items.end(), static_cast<std::size_t>(std::abs(f.exponent)),
                       f.exponent < 0 ? f.node | divisor_bit : f.node);
    }
    const Rational size = cln::abs(term.coefficient);
    if (size != 1) row.items.push_back(numbers_.index(size) | number_bit);
    if (row.items.size() < 2 || row.items.size() > longest) return;
    std::sort(row.items.begin(), row.items.end());
    rows_.push_back(std::move(row));
  }

  /// Counts the pairs of a row, or those that contain an item of `with`.
  void count(std::uint32_t index, int sign, const std::vector<Item>& with = {}) {
    distinct_.clear();
    for (const Item item : rows_[index].items) {
      if (distinct_.empty() || distinct_.back().item != item) {
        const bool wanted = with.empty() || std::find(with.begin(), with.end(), item) != with.end();
        distinct_.push_back({item, 0, wanted});
      }
      ++distinct_.back().times;
    }
    const auto change = [&](Item a, Item b, int times) {
      const std::uint64_t key = (std::uint64_t{a} << 32) | b;
      if (sign > 0)
        pairs_.add(key, index, times);
      else
        pairs_.remove(key, times);
    };
    for (std::size_t i = 0; i < distinct_.size(); ++i) {
      const Counted& a = distinct_[i];
      if (a.wanted && a.times > 1) change(a.item, a.item, a.times / 2);
      for (std::size_t j = i + 1; j < distinct_.size(); ++j) {
        const Counted& b = distinct_[j];
        if (a.wanted || b.wanted) change(a.item, b.item, std::min(a.times, b.times));
      }
    }
  }

  Term term_of(Item item) const {
    if (item & number_bit) return {numbers_[item & ~number_bit], {}};
    return {1, {{item & ~divisor_bit, item & divisor_bit ? -1 : 1}}};
  }

  static bool take(std::vector<Item>& items, Item a, Item b) {
    const auto first = std::find(items.begin(), items.end(), a);
    if (first == items.end()) return false;
    const auto second = std::find(first + 1, items.end(), b);
    if (second == items.end()) return false;
    items.erase(second);
    items.erase(first);
    return true;
  }

  void extract(Item a, Item b, const std::vector<std::uint32_t>& where) {
    const NodeId pair = graph_.fresh_sum({multiply(term_of(a), term_of(b))});
    for (const std::uint32_t index : where) {
      std::vector<Item> items = rows_[index].items;
      int times = 0;
      while (take(items, a, b)) ++times;
      if (times == 0) continue;
      count(index, -1, {a, b});
      items.insert(items.end(), static_cast<std::size_t>(times), pair);
      std::sort(items.begin(), items.end());
      rows_[index].items = std::move(items);
      count(index, +1, {a, b, pair});
    }
  }

  void write_back() {
    for (const Row& row : rows_) {
      Term& term = graph_.terms_of(row.node)[row.term];
      Term product{cln::minusp(term.coefficient) ? -1 : 1, {}};
      for (const Item item : row.items) product = multiply(product, term_of(item));
      term = std::move(product);
    }
  }

  PolynomialGraph& graph_;
  FrequentPairQueue pairs_;
  Numbers numbers_;
  std::vector<Row> rows_;
  std::vector<Counted> distinct_;  // for the current row
};

class SumSharing {
 public:
  SumSharing(PolynomialGraph& graph, std::uint64_t seed) : graph_(graph), pairs_(seed) {}

  void run() {
    for (const NodeId id : graph_.topological_order()) {
      const Node& node = graph_[id];
      if (node.kind != Node::Kind::sum || node.terms.size() < 2 || node.terms.size() > longest) continue;
      Row row{id, {}};
      for (const Term& term : node.terms) row.items.emplace_back(monomial(term.factors), term.coefficient);
      std::sort(row.items.begin(), row.items.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
      rows_.push_back(std::move(row));
    }
    for (std::uint32_t row = 0; row < rows_.size(); ++row) count(row, +1);
    std::uint64_t key = 0;
    std::vector<std::uint32_t> where;
    while (pairs_.pop(key, where)) extract(key, where);
    for (const Row& row : rows_) {
      std::vector<Term> terms;
      for (const auto& [item, coefficient] : row.items) terms.push_back({coefficient, monomials_[item]});
      graph_.terms_of(row.node) = std::move(terms);
    }
  }

 private:
  struct Row {
    NodeId node;
    std::vector<std::pair<Item, Rational>> items;  // monomial, coefficient; ascending
  };
  static constexpr std::size_t longest = 120;
  static constexpr std::uint64_t item_bits = 24;

  Item monomial(const Monomial& factors) {
    std::uint64_t hash = 0;
    for (const Factor& f : factors)
      hash = hash_mix(hash, (std::uint64_t{f.node} << 32) + static_cast<std::uint32_t>(f.exponent));
    const Item* const known = index_.find(hash, [&](Item i) { return monomials_[i] == factors; });
    if (known != nullptr) return *known;
    monomials_.push_back(factors);
    index_.add(hash, static_cast<Item>(monomials_.size() - 1));
    return static_cast<Item>(monomials_.size() - 1);
  }

  static Rational ratio(const Rational& b, const Rational& a) {
    if (symbolic::same(a, b)) return 1;
    return symbolic::is_minus_one(a) ? -b : symbolic::quotient(b, a);
  }

  /// Key of a + ratio b, up to a common factor.
  std::uint64_t key(const std::pair<Item, Rational>& a, const std::pair<Item, Rational>& b) {
    return (std::uint64_t{a.first} << (64 - item_bits)) | (std::uint64_t{b.first} << (64 - 2 * item_bits)) |
           numbers_.index(ratio(b.second, a.second));
  }

  void change(std::uint32_t index, int sign, std::size_t i, std::size_t j) {
    const auto& items = rows_[index].items;
    if (sign > 0)
      pairs_.add(key(items[i], items[j]), index);
    else
      pairs_.remove(key(items[i], items[j]));
  }

  /// Counts the pairs of a row.
  void count(std::uint32_t index, int sign) {
    const std::size_t size = rows_[index].items.size();
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = i + 1; j < size; ++j) change(index, sign, i, j);
    }
  }
  /// Counts the pairs with item i.
  void count_with(std::uint32_t index, int sign, std::size_t i) {
    const std::size_t size = rows_[index].items.size();
    for (std::size_t j = 0; j < i; ++j) change(index, sign, j, i);
    for (std::size_t j = i + 1; j < size; ++j) change(index, sign, i, j);
  }

  void extract(std::uint64_t pair, const std::vector<std::uint32_t>& where) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << item_bits) - 1;
    const Item a = static_cast<Item>(pair >> (64 - item_bits));
    const Item b = static_cast<Item>((pair >> (64 - 2 * item_bits)) & mask);
    const Rational ratio = numbers_[static_cast<Item>(pair & 0xffff)];
    const Item node = monomial({{graph_.fresh_sum({{1, monomials_[a]}, {ratio, monomials_[b]}}), 1}});
    for (const std::uint32_t index : where) {
      auto& items = rows_[index].items;
      const auto first = std::find_if(items.begin(), items.end(), [a](const auto& item) { return item.first == a; });
      const auto second = std::find_if(items.begin(), items.end(), [b](const auto& item) { return item.first == b; });
      if (first == items.end() || second == items.end() || second->second != ratio * first->second) continue;
      const Rational coefficient = first->second;
      count_with(index, -1, static_cast<std::size_t>(first - items.begin()));
      items.erase(first);
      const auto moved = std::find_if(items.begin(), items.end(), [b](const auto& item) { return item.first == b; });
      count_with(index, -1, static_cast<std::size_t>(moved - items.begin()));
      items.erase(moved);
      items.emplace_back(node, coefficient);  // the newest monomial; the order stays ascending
      count_with(index, +1, items.size() - 1);
    }
  }

  PolynomialGraph& graph_;
  FrequentPairQueue pairs_;
  Numbers numbers_;
  std::vector<Monomial> monomials_;
  symbolic::HashIndex index_;
  std::vector<Row> rows_;
};

}  // namespace

void share_products(PolynomialGraph& graph, std::uint64_t seed) { ProductSharing(graph, seed).run(); }
void share_sums(PolynomialGraph& graph, std::uint64_t seed) { SumSharing(graph, seed).run(); }

}  // namespace eomgen::program
