// SPDX-License-Identifier: GPL-3.0-or-later
// Values of expressions and their derivatives in many directions at once, by forward differentiation through the graph.
// It computes numbers only and forms no derivative expressions. Shares with symbolic/calculus the table of functions
// and nothing else.
#pragma once

#include <functional>
#include <vector>

#include "linear/dense.hpp"
#include "symbolic/dag.hpp"

namespace eomgen::linear {

using symbolic::Dag;
using symbolic::Ref;
using symbolic::Symbol;

template <class T>
struct ValueAndJacobian {
  std::vector<T> value;  // per root
  Matrix<T> jacobian;    // per root and direction
};

class Tape {
 public:
  /// Directions are symbols, so the derivatives are partial.
  Tape(const Dag& dag, std::vector<Ref> roots, std::vector<Symbol> directions);

  /// Throws std::domain_error if a root has no value or no derivative: outside of a domain, at the root of 0, on a kink
  /// of abs. A branch of `if` that is not taken needs neither. `edge`: digits within which a point counts as on a kink.
  template <class T>
  ValueAndJacobian<T> at(const std::function<T(const Symbol&)>& lookup, int edge = 13) const;
  /// Values alone; these exist at the root of 0 and on the kink of abs.
  template <class T>
  std::vector<T> values(const std::function<T(const Symbol&)>& lookup) const;

 private:
  struct Step {
    symbolic::Op op;
    std::int32_t payload = 0;
    std::uint8_t arity = 0;
    std::array<std::uint32_t, 4> args{};  // places in steps_
    bool moves = false;                   // depends on a direction
    std::uint32_t place = 0;              // among the steps that move
    std::uint32_t direction = 0;          // of a moving symbol
  };

  template <class T>
  struct Run;
  template <class T>
  Run<T> run(const std::function<T(const Symbol&)>& lookup, int edge, bool slopes) const;

  const Dag& dag_;
  std::vector<Step> steps_;
  std::vector<Ref> nodes_;            // of steps_
  std::vector<std::uint32_t> roots_;  // places in steps_
  std::size_t directions_, moving_ = 0;
};

extern template ValueAndJacobian<double> Tape::at(const std::function<double(const Symbol&)>&, int) const;
extern template ValueAndJacobian<Precise> Tape::at(const std::function<Precise(const Symbol&)>&, int) const;
extern template std::vector<double> Tape::values(const std::function<double(const Symbol&)>&) const;
extern template std::vector<Precise> Tape::values(const std::function<Precise(const Symbol&)>&) const;

}  // namespace eomgen::linear
