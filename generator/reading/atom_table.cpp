// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/atom_table.hpp"

#include <cln/integer.h>

namespace eomgen::reading {
namespace {

using symbolic::Dag;

void apply_range(const model::Model& model, const model::Coordinate& coordinate, Atom& atom) {
  if (coordinate.lower == model::no_node) return;
  const model::Node& lower = model.arena[coordinate.lower];
  if (lower.op != model::Op::number || cln::minusp(lower.value)) return;
  atom.positive = true;  // the range is open
  if (coordinate.upper == model::no_node) return;
  atom.is_half_turn_angle = model.arena[coordinate.upper].op == model::Op::pi;
}

Ref factor_to_dag(Dag& dag, const Factor& factor, const Rational& exponent) {
  const Atom& atom = *factor.atom;
  Ref base;
  switch (atom.op) {
    case Op::symbol: base = dag.symbol(atom.symbol); break;
    case Op::pi: base = dag.pi(); break;
    case Op::add: base = to_dag(dag, atom.args[0]); break;
    case Op::pow: base = dag.pow(to_dag(dag, atom.args[0]), to_dag(dag, atom.args[1])); break;
    case Op::select:
      base = dag.select(to_dag(dag, atom.args[0]), to_dag(dag, atom.args[1]), to_dag(dag, atom.args[2]),
                        to_dag(dag, atom.args[3]));
      break;
    default:
      base = atom.args.size() == 2 ? dag.call(atom.op, to_dag(dag, atom.args[0]), to_dag(dag, atom.args[1]))
                                   : dag.call(atom.op, to_dag(dag, atom.args[0]));
  }
  if (is_integer(exponent)) return dag.power(base, to_long(exponent));
  return dag.pow(base, dag.constant(exponent));
}

}  // namespace

const AtomPtr& AtomTable::atom(const Symbol& symbol) {
  const auto found = atoms_.find(symbol);
  if (found != atoms_.end()) return found->second;
  Atom atom;
  atom.symbol = symbol;
  if (symbol.kind == SymbolKind::parameter) atom.positive = model_->parameters[symbol.index].positive;
  if (symbol.kind == SymbolKind::coordinate && symbol.order == 0) {
    apply_range(*model_, model_->coordinates[symbol.index], atom);
  }
  return atoms_.emplace(symbol, std::make_shared<const Atom>(std::move(atom))).first->second;
}

Sum pi() {
  Atom atom;
  atom.op = Op::pi;
  atom.positive = true;
  return Sum(std::make_shared<const Atom>(std::move(atom)));
}

Ref to_dag(Dag& dag, const Sum& sum) {
  Ref result = dag.zero();
  for (const auto& [monomial, coefficient] : sum.terms()) {
    Ref above = dag.one(), below = dag.one();
    for (const Factor& factor : monomial) {
      const bool under = cln::minusp(factor.exponent);
      Ref& side = under ? below : above;
      side = dag.mul(side, factor_to_dag(dag, factor, under ? -factor.exponent : factor.exponent));
    }
    result = dag.add(result, dag.mul(dag.constant(coefficient), dag.div(above, below)));
  }
  return result;
}

}  // namespace eomgen::reading
