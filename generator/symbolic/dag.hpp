// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions of the compiled form: one arena of hash-consed nodes per model. Equal expressions have equal ids, so
// common subexpressions are shared and derivatives are memoised. Ids are in creation order, and nothing iterates over
// hashes or pointers: the same calls give the same ids in every process.
//
// Rules applied at construction: constant folding (exact), zero and one, commutative order by id, sign pulling
// (-a*b -> -(a*b), -a-b -> -(a+b), b-a -> -(a-b) with the smaller id first, sin(-x) -> -sin x, ...).
#pragma once

#include <cln/rational.h>

#include <array>
#include <cstdint>
#include <eom/expressions/operations.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace eomgen::symbolic {

using Rational = cln::cl_RA;

/// The leaves, followed by the operations of the runtime in the same order. power: args[0] to the integer payload (>=
/// 2; negative powers are 1/x^n with div).
enum class Op : std::uint8_t {
  constant,  // payload: index into the constants
  pi,
  symbol,  // payload: index into the symbols
  EOM_OPERATIONS(EOM_OPERATION_ENUMERATOR)
};

/// The same operation of the runtime. Not for leaves: constants, pi and symbols are numbers, variables or parameters
/// there.
constexpr eom::expressions::Op runtime_op(Op op) { return static_cast<eom::expressions::Op>(op); }
constexpr Op graph_op(eom::expressions::Op op) { return static_cast<Op>(op); }
static_assert(runtime_op(Op::add) == eom::expressions::Op::add, "as many leaves here as there");

/// Whether the value or the derivative is discontinuous on a surface given by the operands, with a different expression
/// on either side.
constexpr bool is_kink(Op op) { return eom::expressions::is_kink(runtime_op(op)); }

enum class SymbolKind : std::uint8_t {
  time,
  coordinate,  // order 0: q, 1: qdot, 2: qddot
  function,    // of time; order 0, 1, ..., 6
  parameter,
  input,
  multiplier,    // lambda of Mechanics::constraints[index]
  friction,      // phi of a tangent of Mechanics::contacts: a component of a friction force
  contact_mode,  // mode of a contact: order 0: slip direction (0: it sticks), order 1: sign of the normal force
  auxiliary,     // an auxiliary variable of the caller (cut points of the solve, the extension of a spring)
  integral,      // of a function of time, from the start of the run, in Model::states; set_rate defines its derivative
  branch,        // branch at which a kink is held: -1 or 1, or 0 for none (program/kinks.hpp)
  state,         // of first order, in Model::states; set_rate defines its derivative
  vector,        // an entry of the argument v of an emitted function (program/abi_functions.hpp)
};

struct Symbol {
  SymbolKind kind = SymbolKind::time;
  std::uint32_t index = 0;
  std::uint8_t order = 0;
  friend auto operator<=>(const Symbol&, const Symbol&) = default;
};

/// Index of a node in its Dag.
struct Ref {
  std::uint32_t id = 0;
  friend auto operator<=>(const Ref&, const Ref&) = default;
};

struct Node {
  Op op = Op::constant;
  std::uint8_t arity = 0;
  std::int32_t payload = 0;
  std::array<Ref, 4> args{};
  friend bool operator==(const Node&, const Node&) = default;
};

/// A directed acyclic graph of expressions, simplified as they are created.
class Dag {
 public:
  Dag();

  Ref zero() const { return zero_; }
  Ref one() const { return one_; }
  Ref constant(const Rational& value);
  Ref integer(long value) { return constant(Rational(value)); }
  Ref pi();
  Ref symbol(Symbol symbol);

  Ref add(Ref a, Ref b);
  Ref sub(Ref a, Ref b);
  Ref mul(Ref a, Ref b);
  Ref div(Ref a, Ref b);
  Ref neg(Ref a);
  Ref power(Ref a, long exponent);      // any sign
  Ref pow(Ref a, Ref b);                // power or sqrt if the exponent is such a constant
  Ref call(Op function, Ref a);         // sqrt ... sign
  Ref call(Op function, Ref a, Ref b);  // atan2, min, max
  Ref select(Ref a, Ref b, Ref x, Ref y);

  /// Declares a symbol positive, so that sqrt(x^2) becomes x: a length, or a radius inside its chart
  /// (docs/model-format.md, ranges).
  void assume_positive(Symbol symbol);
  /// Defines d/dt of an integral or a state of first order, for all later derivatives with respect to time.
  void set_rate(Symbol state, Ref rate) { rates_[state] = rate; }
  const std::map<Symbol, Ref>& rates() const { return rates_; }
  /// True if the assumptions imply that it is positive wherever it is defined; false is no statement.
  bool is_positive(Ref r) const;

  const Node& operator[](Ref r) const { return nodes_[r.id]; }
  std::size_t size() const { return nodes_.size(); }
  bool is_constant(Ref r) const { return nodes_[r.id].op == Op::constant; }
  bool is_zero(Ref r) const { return r == zero_; }
  bool is_one(Ref r) const { return r == one_; }
  const Rational& value(Ref r) const { return constants_[static_cast<std::size_t>(nodes_[r.id].payload)]; }
  const Symbol& symbol_of(Ref r) const { return symbols_[static_cast<std::size_t>(nodes_[r.id].payload)]; }

  /// The nodes on which `roots` depend, each once, operands first (ascending id).
  std::vector<Ref> reachable(const std::vector<Ref>& roots) const;
  bool has_kinks(const std::vector<Ref>& roots) const;
  /// The symbols in `roots`, sorted.
  std::vector<Symbol> symbols(const std::vector<Ref>& roots) const;

 private:
  struct Hash {
    std::size_t operator()(const Node& node) const noexcept;
  };
  Ref intern(const Node& node);
  Ref make(Op op, Ref a, Ref b);
  std::optional<Ref> exact_root(Ref a);

  std::vector<Node> nodes_;
  std::vector<Rational> constants_;
  std::vector<Symbol> symbols_;
  std::unordered_map<Node, std::uint32_t, Hash> index_;
  std::unordered_map<std::string, std::uint32_t> constant_index_;
  std::vector<std::pair<Symbol, std::uint32_t>> symbol_index_;  // sorted
  std::set<Symbol> positive_;
  std::map<Symbol, Ref> rates_;
  Ref zero_, one_;
};

/// A Ref with arithmetic operators, for readable formulas. All operands must belong to the same Dag.
struct Scalar {
  Dag* dag = nullptr;
  Ref ref;
};
inline Scalar operator+(Scalar a, Scalar b) { return {a.dag, a.dag->add(a.ref, b.ref)}; }
inline Scalar operator-(Scalar a, Scalar b) { return {a.dag, a.dag->sub(a.ref, b.ref)}; }
inline Scalar operator*(Scalar a, Scalar b) { return {a.dag, a.dag->mul(a.ref, b.ref)}; }
inline Scalar operator/(Scalar a, Scalar b) { return {a.dag, a.dag->div(a.ref, b.ref)}; }
inline Scalar operator-(Scalar a) { return {a.dag, a.dag->neg(a.ref)}; }

}  // namespace eomgen::symbolic
