// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/expression_tables.hpp"

#include <algorithm>

#include "symbolic/arithmetic.hpp"

namespace eomgen::run {
namespace {

using eom::expressions::Op;
using symbolic::Dag;
using symbolic::Node;

class Writer {
 public:
  Writer(const Dag& dag, const SymbolResolver& lookup) : dag_(dag), lookup_(lookup), place_(dag.size(), unseen) {}

  std::optional<Table> write(const std::vector<Ref>& roots) {
    add(roots);
    for (const Ref root : roots) table_.roots.push_back(place_[root.id]);
    if (!complete_) return std::nullopt;
    return std::move(table_);
  }

 private:
  static constexpr std::int32_t unseen = -1;

  void add(const std::vector<Ref>& roots) {
    for (const Ref r : dag_.reachable(roots)) {
      if (place_[r.id] != unseen) continue;
      const Node& node = dag_[r];
      if (node.op == symbolic::Op::symbol)
        add_symbol(r);
      else if (node.op == symbolic::Op::pi)
        put(r, Op::number, number(symbolic::Binary64Arithmetic::pi()));
      else if (node.op == symbolic::Op::constant)
        put(r, Op::number, number(cln::double_approx(dag_.value(r))));
      else
        add_operation(r, node);
    }
  }

  void add_operation(Ref r, const Node& node) {
    eom::expressions::Step step{symbolic::runtime_op(node.op), {}};
    for (std::size_t k = 0; k < node.arity; ++k) step.a[k] = place_[node.args[k].id];
    if (node.op == symbolic::Op::power) step.a[1] = node.payload;
    place_[r.id] = static_cast<std::int32_t>(table_.steps.size());
    table_.steps.push_back(step);
  }

  void add_symbol(Ref r) {
    const SymbolMeaning leaf = lookup_(dag_.symbol_of(r));
    switch (leaf.kind) {
      case SymbolMeaning::Kind::expression:
        add({leaf.expression});
        place_[r.id] = place_[leaf.expression.id];
        return;
      case SymbolMeaning::Kind::parameter: put(r, Op::parameter, static_cast<std::int32_t>(leaf.index)); return;
      case SymbolMeaning::Kind::variable: put(r, Op::variable, static_cast<std::int32_t>(leaf.index)); return;
      case SymbolMeaning::Kind::number: put(r, Op::number, number(leaf.number)); return;
      case SymbolMeaning::Kind::unknown: break;
    }
    complete_ = false;
    put(r, Op::number, number(0));
  }

  void put(Ref r, Op op, std::int32_t index) {
    place_[r.id] = static_cast<std::int32_t>(table_.steps.size());
    table_.steps.push_back({op, {index}});
  }
  std::int32_t number(double value) {
    table_.numbers.push_back(value);
    return static_cast<std::int32_t>(table_.numbers.size()) - 1;
  }

  const Dag& dag_;
  const SymbolResolver& lookup_;
  std::vector<std::int32_t> place_;  // in the table, of each node of the Dag
  Table table_;
  bool complete_ = true;
};

}  // namespace

std::optional<Table> make_table(const Dag& dag, const std::vector<Ref>& roots, const SymbolResolver& lookup) {
  return Writer(dag, lookup).write(roots);
}

SymbolResolver run_variables(const system::EquationSystem& s) {
  return [&s](const Symbol& symbol) {
    const std::size_t n = s.free.size();
    switch (symbol.kind) {
      case SymbolKind::time: return SymbolMeaning::of_variable(0);
      case SymbolKind::parameter: return SymbolMeaning::of_parameter(symbol.index);
      case SymbolKind::input: return SymbolMeaning::of_variable(1 + s.layout().size() + symbol.index);
      case SymbolKind::branch: return SymbolMeaning::of(0);
      case SymbolKind::coordinate: {
        const auto place = std::find(s.free.begin(), s.free.end(), symbol.index);
        if (symbol.order > 1 || place == s.free.end()) return SymbolMeaning{};
        return SymbolMeaning::of_variable(1 + symbol.order * n + static_cast<std::size_t>(place - s.free.begin()));
      }
      case SymbolKind::integral:
      case SymbolKind::state:
        for (std::size_t i = 0; i < s.states.size(); ++i) {
          if (s.states[i].symbol == symbol) return SymbolMeaning::of_variable(1 + s.layout().first_order_begin() + i);
        }
        return SymbolMeaning{};
      default: return SymbolMeaning{};
    }
  };
}

}  // namespace eomgen::run
