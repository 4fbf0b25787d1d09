// SPDX-License-Identifier: GPL-3.0-or-later
// The arena: hash-consing, leaves, traversal. The rewriting rules are in dag_rules.cpp.
#include "symbolic/dag.hpp"

#include <cln/integer_io.h>
#include <cln/rational_io.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace eomgen::symbolic {

std::size_t Dag::Hash::operator()(const Node& node) const noexcept {
  // FNV-1a over the fields. The value selects a bucket only; it never determines an order.
  std::uint64_t hash = 1469598103934665603ull;
  const auto mix = [&hash](std::uint64_t value) { hash = (hash ^ value) * 1099511628211ull; };
  mix(static_cast<std::uint64_t>(node.op));
  mix(static_cast<std::uint32_t>(node.payload));
  for (std::uint8_t i = 0; i < node.arity; ++i) mix(node.args[i].id);
  return static_cast<std::size_t>(hash ^ (hash >> 29));
}

Dag::Dag() {
  zero_ = constant(Rational(0));
  one_ = constant(Rational(1));
}

Ref Dag::intern(const Node& node) {
  if (const auto found = index_.find(node); found != index_.end()) return Ref{found->second};
  if (nodes_.size() >= std::numeric_limits<std::uint32_t>::max()) throw std::length_error("expression arena is full");
  const auto id = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(node);
  index_.emplace(node, id);
  return Ref{id};
}

Ref Dag::constant(const Rational& value) {
  std::ostringstream text;
  text << value;
  auto [found, inserted] = constant_index_.try_emplace(text.str(), static_cast<std::uint32_t>(constants_.size()));
  if (inserted) constants_.push_back(value);
  Node node;
  node.op = Op::constant;
  node.payload = static_cast<std::int32_t>(found->second);
  return intern(node);
}

Ref Dag::pi() {
  Node node;
  node.op = Op::pi;
  return intern(node);
}

Ref Dag::symbol(Symbol symbol) {
  const auto before = [](const auto& entry, const Symbol& s) { return entry.first < s; };
  auto found = std::lower_bound(symbol_index_.begin(), symbol_index_.end(), symbol, before);
  if (found == symbol_index_.end() || found->first != symbol) {
    found = symbol_index_.insert(found, {symbol, static_cast<std::uint32_t>(symbols_.size())});
    symbols_.push_back(symbol);
  }
  Node node;
  node.op = Op::symbol;
  node.payload = static_cast<std::int32_t>(found->second);
  return intern(node);
}

void Dag::assume_positive(Symbol symbol) { positive_.insert(symbol); }

bool Dag::is_positive(Ref r) const {
  const Node& node = nodes_[r.id];
  switch (node.op) {
    case Op::constant: return cln::plusp(value(r));
    case Op::pi:
    case Op::exp:
    case Op::cosh: return true;
    case Op::symbol: return positive_.contains(symbol_of(r));
    case Op::sqrt:
    case Op::power: return is_positive(node.args[0]);
    // One level suffices for lengths and radii, and keeps the cost constant.
    case Op::add:
    case Op::mul:
    case Op::div: {
      const auto leaf = [this](Ref x) { return nodes_[x.id].arity == 0 && is_positive(x); };
      return leaf(node.args[0]) && leaf(node.args[1]);
    }
    default: return false;
  }
}

std::vector<Ref> Dag::reachable(const std::vector<Ref>& roots) const {
  std::vector<bool> seen(nodes_.size(), false);
  std::vector<Ref> stack = roots, result;
  while (!stack.empty()) {
    const Ref r = stack.back();
    stack.pop_back();
    if (seen[r.id]) continue;
    seen[r.id] = true;
    result.push_back(r);
    for (std::uint8_t i = 0; i < nodes_[r.id].arity; ++i) stack.push_back(nodes_[r.id].args[i]);
  }
  std::sort(result.begin(), result.end());
  return result;
}

bool Dag::has_kinks(const std::vector<Ref>& roots) const {
  const std::vector<Ref> nodes = reachable(roots);
  return std::any_of(nodes.begin(), nodes.end(), [this](Ref r) { return is_kink(nodes_[r.id].op); });
}

std::vector<Symbol> Dag::symbols(const std::vector<Ref>& roots) const {
  std::vector<Symbol> result;
  for (const Ref r : reachable(roots)) {
    if (nodes_[r.id].op == Op::symbol) result.push_back(symbol_of(r));
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace eomgen::symbolic
