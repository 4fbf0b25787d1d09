// SPDX-License-Identifier: GPL-3.0-or-later
// Common subexpressions that no order of operations would show: the most frequent pair of factors of all products
// becomes a node, then the next; the same for pairs of summands.
#include <cln/rational.h>

#include <algorithm>
#include <map>

#include "program/frequency.hpp"

namespace eomgen::program {
namespace {

using Item = std::uint32_t;
constexpr Item number_bit = 0x80000000u;  // an index into the numbers
constexpr Item divisor_bit = 0x40000000u;

/// Numbers by index, so that they can be parts of keys.
class Numbers {
 public:
  Item index(const Rational& value) {
    const auto found = std::find(values_.begin(), values_.end(), value);
    if (found != values_.end()) return static_cast<Item>(found - values_.begin());
    values_.push_back(value);
    return static_cast<Item>(values_.size() - 1);
  }
  const Rational& operator[](Item index) const { return values_[index]; }

 private:
  std::vector<Rational> values_;
};

class ProductSharing {
 public:
  ProductSharing(Polynomials& graph, std::uint64_t seed) : graph_(graph), pairs_(seed) {}

  void run() {
    for (const NodeId id : graph_.order()) {
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
  static constexpr std::size_t longest = 40;  // pairs are quadratic

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

  void count(std::uint32_t index, int sign) {
    const std::vector<Item>& items = rows_[index].items;
    std::vector<std::pair<Item, int>> distinct;
    for (const Item item : items) {
      if (distinct.empty() || distinct.back().first != item) distinct.emplace_back(item, 0);
      ++distinct.back().second;
    }
    const auto change = [&](Item a, Item b, int times) {
      const std::uint64_t key = (std::uint64_t{a} << 32) | b;
      if (sign > 0)
        pairs_.add(key, index, times);
      else
        pairs_.remove(key, times);
    };
    for (std::size_t i = 0; i < distinct.size(); ++i) {
      if (distinct[i].second > 1) change(distinct[i].first, distinct[i].first, distinct[i].second / 2);
      for (std::size_t j = i + 1; j < distinct.size(); ++j) {
        change(distinct[i].first, distinct[j].first, std::min(distinct[i].second, distinct[j].second));
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
      count(index, -1);
      items.insert(items.end(), static_cast<std::size_t>(times), pair);
      std::sort(items.begin(), items.end());
      rows_[index].items = std::move(items);
      count(index, +1);
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

  Polynomials& graph_;
  Frequency pairs_;
  Numbers numbers_;
  std::vector<Row> rows_;
};

class SumSharing {
 public:
  SumSharing(Polynomials& graph, std::uint64_t seed) : graph_(graph), pairs_(seed) {}

  void run() {
    for (const NodeId id : graph_.order()) {
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
    const auto [found, inserted] = index_.try_emplace(factors, static_cast<Item>(monomials_.size()));
    if (inserted) monomials_.push_back(factors);
    return found->second;
  }

  /// a + ratio b, whatever it is multiplied by.
  std::uint64_t key(const std::pair<Item, Rational>& a, const std::pair<Item, Rational>& b) {
    return (std::uint64_t{a.first} << (64 - item_bits)) | (std::uint64_t{b.first} << (64 - 2 * item_bits)) |
           numbers_.index(b.second / a.second);
  }

  void count(std::uint32_t index, int sign) {
    const auto& items = rows_[index].items;
    for (std::size_t i = 0; i < items.size(); ++i) {
      for (std::size_t j = i + 1; j < items.size(); ++j) {
        if (sign > 0)
          pairs_.add(key(items[i], items[j]), index);
        else
          pairs_.remove(key(items[i], items[j]));
      }
    }
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
      count(index, -1);
      const Rational coefficient = first->second;
      items.erase(second);
      items.erase(first);
      items.emplace_back(node, coefficient);  // the newest monomial: still ascending
      count(index, +1);
    }
  }

  Polynomials& graph_;
  Frequency pairs_;
  Numbers numbers_;
  std::vector<Monomial> monomials_;
  std::map<Monomial, Item> index_;
  std::vector<Row> rows_;
};

}  // namespace

void share_products(Polynomials& graph, std::uint64_t seed) { ProductSharing(graph, seed).run(); }
void share_sums(Polynomials& graph, std::uint64_t seed) { SumSharing(graph, seed).run(); }

}  // namespace eomgen::program
