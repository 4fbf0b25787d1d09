// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/evaluate.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "symbolic/arithmetic.hpp"
#include "work.hpp"

namespace eomgen::symbolic {
namespace {

using cln::cl_R;

/// Values of some nodes, ascending by id. Storage is for these nodes only, as they may be few among many.
template <class Real>
class Values {
 public:
  Values(const std::vector<Ref>& nodes, std::size_t all)
      : nodes_(nodes), few_(nodes.size() < all / 16), values_(few_ ? nodes.size() : all) {}
  Real& operator[](std::uint32_t id) { return values_[place(id)]; }
  const Real& operator[](std::uint32_t id) const { return values_[place(id)]; }

 private:
  std::size_t place(std::uint32_t id) const {
    return few_ ? static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), Ref{id}) - nodes_.begin())
                : id;
  }
  const std::vector<Ref>& nodes_;
  bool few_;
  std::vector<Real> values_;
};

template <class Real, class Arithmetic, class Lookup>
Real value_at(const Dag& dag, Ref r, const Values<Real>& value, const Lookup& lookup, const Arithmetic& number) {
  const Node& node = dag[r];
  switch (node.op) {
    case Op::constant: return number.constant(dag.value(r));
    case Op::pi: return number.pi();
    case Op::symbol: return lookup(dag.symbol_of(r));
    default: break;
  }
  const auto arg = [&](std::size_t i) -> const Real& { return value[node.args[i].id]; };
  return value_of(node.op, node.payload, arg, number);
}

template <class Real, class Arithmetic, class Lookup>
std::vector<Real> run(const Dag& dag, const std::vector<Ref>& roots, const Lookup& lookup, const Arithmetic& number) {
  const std::vector<Ref> nodes = dag.reachable(roots);
  Values<Real> value(nodes, dag.size());
  std::map<std::uint32_t, std::string> missing;  // undefined nodes with the reason; allowed in a branch not taken
  // The reason why an operand of the node is undefined, or null.
  const auto gap = [&](Ref r) -> const std::string* {
    if (missing.empty()) return nullptr;
    const Node& node = dag[r];
    const auto in = [&](std::size_t i) -> const std::string* {
      const auto found = missing.find(node.args[i].id);
      return found == missing.end() ? nullptr : &found->second;
    };
    const std::size_t operands = node.op == Op::select ? 2 : node.arity;
    for (std::size_t i = 0; i < operands; ++i) {
      if (const std::string* why = in(i)) return why;
    }
    if (node.op != Op::select) return nullptr;
    return in(number.less(value[node.args[0].id], value[node.args[1].id]) ? 2 : 3);
  };
  for (const Ref r : nodes) {
    if (const std::string* why = gap(r)) {
      missing.emplace(r.id, *why);
      continue;
    }
    try {
      value[r.id] = value_at(dag, r, value, lookup, number);
    } catch (const std::domain_error& outside) {
      missing.emplace(r.id, outside.what());
    }
  }
  std::vector<Real> results;
  for (const Ref root : roots) {
    if (const auto found = missing.find(root.id); found != missing.end()) throw std::domain_error(found->second);
    results.push_back(value[root.id]);
  }
  return results;
}

}  // namespace

std::vector<cl_R> evaluate(const Dag& dag, const std::vector<Ref>& roots,
                           const std::function<cl_R(const Symbol&)>& lookup, int digits) {
  work::throw_if_stopped();
  const ClnArithmetic arithmetic{cln::float_format(static_cast<std::uintptr_t>(digits))};
  const auto rounded = [&](const Symbol& symbol) -> cl_R { return arithmetic.round(lookup(symbol)); };
  return run<cl_R>(dag, roots, rounded, arithmetic);
}

std::vector<double> evaluate(const Dag& dag, const std::vector<Ref>& roots,
                             const std::function<double(const Symbol&)>& lookup) {
  return run<double>(dag, roots, lookup, Binary64Arithmetic{});
}

}  // namespace eomgen::symbolic
