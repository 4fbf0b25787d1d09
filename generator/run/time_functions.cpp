// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/time_functions.hpp"

#include <algorithm>
#include <set>

#include "run/expression_tables.hpp"
#include "system/expressions.hpp"

namespace eomgen::run {
namespace {

using symbolic::Dag;
using symbolic::Node;

/// The dependence of each node: 0: on parameters and tables, 1: also on t, 2: on more.
class Dependence {
 public:
  Dependence(const Dag& dag, const std::vector<std::optional<Ref>>& inputs)
      : dag_(dag), inputs_(inputs), of_(dag.size(), unvisited) {}

  void visit(const std::vector<Ref>& roots) {
    for (const Ref r : dag_.reachable(roots)) {
      if (of_[r.id] != unvisited) continue;
      visited_.push_back(r);
      const Node& node = dag_[r];
      if (node.op == symbolic::Op::symbol) {
        of_[r.id] = of_symbol(dag_.symbol_of(r));
        continue;
      }
      of_[r.id] = 0;
      for (std::size_t k = 0; k < node.arity; ++k) of_[r.id] = std::max(of_[r.id], of_[node.args[k].id]);
    }
  }
  int operator()(Ref r) const { return of_[r.id]; }
  /// All visited nodes, operands before their users.
  const std::vector<Ref>& visited() const { return visited_; }

 private:
  static constexpr signed char unvisited = -1;

  signed char of_symbol(const Symbol& s) const {
    if (s.kind == SymbolKind::time) return 1;
    if (s.kind == SymbolKind::parameter) return 0;
    if (s.kind != SymbolKind::input) return 2;
    return inputs_[s.index] ? of_[inputs_[s.index]->id] : static_cast<signed char>(0);
  }

  const Dag& dag_;
  const std::vector<std::optional<Ref>>& inputs_;
  std::vector<signed char> of_;
  std::vector<Ref> visited_;
};

class Finder {
 public:
  Finder(const system::EquationSystem& system, const std::vector<std::optional<Ref>>& inputs)
      : system_(system), dag_(*system.dag), inputs_(inputs), depends_(dag_, inputs) {}

  eom::hybrid::TimeFunctions find() {
    std::vector<Ref> roots;
    for (const std::optional<Ref>& input : inputs_) {
      if (input) roots.push_back(*input);
    }
    depends_.visit(roots);
    roots.clear();
    system::for_each_expression(system_, [&](Ref r, system::ExpressionRole part) {
      if (part != system::ExpressionRole::output && part != system::ExpressionRole::reset) roots.push_back(r);
    });
    const std::size_t moving = roots.size();
    for (const Ref r : {system_.kinetic, system_.potential}) roots.push_back(r);
    for (const system::Output& output : system_.outputs) {  // outputs that may jump
      if (output.kind == system::OutputKind::position || output.kind == system::OutputKind::velocity)
        roots.push_back(output.value);
    }
    depends_.visit(roots);
    for (const Ref r : depends_.visited()) {
      if (symbolic::is_kink(dag_[r].op)) add_surface(r);
    }
    roots.resize(moving);
    add_terms(roots);
    return std::move(found_);
  }

 private:
  void add(const std::vector<Ref>& roots, std::vector<Table>& tables) {
    std::optional<Table> table = make_table(dag_, roots, [&](const Symbol& s) {
      if (s.kind == SymbolKind::time) return SymbolMeaning::of_variable(0);
      if (s.kind == SymbolKind::parameter) return SymbolMeaning::of_parameter(s.index);
      if (s.kind != SymbolKind::input) return SymbolMeaning{};
      return inputs_[s.index] ? SymbolMeaning::of_expression(*inputs_[s.index])
                              : SymbolMeaning::of_variable(1 + s.index);
    });
    if (table) tables.push_back(std::move(*table));
  }

  void add_surface(Ref r) {
    const Node& node = dag_[r];
    const bool one = node.op == symbolic::Op::abs || node.op == symbolic::Op::sign;
    std::vector<Ref> surface{node.args[0]};
    if (!one) surface.push_back(node.args[1]);
    int depends = 0;
    for (const Ref operand : surface) depends = std::max(depends, depends_(operand));
    if (depends != 1 || std::find(surfaces_.begin(), surfaces_.end(), surface) != surfaces_.end()) return;
    surfaces_.push_back(surface);
    add(surface, found_.surfaces);
  }

  /// The largest expressions of time alone that are operands of other expressions, or part of the equations themselves.
  void add_terms(const std::vector<Ref>& roots) {
    std::vector<bool> wanted(dag_.size(), false);
    for (const Ref r : roots) wanted[r.id] = wanted[r.id] || depends_(r) == 1;
    for (const Ref r : dag_.reachable(roots)) {
      if (depends_(r) != 2) continue;
      const Node& node = dag_[r];
      for (std::size_t k = 0; k < node.arity; ++k)
        wanted[node.args[k].id] = wanted[node.args[k].id] || depends_(node.args[k]) == 1;
    }
    std::vector<Ref> functions;
    for (const Ref r : depends_.visited()) {
      if (!wanted[r.id]) continue;
      const bool input = dag_[r].op == symbolic::Op::symbol && dag_.symbol_of(r).kind == SymbolKind::input;
      functions.push_back(input ? *inputs_[dag_.symbol_of(r).index] : r);
    }
    for (const Ref f : functions) {
      for (const Ref term : terms(f)) add({term}, found_.terms);
    }
  }

  /// Sums are examined term by term: bounds of a sum are worse than those of its terms (sin^2 + cos^2), and a pulse
  /// next to a large constant has to be found.
  std::vector<Ref> terms(Ref sum) {
    std::vector<Ref> open{sum}, result;
    while (!open.empty()) {
      const Ref r = open.back();
      open.pop_back();
      if (depends_(r) != 1 || !seen_terms_.insert(r.id).second) continue;
      const Node& node = dag_[r];
      using symbolic::Op;
      if (node.op == Op::symbol && dag_.symbol_of(r).kind == SymbolKind::input) {
        open.push_back(*inputs_[dag_.symbol_of(r).index]);
        continue;
      }
      const bool scaled = (node.op == Op::mul && (depends_(node.args[0]) == 0 || depends_(node.args[1]) == 0)) ||
                          (node.op == Op::div && depends_(node.args[1]) == 0);
      if (node.op != Op::add && node.op != Op::sub && node.op != Op::neg && !scaled) {
        result.push_back(r);
        continue;
      }
      for (std::size_t k = 0; k < node.arity; ++k) open.push_back(node.args[k]);
    }
    return result;
  }

  const system::EquationSystem& system_;
  const Dag& dag_;
  const std::vector<std::optional<Ref>>& inputs_;
  Dependence depends_;
  std::vector<std::vector<Ref>> surfaces_;
  std::set<std::uint32_t> seen_terms_;
  eom::hybrid::TimeFunctions found_;
};

}  // namespace

eom::hybrid::TimeFunctions time_functions(const system::EquationSystem& system,
                                          const std::vector<std::optional<Ref>>& inputs) {
  return Finder(system, inputs).find();
}

}  // namespace eomgen::run
