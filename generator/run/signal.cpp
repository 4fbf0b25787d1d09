// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/signal.hpp"

#include <algorithm>
#include <map>

#include "symbolic/arithmetic.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::run {

using symbolic::Op;
using symbolic::SymbolKind;

namespace {
// Leaves of the copied expression: everything but t is a number by now.
constexpr std::int32_t time_leaf = -1;
}  // namespace

Signal::Signal(const symbolic::Dag& dag, symbolic::Ref expression, const std::vector<double>& parameters) {
  std::map<std::uint32_t, std::uint32_t> place;
  const auto value = [&](const symbolic::Symbol& s) {
    return s.kind == SymbolKind::parameter ? parameters[s.index] : 0.0;
  };
  for (const symbolic::Ref r : dag.reachable({expression})) {
    const symbolic::Node& node = dag[r];
    Step step{node.op, node.payload, {}};
    for (std::size_t k = 0; k < node.arity; ++k) step.args[k] = place.at(node.args[k].id);
    const bool is_time = node.op == Op::symbol && dag.symbol_of(r).kind == SymbolKind::time;
    if (is_time) {
      step.op = Op::symbol;
      step.payload = time_leaf;
    } else if (node.arity == 0) {
      step.op = Op::constant;
      step.payload = static_cast<std::int32_t>(constants_.size());
      constants_.push_back(symbolic::evaluate(dag, {r}, value)[0]);
    }
    place[r.id] = static_cast<std::uint32_t>(code_.size());
    code_.push_back(step);
  }
  work_.resize(code_.size());
}

Signal::Signal(std::vector<double> time, std::vector<double> value)
    : time_(std::move(time)), value_(std::move(value)) {}

double Signal::operator()(double t, double side_of) const {
  if (time_.empty()) return code_.empty() ? 0.0 : evaluate(t);
  const auto after = std::upper_bound(time_.begin(), time_.end(), side_of);
  const auto segment = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - time_.begin() - 1));
  return value_[segment];
}

bool Signal::moves() const {
  return time_.empty() &&
         std::any_of(code_.begin(), code_.end(), [](const Step& step) { return step.op == Op::symbol; });
}

double Signal::evaluate(double t) const {
  for (std::size_t i = 0; i < code_.size(); ++i) {
    const Step& step = code_[i];
    const auto arg = [&](std::size_t k) { return work_[step.args[k]]; };
    double& result = work_[i];
    switch (step.op) {
      case Op::constant:
      case Op::pi: result = constants_[static_cast<std::size_t>(step.payload)]; break;
      case Op::symbol: result = t; break;
      default: result = symbolic::value_of(step.op, step.payload, arg, symbolic::Binary64{});
    }
  }
  return work_.empty() ? 0.0 : work_.back();
}

}  // namespace eomgen::run
