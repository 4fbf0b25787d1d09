// SPDX-License-Identifier: GPL-3.0-or-later
// Values of a canonical sum in binary64, at many points. In: a Sum. Out: its value; NaN where a function is not
// defined.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "reading/sum.hpp"

namespace eomgen::reading {

/// Evaluates each atom once, arguments first. The sum must outlive the evaluator.
class Evaluator {
 public:
  explicit Evaluator(const Sum& sum) : whole_(flat(sum)) {}

  /// The symbols, with their indices into `at`.
  const std::map<Symbol, std::size_t>& symbols() const { return symbols_; }

  /// `at`: a value for each symbol, at its index. Counts its operations: throws BudgetExceeded.
  double operator()(const std::vector<double>& at);

 private:
  struct Power {
    std::size_t item;
    int whole;        // the exponent if it is a small integer; else 0
    double exponent;  // else
  };
  struct Term {
    double coefficient;
    std::vector<Power> powers;
  };
  using Flat = std::vector<Term>;
  struct Item {
    Op op;
    std::size_t symbol = 0;
    std::vector<Flat> args;
    double value = 0;
  };
  struct Before {
    bool operator()(const Atom* a, const Atom* b) const { return compare(*a, *b) < 0; }
  };

  Flat flat(const Sum& sum);
  std::size_t place(const Atom& atom);
  double value(const Flat& sum) const;
  double function(const Item& item) const;

  std::map<const Atom*, std::size_t, Before> places_;
  std::map<Symbol, std::size_t> symbols_;
  std::vector<Item> items_;
  std::size_t size_ = 0;  // number of factors and terms
  Flat whole_;            // declared after the members that its initialiser fills
};

}  // namespace eomgen::reading
