// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/series.hpp"

#include "symbolic/evaluate.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::symbolic {

using cln::cl_R;

PowerSeries::PowerSeries(Dag& dag, std::vector<Ref> roots, int digits)
    : dag_(dag), roots_(std::move(roots)), digits_(digits) {
  // The derivatives of functions need series too, which may contain further functions; repeat until none is new.
  for (std::vector<Ref> open = roots_; !open.empty();) {
    std::vector<Ref> found;
    for (const Ref r : dag_.reachable(open)) {
      const auto [place, is_new] = series_.try_emplace(r);
      if (!is_new || !is_function(dag_[r])) continue;
      place->second.slope = slopes(r);
      found.insert(found.end(), place->second.slope.begin(), place->second.slope.end());
    }
    open = std::move(found);
  }
}

bool PowerSeries::is_function(const Node& node) const {
  switch (node.op) {
    case Op::constant:
    case Op::pi:
    case Op::symbol:
    case Op::add:
    case Op::sub:
    case Op::neg:
    case Op::mul:
    case Op::div: return false;
    default: return !is_kink(node.op);
  }
}

// Derivatives are expressed by the value itself if that closes the recursion: sqrt, exp, tan, general powers.
std::array<Ref, 2> PowerSeries::slopes(Ref r) {
  const Node node = dag_[r];
  const auto s = [this](Ref ref) { return Scalar{&dag_, ref}; };
  const ScalarNumbers numbers{dag_};
  const Scalar self = s(r), x = s(node.args[0]), y = s(node.args[1]);
  const Ref none = dag_.zero();
  switch (node.op) {
    case Op::power: return {(s(dag_.integer(node.payload)) * s(dag_.power(x.ref, node.payload - 1))).ref, none};
    case Op::pow:
      return {(y * self / x).ref, dag_.symbols({y.ref}).empty() ? none : (self * numbers.call(Op::log, x)).ref};
    case Op::atan2:
      return {(y / (numbers.square(x) + numbers.square(y))).ref, (-(x / (numbers.square(x) + numbers.square(y)))).ref};
    default: {
      const auto [size, divides, falls] = slope_of(function_of(node.op), x, self, numbers);
      const Scalar slope = divides ? numbers.one() / size : size;
      return {falls ? (-slope).ref : slope.ref, none};
    }
  }
}

void PowerSeries::extend(const Lookup& lookup) {
  if (order_ == 0) {
    std::vector<Ref> all;
    for (const auto& entry : series_) all.push_back(entry.first);
    const std::vector<cl_R> values = evaluate(
        dag_, all, [&](const Symbol& s) { return lookup(s, 0); }, digits_);
    std::size_t i = 0;
    for (auto& entry : series_) entry.second.c.push_back(values[i++]);
  } else {
    for (auto& entry : series_) entry.second.c.push_back(next(entry.first, lookup));
  }
  ++order_;
}

cl_R PowerSeries::next(Ref r, const Lookup& lookup) const {
  const Node& node = dag_[r];
  const std::size_t k = order_;
  const auto arg = [&](std::size_t i) -> const std::vector<cl_R>& { return of(node.args[i]); };
  cl_R sum = 0;
  switch (node.op) {
    case Op::constant:
    case Op::pi:
    case Op::sign: return 0;
    case Op::symbol: return lookup(dag_.symbol_of(r), k);
    case Op::add: return arg(0)[k] + arg(1)[k];
    case Op::sub: return arg(0)[k] - arg(1)[k];
    case Op::neg: return -arg(0)[k];
    case Op::mul:
      for (std::size_t i = 0; i <= k; ++i) sum = sum + arg(0)[i] * arg(1)[k - i];
      return sum;
    case Op::div:
      for (std::size_t i = 0; i < k; ++i) sum = sum + of(r)[i] * arg(1)[k - i];
      return (arg(0)[k] - sum) / arg(1)[0];
    case Op::abs: return cln::minusp(arg(0)[0]) ? -arg(0)[k] : arg(0)[k];
    case Op::min: return arg(arg(1)[0] < arg(0)[0] ? 1 : 0)[k];
    case Op::max: return arg(arg(0)[0] < arg(1)[0] ? 1 : 0)[k];
    case Op::select: return arg(arg(0)[0] < arg(1)[0] ? 2 : 3)[k];
    default: break;
  }
  // Chain rule: d/ds of a function is the sum of its partial derivatives times d/ds of the arguments.
  const std::array<Ref, 2>& slope = series_.at(r).slope;
  for (std::size_t a = 0; a < 2; ++a) {
    if (dag_.is_zero(slope[a])) continue;
    for (std::size_t i = 1; i <= k; ++i) sum = sum + cl_R(static_cast<long>(i)) * arg(a)[i] * of(slope[a])[k - i];
  }
  return sum / cl_R(static_cast<long>(k));
}

}  // namespace eomgen::symbolic
