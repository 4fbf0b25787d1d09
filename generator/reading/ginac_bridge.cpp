// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/ginac_bridge.hpp"

#include <set>

#include "reading/trig.hpp"

namespace eomgen::reading {

using GiNaC::ex;
using symbolic::Node;

namespace {
constexpr long most_steps = 2'000'000;
}  // namespace

const GiNaC::symbol& GinacBridge::symbol(const Symbol& meaning) {
  auto found = symbols_.find(meaning);
  if (found == symbols_.end()) {
    // Names are never used: only the table maps a GiNaC symbol to its meaning.
    const ex fresh = atom_table_.atom(meaning)->positive ? ex(GiNaC::possymbol()) : ex(GiNaC::realsymbol());
    found = symbols_.emplace(meaning, fresh).first;
    meaning_.emplace(fresh, meaning);
  }
  return GiNaC::ex_to<GiNaC::symbol>(found->second);
}

ex GinacBridge::from_dag(Ref root) {
  if (const auto found = nodes_.find(root); found != nodes_.end()) return found->second;
  for (const Ref r : dag_.reachable({root})) {
    if (!nodes_.contains(r)) nodes_.emplace(r, node(r));
  }
  return nodes_.at(root);
}

ex GinacBridge::node(Ref r) {
  const Node& n = dag_[r];
  const auto arg = [&](std::size_t i) -> const ex& { return nodes_.at(n.args[i]); };
  switch (n.op) {
    case Op::constant: return GiNaC::numeric(dag_.value(r));
    case Op::pi: return GiNaC::Pi;
    case Op::symbol: return symbol(dag_.symbol_of(r));
    case Op::add: return arg(0) + arg(1);
    case Op::sub: return arg(0) - arg(1);
    case Op::mul: return arg(0) * arg(1);
    case Op::div: return arg(0) / arg(1);
    case Op::neg: return -arg(0);
    case Op::power: return GiNaC::pow(arg(0), static_cast<long>(n.payload));
    default: {
      std::vector<ex> args;
      for (std::size_t i = 0; i < n.arity; ++i) args.push_back(arg(i));
      return ginac_call(n.op, args);
    }
  }
}

ex GinacBridge::term_to_ginac(const Monomial& monomial, const Rational& coefficient) {
  GiNaC::exvector factors{GiNaC::numeric(coefficient)};
  for (const Factor& factor : monomial) {
    const Atom& atom = *factor.atom;
    ex base;
    if (atom.op == Op::symbol)
      base = symbol(atom.symbol);
    else if (atom.op == Op::pi)
      base = GiNaC::Pi;
    else if (atom.op == Op::add)
      base = to_ginac(atom.args[0]);
    else {
      std::vector<ex> args;
      for (const Sum& arg : atom.args) args.push_back(to_ginac(arg));
      base = ginac_call(atom.op, args);
    }
    factors.push_back(is_one(factor.exponent) ? base : ex(GiNaC::pow(base, GiNaC::numeric(factor.exponent))));
  }
  return GiNaC::mul(factors);
}

ex GinacBridge::to_ginac(const Sum& sum) {
  GiNaC::exvector terms;
  for (const auto& [monomial, coefficient] : sum.terms()) terms.push_back(term_to_ginac(monomial, coefficient));
  return GiNaC::add(terms);
}

Sum GinacBridge::from_ginac(const ex& e) {
  steps_ = 0;
  return simplify(convert(e));
}

Sum GinacBridge::convert(const ex& e) {
  if (++steps_ > most_steps) throw TermBudget();
  if (GiNaC::is_a<GiNaC::numeric>(e)) {
    const cln::cl_N value = GiNaC::ex_to<GiNaC::numeric>(e).to_cl_N();
    if (!GiNaC::ex_to<GiNaC::numeric>(e).is_rational()) throw std::domain_error("a number that is not real");
    return Sum(cln::the<cln::cl_RA>(value));
  }
  if (GiNaC::is_a<GiNaC::symbol>(e)) return atom_table_(meaning_.at(e));
  if (GiNaC::is_a<GiNaC::add>(e)) {
    Sum sum;
    for (std::size_t i = 0; i < e.nops(); ++i) sum += convert(e.op(i));
    return sum;
  }
  if (GiNaC::is_a<GiNaC::mul>(e)) {
    Sum product(1);
    for (std::size_t i = 0; i < e.nops(); ++i) product = product * convert(e.op(i));
    return product;
  }
  if (GiNaC::is_a<GiNaC::power>(e)) return convert_power(e);
  if (GiNaC::is_a<GiNaC::constant>(e)) return pi();
  if (GiNaC::is_a<GiNaC::function>(e)) return convert_function(e);
  throw std::logic_error("an expression of an unknown kind");
}

Sum GinacBridge::convert_power(const ex& e) {
  const ex& exponent = e.op(1);
  if (GiNaC::is_a<GiNaC::numeric>(exponent) && GiNaC::ex_to<GiNaC::numeric>(exponent).is_rational()) {
    const Rational r = cln::the<cln::cl_RA>(GiNaC::ex_to<GiNaC::numeric>(exponent).to_cl_N());
    const Sum base = convert(e.op(0));
    const bool expands = is_integer(r) && cln::plusp(r);
    return power(expands ? base : simplify(base), r);
  }
  return call(Op::pow, {simplify(convert(e.op(0))), simplify(convert(exponent))});
}

Sum GinacBridge::convert_function(const ex& e) {
  const auto& f = GiNaC::ex_to<GiNaC::function>(e);
  const Op op = function_of(f);
  std::vector<Sum> args;
  for (std::size_t i = 0; i < e.nops(); ++i) args.push_back(simplify(convert(e.op(i))));
  if (op == Op::symbol) throw std::logic_error("a function of an unknown kind");
  if (op == Op::select && args[2] == args[3]) return args[2];
  return call(op, std::move(args));
}

Sum GinacBridge::derivative(const Sum& sum, const Symbol& by) {
  GiNaC::exvector terms;  // those that contain the symbol: few of many, in the energy of a large system
  for (const auto& [monomial, coefficient] : sum.terms()) {
    bool holds = false;
    for (const Factor& factor : monomial) {
      for_each_atom(factor, [&](const Atom& atom) { holds = holds || (atom.op == Op::symbol && atom.symbol == by); });
    }
    if (holds) terms.push_back(term_to_ginac(monomial, coefficient));
  }
  return from_ginac(ex(GiNaC::add(terms)).diff(symbol(by)));
}

Sum GinacBridge::total_derivative(const Sum& sum) {
  std::map<Symbol, GiNaC::exvector> slopes;  // of the terms that contain the symbol
  std::set<Symbol> held;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    held.clear();
    for (const Factor& factor : monomial) {
      for_each_atom(factor, [&](const Atom& atom) {
        if (atom.op == Op::symbol) held.insert(atom.symbol);
      });
    }
    const ex term = term_to_ginac(monomial, coefficient);
    for (const Symbol& s : held) {
      const bool moves = s.kind == SymbolKind::time || s.kind == SymbolKind::function ||
                         s.kind == SymbolKind::coordinate || s.kind == SymbolKind::integral ||
                         s.kind == SymbolKind::state;
      if (moves) slopes[s].push_back(term.diff(symbol(s)));
    }
  }
  ex result = 0;
  for (const auto& [s, terms] : slopes) {
    const ex slope = GiNaC::add(terms);
    if (s.kind == SymbolKind::time) {
      result += slope;
    } else if (s.kind == SymbolKind::integral || s.kind == SymbolKind::state) {
      result += slope * from_dag(dag_.rates().at(s));
    } else {
      result += slope * symbol({s.kind, s.index, static_cast<std::uint8_t>(s.order + 1)});
    }
  }
  return from_ginac(result);
}

Sum GinacBridge::explicit_derivative(const Sum& sum) {
  std::map<Symbol, Sum> rates;
  const ex e = to_ginac(sum);
  ex result = 0;
  for_each_atom(sum, [&](const Atom& atom) {
    if (atom.op == Op::symbol) rates.emplace(atom.symbol, Sum());
  });
  for (const auto& [s, unused] : rates) {
    if (s.kind == SymbolKind::time) result += e.diff(symbol(s));
    if (s.kind == SymbolKind::integral) result += e.diff(symbol(s)) * from_dag(dag_.rates().at(s));
    if (s.kind != SymbolKind::function) continue;
    result += e.diff(symbol(s)) * symbol({s.kind, s.index, static_cast<std::uint8_t>(s.order + 1)});
  }
  return from_ginac(result);
}

Sum GinacBridge::substitute(const Sum& sum, const std::map<Symbol, Sum>& values) {
  bool present = false;
  for_each_atom(
      sum, [&](const Atom& atom) { present = present || (atom.op == Op::symbol && values.contains(atom.symbol)); });
  if (!present) return sum;
  GiNaC::exmap map;
  for (const auto& [s, value] : values) map[symbol(s)] = to_ginac(value);
  return from_ginac(to_ginac(sum).subs(map, GiNaC::subs_options::no_pattern));
}

}  // namespace eomgen::reading
