// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/tape.hpp"

#include <cln/exception.h>

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <type_traits>

#include "symbolic/arithmetic.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::linear {
namespace {

using symbolic::Op;

template <class T>
auto arithmetic() {
  if constexpr (std::is_same_v<T, double>)
    return symbolic::Binary64Arithmetic{};
  else
    return symbolic::ClnArithmetic{precise_format()};
}

template <class T>
T call(Op op, const T& x) {
  return arithmetic<T>().call(op, x);
}

/// The `numbers` argument of symbolic::slope_of.
template <class T>
struct Numbers {
  static T one() { return T(1); }
  static T two() { return T(2); }
  static T square(const T& x) { return x * x; }
  static T call(Op op, const T& x) { return linear::call(op, x); }
};

/// A value and its partial derivatives with respect to the operands, or why there are none.
template <class T>
struct LocalDerivatives {
  T value{0};
  std::array<T, 4> slope{T(0), T(0), T(0), T(0)};
  const char* no_slope = nullptr;
};

constexpr const char* on_an_edge = "it lies on the edge of abs, sign, min, max or if";

/// `moves`: whether the compared values depend on a direction.
template <class T>
LocalDerivatives<T> kinked(Op op, const std::array<T, 4>& x, bool moves, int edge) {
  const bool one = op == Op::abs || op == Op::sign;
  const T gap = one ? x[0] : x[0] - x[1];
  const bool below = gap < T(0);
  // Decided once, in the digits of T: exactly on the kink there is no derivative.
  const bool met = moves && !(magnitude(gap) > tiny<T>(edge) * (magnitude(x[0]) + magnitude(one ? T(1) : x[1])));
  const char* const no_slope = met ? on_an_edge : nullptr;
  switch (op) {
    case Op::abs: return {magnitude(x[0]), {below ? T(-1) : T(1)}, no_slope};
    case Op::sign: return {is_zero(gap) ? T(0) : below ? T(-1) : T(1), {}, no_slope};
    case Op::min:
      return below ? LocalDerivatives<T>{x[0], {T(1), T(0)}, no_slope}
                   : LocalDerivatives<T>{x[1], {T(0), T(1)}, no_slope};
    case Op::max:
      return below ? LocalDerivatives<T>{x[1], {T(0), T(1)}, no_slope}
                   : LocalDerivatives<T>{x[0], {T(1), T(0)}, no_slope};
    default:
      return below ? LocalDerivatives<T>{x[2], {T(0), T(0), T(1), T(0)}, no_slope}
                   : LocalDerivatives<T>{x[3], {T(0), T(0), T(0), T(1)}, no_slope};
  }
}

template <class T>
LocalDerivatives<T> of_operator(Op op, std::int32_t payload, const std::array<T, 4>& x,
                                const std::array<bool, 4>& moves) {
  switch (op) {
    case Op::add: return {x[0] + x[1], {T(1), T(1)}};
    case Op::sub: return {x[0] - x[1], {T(1), T(-1)}};
    case Op::mul: return {x[0] * x[1], {x[1], x[0]}};
    case Op::neg: return {-x[0], {T(-1)}};
    case Op::div: {
      require_domain(!is_zero(x[1]), "division by zero");
      const T v = x[0] / x[1];
      return {v, {T(1) / x[1], -v / x[1]}};
    }
    case Op::power: {
      const T before = arithmetic<T>().power(x[0], payload - 1);
      return {before * x[0], {T(payload) * before}};
    }
    default: break;
  }
  require_domain(x[0] > T(0), "a real power of a number that is not positive");  // Op::pow
  const T log = call<T>(Op::log, x[0]), v = call<T>(Op::exp, x[1] * log);
  return {v, {x[1] * v / x[0], moves[1] ? v * log : T(0)}};
}

template <class T>
LocalDerivatives<T> of_function(Op op, const T& x, bool moves) {
  if (op == Op::sqrt) require_domain(!(x < T(0)), "sqrt of a negative number");
  if (op == Op::log) require_domain(x > T(0), "log of a number that is not positive");
  if (op == Op::asin || op == Op::acos) require_domain(!(magnitude(x) > T(1)), "asin or acos beyond 1");
  const T v = call(op, x);
  if (!moves) return {v, {}};
  const auto [size, divides, falls] = symbolic::slope_of(symbolic::function_of(op), x, v, Numbers<T>{});
  if (divides && is_zero(size)) return {v, {}, op == Op::sqrt ? "sqrt of 0 has no slope" : "asin or acos at 1"};
  const T slope = divides ? T(T(1) / size) : size;
  return {v, {falls ? T(-slope) : slope}};
}

template <class T>
LocalDerivatives<T> local(Op op, std::int32_t payload, const std::array<T, 4>& x, const std::array<bool, 4>& moves,
                          int edge) {
  if (symbolic::is_kink(op)) return kinked(op, x, moves[0] || moves[1], edge);
  switch (op) {
    case Op::add:
    case Op::sub:
    case Op::mul:
    case Op::div:
    case Op::neg:
    case Op::power:
    case Op::pow: return of_operator(op, payload, x, moves);
    case Op::atan2: {
      const T square = x[0] * x[0] + x[1] * x[1];
      require_domain(square > T(0), "atan2(0, 0)");
      return {arithmetic<T>().atan2(x[0], x[1]), {x[1] / square, -x[0] / square}};
    }
    default: return of_function(op, x[0], moves[0]);
  }
}

}  // namespace

Tape::Tape(const Dag& dag, std::vector<Ref> roots, std::vector<Symbol> directions)
    : dag_(dag), directions_(directions.size()) {
  std::map<Symbol, std::uint32_t> along;
  for (std::uint32_t i = 0; i < directions.size(); ++i) along[directions[i]] = i;
  nodes_ = dag.reachable(roots);
  std::map<Ref, std::uint32_t> place;
  for (const Ref r : nodes_) {
    const symbolic::Node& node = dag[r];
    Step step{node.op, node.payload, node.arity};
    for (std::uint8_t i = 0; i < node.arity; ++i) {
      step.args[i] = place.at(node.args[i]);
      step.moves = step.moves || steps_[step.args[i]].moves;
    }
    if (node.op == Op::symbol) {
      const auto found = along.find(dag.symbol_of(r));
      step.moves = found != along.end();
      if (step.moves) step.direction = found->second;
    }
    if (step.moves) step.place = static_cast<std::uint32_t>(moving_++);
    place[r] = static_cast<std::uint32_t>(steps_.size());
    steps_.push_back(step);
  }
  for (const Ref r : roots) roots_.push_back(place.at(r));
}

/// The results of all steps, with the reason if one has no value or no derivative.
template <class T>
struct Tape::Run {
  std::vector<T> value;
  Matrix<T> jacobian;  // of the steps that move
  std::vector<std::string> reasons;
  std::vector<std::uint32_t> no_value, no_slope;  // per step: 0, or 1 + an index into `reasons`

  std::uint32_t reason_index(const std::string& reason) {
    reasons.push_back(reason);
    return static_cast<std::uint32_t>(reasons.size());
  }
};

template <class T>
Tape::Run<T> Tape::run(const std::function<T(const Symbol&)>& lookup, int edge, bool slopes) const {
  Run<T> r{std::vector<T>(steps_.size()),
           Matrix<T>(slopes ? moving_ : 0, directions_),
           {},
           std::vector<std::uint32_t>(steps_.size(), 0),
           std::vector<std::uint32_t>(steps_.size(), 0)};
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const Step& step = steps_[k];
    if (step.op == Op::constant) r.value[k] = number<T>(dag_.value(nodes_[k]));
    if (step.op == Op::pi) r.value[k] = arithmetic<T>().pi();
    if (step.op == Op::symbol) {
      r.value[k] = lookup(dag_.symbol_of(nodes_[k]));
      if (step.moves && slopes) r.jacobian(step.place, step.direction) = T(1);
    }
    if (step.arity == 0) continue;
    std::array<T, 4> x{T(0), T(0), T(0), T(0)};
    std::array<bool, 4> moves{}, needed{};
    for (std::uint8_t i = 0; i < step.arity; ++i) {
      x[i] = r.value[step.args[i]];
      moves[i] = steps_[step.args[i]].moves;
      needed[i] = step.op != Op::select || i < 2;
    }
    if (step.op == Op::select) needed[x[0] < x[1] ? 2 : 3] = true;
    for (std::uint8_t i = 0; i < step.arity && r.no_value[k] == 0; ++i) {
      if (needed[i]) r.no_value[k] = r.no_value[step.args[i]];
    }
    if (r.no_value[k] != 0) continue;
    LocalDerivatives<T> here;
    try {
      here = local(step.op, step.payload, x, moves, edge);
    } catch (const std::domain_error& error) {
      r.no_value[k] = r.reason_index(error.what());
      continue;
    } catch (const cln::runtime_exception&) {
      r.no_value[k] = r.reason_index("a number that is too large");
      continue;
    }
    r.value[k] = here.value;
    if (!slopes) continue;
    if (here.no_slope != nullptr && step.moves) r.no_slope[k] = r.reason_index(here.no_slope);
    for (std::uint8_t i = 0; i < step.arity; ++i) {
      if (!moves[i] || !needed[i]) continue;
      if (r.no_slope[k] == 0) r.no_slope[k] = r.no_slope[step.args[i]];
      if (is_zero(here.slope[i])) continue;
      if constexpr (std::is_same_v<T, double>) {
        if (std::isfinite(here.slope[i])) {
          const auto row = [&](std::uint32_t place) {
            return Eigen::Map<Eigen::ArrayXd>(r.jacobian.a.data() + place * directions_,
                                              static_cast<Eigen::Index>(directions_));
          };
          row(step.place) += here.slope[i] * row(steps_[step.args[i]].place);
          continue;
        }
      }
      for (std::size_t d = 0; d < directions_; ++d) {
        const T& inner = r.jacobian(steps_[step.args[i]].place, d);
        if (!is_zero(inner)) r.jacobian(step.place, d) = r.jacobian(step.place, d) + here.slope[i] * inner;
      }
    }
  }
  return r;
}

template <class T>
ValueAndJacobian<T> Tape::at(const std::function<T(const Symbol&)>& lookup, int edge) const {
  const Run<T> r = run(lookup, edge, true);
  ValueAndJacobian<T> result{{}, Matrix<T>(roots_.size(), directions_)};
  for (std::size_t i = 0; i < roots_.size(); ++i) {
    const Step& step = steps_[roots_[i]];
    for (const std::uint32_t reason : {r.no_value[roots_[i]], r.no_slope[roots_[i]]}) {
      if (reason != 0) throw std::domain_error(r.reasons[reason - 1]);
    }
    result.value.push_back(r.value[roots_[i]]);
    for (std::size_t d = 0; step.moves && d < directions_; ++d) result.jacobian(i, d) = r.jacobian(step.place, d);
  }
  return result;
}

template <class T>
std::vector<T> Tape::values(const std::function<T(const Symbol&)>& lookup) const {
  const Run<T> r = run(lookup, 0, false);
  std::vector<T> result;
  for (const std::uint32_t root : roots_) {
    if (const std::uint32_t reason = r.no_value[root]; reason != 0) throw std::domain_error(r.reasons[reason - 1]);
    result.push_back(r.value[root]);
  }
  return result;
}

template ValueAndJacobian<double> Tape::at(const std::function<double(const Symbol&)>&, int) const;
template ValueAndJacobian<Precise> Tape::at(const std::function<Precise(const Symbol&)>&, int) const;
template std::vector<double> Tape::values(const std::function<double(const Symbol&)>&) const;
template std::vector<Precise> Tape::values(const std::function<Precise(const Symbol&)>&) const;

}  // namespace eomgen::linear
