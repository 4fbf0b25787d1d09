// SPDX-License-Identifier: GPL-3.0-or-later
// Generates straight-line code from the graph, and counts its operations. A test compares code and count.
#include <cln/rational.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "program/polynomials.hpp"
#include "symbolic/small_numbers.hpp"

namespace eomgen::program {
namespace {

// x^1, x^2, x^3 are written as products; higher powers square x^(n/2).
constexpr std::int32_t written_out = 3;

// A pack of two angles takes half the time of the C library; a pack of one takes the same time.
constexpr std::size_t smallest_pack = 2;

std::size_t power_factors(std::int32_t e) { return static_cast<std::size_t>(e <= written_out ? e : 2 + e % 2); }
std::size_t power_cost(std::int32_t e) {  // multiplications of the half power, which need an instruction
  return e <= written_out ? 0 : power_factors(e / 2) - 1 + power_cost(e / 2);
}

void count_term(const Term& term, const std::vector<std::uint32_t>& divides, Operations& operations) {
  std::size_t above = symbolic::is_unit(term.coefficient) ? 0 : 1, below = 0;
  for (const Factor& f : term.factors) {
    const std::int32_t e = std::abs(f.exponent);
    operations.mul += power_cost(e);
    (f.exponent > 0 || divides[f.node] > 1 ? above : below) += power_factors(e);
  }
  operations.mul += above > 1 ? above - 1 : 0;
  operations.mul += below > 1 ? below - 1 : 0;
  operations.div += below > 0 ? 1 : 0;
}

}  // namespace

Operations count_operations(const PolynomialGraph& graph) {
  Operations operations;
  const std::vector<NodeId> order = graph.topological_order();
  const std::vector<std::uint32_t> divides = graph.divisor_use_counts(order);
  for (const NodeId id : order) {
    const Node& node = graph[id];
    if (divides[id] > 1) ++operations.div;
    if (node.kind == Node::Kind::call) operations.count(node.op, 1);
    if (node.kind != Node::Kind::sum) continue;
    operations.add += node.terms.size() - 1;
    for (const Term& term : node.terms) count_term(term, divides, operations);
  }
  return operations;
}

namespace {

class Schedule {
 public:
  Schedule(const PolynomialGraph& graph, std::string name)
      : graph_(graph), value_(graph.size()), reciprocal_(graph.size()), has_reciprocal_(graph.size(), false) {
    function_.name = std::move(name);
  }

  Function run(const std::vector<ResultShape>& shape) {
    prepare();
    DepthFirstTraversal traversal(graph_);
    const auto take = [this](NodeId id) { emit(id); };
    section_ = "sines and cosines";
    for (const std::vector<NodeId>& level : trig_levels()) emit_together(level, traversal);
    section_.clear();
    for (const Label& label : graph_.labels) {
      if (!needed_[label.value.factors[0].node]) continue;
      section_ = label.section;
      traversal.visit(label.value, take);
    }
    section_ = "values";
    traversal.visit_results(take);
    finish(shape);
    return std::move(function_);
  }

 private:
  void prepare() {
    const std::vector<NodeId> order = graph_.topological_order();
    divides_ = graph_.divisor_use_counts(order);
    needed_.assign(graph_.size(), false);
    flipped_.assign(graph_.size(), false);
    for (const NodeId id : order) needed_[id] = true;
    for (const Label& label : graph_.labels) {
      const NodeId id = label.value.factors[0].node;
      if (!needed_[id] || name_.contains(id)) continue;
      const Node& node = graph_[id];
      const bool negative = cln::minusp(label.value.coefficient);
      if (node.kind != Node::Kind::sum) continue;
      // The named value is the negative of the node. The node is negated if that costs nothing.
      flipped_[id] = negative && std::any_of(node.terms.begin(), node.terms.end(),
                                             [](const Term& term) { return cln::minusp(term.coefficient); });
      name_[id] = negative && !flipped_[id] ? "minus_" + label.name : label.name;
    }
  }

  /// Groups sines and cosines by the depth of other trigonometric values in their angles. The sine and the cosine of
  /// one angle are adjacent.
  std::vector<std::vector<NodeId>> trig_levels() const {
    std::vector<std::size_t> depth(graph_.size(), 0);
    std::vector<bool> taken(graph_.size(), false);
    std::vector<std::vector<NodeId>> levels;
    for (const NodeId id : graph_.topological_order()) {
      for (const Term& term : graph_[id].terms) {
        for (const Factor& f : term.factors) depth[id] = std::max(depth[id], depth[f.node]);
      }
      if (!graph_.is_trig(id)) continue;
      const std::size_t level = depth[id]++;
      if (levels.size() <= level) levels.resize(level + 1);
      NodeId other = 0;
      for (const NodeId next : {id, graph_.find_trig_partner(id, other) && needed_[other] ? other : id}) {
        if (!taken[next]) levels[level].push_back(next);
        taken[next] = true;
      }
    }
    return levels;
  }

  void emit_together(const std::vector<NodeId>& trig, DepthFirstTraversal& traversal) {
    const auto take = [this](NodeId id) { emit(id); };
    std::vector<std::pair<Operand, NodeId>> angles;
    for (const NodeId id : trig) {
      const Term& angle = graph_[id].terms[0];
      traversal.visit(angle, take);
      angles.emplace_back(angle.is_constant() ? constant(angle.coefficient) : term(angle, ""), id);
    }
    const auto angle_of = [](const auto& pair) {
      return std::tuple(pair.first.slot, pair.first.index, pair.first.negated);
    };
    std::stable_sort(angles.begin(), angles.end(), [&](const auto& a, const auto& b) {
      return std::tuple(angle_of(a), graph_[a.second].op) < std::tuple(angle_of(b), graph_[b.second].op);
    });
    std::vector<std::uint32_t> lanes;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const bool same = i > 0 && angles[i].first == angles[i - 1].first;
      lanes.push_back(i == 0 ? 0 : lanes.back() + (same ? 0 : 1));
    }
    const bool pack = lanes.back() + 1 >= smallest_pack;
    packs_ += pack ? 1 : 0;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const Operand& angle = angles[i].first;
      traversal.visit(angles[i].second,
                      [&](NodeId id) { value_[id] = add_instruction(graph_[id].op, {angle}, name_of(id)); });
      if (!pack) continue;
      function_.code.back().pack = packs_;
      function_.code.back().lane = lanes[i];
    }
  }

  std::string name_of(NodeId id) const {
    const auto named = name_.find(id);
    return named == name_.end() ? "" : named->second;
  }

  Operand constant(const Rational& value) {
    const Rational size = cln::abs(value);
    auto found = std::find(function_.constants.begin(), function_.constants.end(), size);
    if (found == function_.constants.end()) found = function_.constants.insert(found, size);
    const auto index = static_cast<std::uint32_t>(found - function_.constants.begin());
    return {Slot::constant, index, cln::minusp(value)};
  }

  Operand add_instruction(Op op, std::vector<Operand> operands, const std::string& name = "") {
    Instruction instruction;
    instruction.op = op;
    instruction.operands = std::move(operands);
    instruction.name = name;
    if (section_ != last_section_) instruction.section = last_section_ = section_;
    for (const Operand& operand : instruction.operands) {
      function_.uses_input = function_.uses_input || operand.slot == Slot::input;
    }
    function_.operations.count(instruction.op, instruction.operands.size());
    function_.code.push_back(std::move(instruction));
    return {Slot::value, static_cast<std::uint32_t>(function_.code.size() - 1), false};
  }

  Operand product(std::vector<Operand> factors, const std::string& name = "") {
    if (factors.size() == 1) return factors[0];
    return add_instruction(Op::mul, std::move(factors), name);
  }

  void push_power(const Operand& base, std::int32_t e, std::vector<Operand>& factors) {
    if (e <= written_out) {
      factors.insert(factors.end(), static_cast<std::size_t>(e), base);
      return;
    }
    std::vector<Operand> half_factors;
    push_power(base, e / 2, half_factors);
    const Operand half = product(std::move(half_factors));
    factors.insert(factors.end(), 2, half);
    if (e % 2 == 1) factors.push_back(base);
  }

  Operand reciprocal(NodeId id) {
    if (!has_reciprocal_[id]) {
      has_reciprocal_[id] = true;
      const std::string name = name_of(id);
      reciprocal_[id] = add_instruction(Op::div, {constant(1), value_[id]}, name.empty() ? "" : "inverse_" + name);
    }
    return reciprocal_[id];
  }

  /// The magnitude of a term as an operand; `negated` is its sign.
  Operand term(const Term& term, const std::string& name) {
    std::vector<Operand> above, below;
    if (!symbolic::is_unit(term.coefficient)) above.push_back(constant(cln::abs(term.coefficient)));
    bool negated = cln::minusp(term.coefficient);
    for (const Factor& f : term.factors) {
      const bool multiply_by_reciprocal = f.exponent < 0 && divides_[f.node] > 1;
      Operand base = multiply_by_reciprocal ? reciprocal(f.node) : value_[f.node];
      negated = negated != (base.negated && f.exponent % 2 != 0);
      base.negated = false;
      push_power(base, std::abs(f.exponent), f.exponent > 0 || multiply_by_reciprocal ? above : below);
    }
    if (above.empty()) above.push_back(constant(1));
    Operand result = product(std::move(above), below.empty() ? name : "");
    if (!below.empty()) result = add_instruction(Op::div, {result, product(std::move(below))}, name);
    result.negated = result.negated != negated;
    return result;
  }

  void emit(NodeId id) {
    const Node& node = graph_[id];
    const std::string name = name_of(id);
    if (node.kind == Node::Kind::leaf) {
      value_[id] = node.leaf;
      function_.uses_input = function_.uses_input || node.leaf.slot == Slot::input;
    } else if (node.kind == Node::Kind::call) {
      std::vector<Operand> arguments;
      for (const Term& argument : node.terms) {
        arguments.push_back(argument.is_constant() ? constant(argument.coefficient) : term(argument, ""));
      }
      value_[id] = add_instruction(node.op, std::move(arguments), name);
    } else if (node.terms.size() == 1) {
      value_[id] = term(node.terms[0], name);
    } else {
      std::vector<Operand> summands;
      for (const Term& summand : node.terms) {
        Operand operand = term(summand, "");
        operand.negated = operand.negated != flipped_[id];
        summands.push_back(operand);
      }
      std::stable_partition(summands.begin(), summands.end(), [](const Operand& o) { return !o.negated; });
      value_[id] = add_instruction(Op::add, std::move(summands), name);
      value_[id].negated = flipped_[id];
    }
  }

  Operand operand(const Term& term) {
    if (term.is_constant()) return constant(term.coefficient);
    Operand result = value_[term.factors[0].node];
    result.negated = result.negated != cln::minusp(term.coefficient);
    return result;
  }

  void finish(const std::vector<ResultShape>& shape) {
    std::size_t next = 0;
    for (const ResultShape& result : shape) {
      std::vector<Operand> values;
      for (std::size_t i = 0; i < result.entries; ++i) values.push_back(operand(graph_.results[next++]));
      function_.results.push_back({result.name, std::move(values), result.code});
    }
    test_pivots();
  }

  void test_pivots() {
    const std::vector<bool> divides = graph_.divisors(graph_.topological_order());
    std::vector<bool> tested(graph_.size(), false);
    for (const PivotPair& pair : graph_.pivots) {
      if (!pair.scale.is_constant() || pair.scale.coefficient != 0) {
        function_.pivots.push_back({operand(pair.pivot), operand(pair.scale)});
        continue;
      }
      // A divisor is tested only if the finished program still divides by it.
      for (const NodeId id : graph_.atoms(pair.pivot)) {
        if (divides[id] && !tested[id]) function_.pivots.push_back({value_[id], constant(0)});
        tested[id] = true;
      }
    }
  }

  const PolynomialGraph& graph_;
  Function function_;
  std::vector<Operand> value_, reciprocal_;
  std::vector<bool> has_reciprocal_, needed_, flipped_;
  std::vector<std::uint32_t> divides_;
  std::map<NodeId, std::string> name_;
  std::string section_, last_section_;
  std::uint32_t packs_ = 0;
};

}  // namespace

Function schedule(const PolynomialGraph& graph, const std::string& name, const std::vector<ResultShape>& shape) {
  return Schedule(graph, name).run(shape);
}

}  // namespace eomgen::program
