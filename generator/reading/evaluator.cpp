// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/evaluator.hpp"

#include <cln/integer.h>

#include <cmath>

#include "symbolic/arithmetic.hpp"
#include "work.hpp"

namespace eomgen::reading {
namespace {

constexpr std::size_t factors_a_unit = 8;  // of `work::consume_budget`

double evaluated_power(double base, int exponent) {
  double result = 1;
  for (int k = std::abs(exponent); k > 0; k /= 2, base *= base) {
    if (k % 2 != 0) result *= base;
  }
  return exponent < 0 ? 1 / result : result;
}

}  // namespace

double Evaluator::operator()(const std::vector<double>& at) {
  work::consume_budget(size_ / factors_a_unit + 1);
  for (Item& item : items_) item.value = item.op == Op::symbol ? at[item.symbol] : function(item);
  return value(whole_);
}

Evaluator::Flat Evaluator::flat(const Sum& sum) {
  constexpr int largest_whole = 64;
  Flat result;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    Term term{cln::double_approx(coefficient), {}};
    for (const Factor& factor : monomial) {
      const bool whole = is_integer(factor.exponent) && cln::abs(factor.exponent) <= largest_whole;
      term.powers.push_back({place(*factor.atom), whole ? cln::cl_I_to_int(cln::numerator(factor.exponent)) : 0,
                             whole ? 0 : cln::double_approx(factor.exponent)});
    }
    size_ += 1 + term.powers.size();
    result.push_back(std::move(term));
  }
  return result;
}

std::size_t Evaluator::place(const Atom& atom) {
  if (const auto known = places_.find(&atom); known != places_.end()) return known->second;
  Item item{atom.op, 0, {}, 0};
  if (atom.op == Op::symbol) {
    const auto same = symbols_.find(atom.symbol);
    item.symbol = same != symbols_.end() ? same->second : symbols_.size();
    symbols_.emplace(atom.symbol, item.symbol);
  }
  for (const Sum& argument : atom.args) item.args.push_back(flat(argument));
  items_.push_back(std::move(item));
  return places_[&atom] = items_.size() - 1;
}

double Evaluator::value(const Flat& sum) const {
  double result = 0;
  for (const Term& term : sum) {
    double product = term.coefficient;
    for (const Power& p : term.powers)
      product *=
          p.whole != 0 ? evaluated_power(items_[p.item].value, p.whole) : std::pow(items_[p.item].value, p.exponent);
    result += product;
  }
  return result;
}

double Evaluator::function(const Item& item) const {
  const auto arg = [&](std::size_t i) { return value(item.args[i]); };
  switch (item.op) {
    case Op::pi: return symbolic::Binary64Arithmetic::pi();
    case Op::add: return arg(0);  // a sum under a power
    default: return symbolic::value_of(item.op, 0, arg, symbolic::Binary64Arithmetic{});
  }
}

}  // namespace eomgen::reading
