// SPDX-License-Identifier: GPL-3.0-or-later
// Values of expressions and their slopes along many directions at once, by differentiation forward through the graph:
// numbers only, no derivative is written out. Shares with symbolic/calculus the table of functions and nothing else.
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
struct Sloped {
  std::vector<T> value;  // per root
  Matrix<T> slope;       // per root and direction
};

class Tape {
 public:
  /// Directions are symbols: slopes are partial derivatives.
  Tape(const Dag& dag, std::vector<Ref> roots, std::vector<Symbol> directions);

  /// Throws std::domain_error where a root has no value or no slope: outside of a domain, at the root of 0, on the edge
  /// of abs. A branch of `if` that is not taken needs neither. `edge`: digits within which a kink counts as met.
  template <class T>
  Sloped<T> at(const std::function<T(const Symbol&)>& lookup, int edge = 13) const;
  /// Values alone: the root of 0 has one, and so has the edge of abs.
  template <class T>
  std::vector<T> values(const std::function<T(const Symbol&)>& lookup) const;

 private:
  struct Step {
    symbolic::Op op;
    std::int32_t payload = 0;
    std::uint8_t arity = 0;
    std::array<std::uint32_t, 4> args{};  // places in steps_
    bool moves = false;                   // depends on a direction
    std::uint32_t place = 0;              // among those that move
    std::uint32_t direction = 0;          // of a symbol that moves
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

extern template Sloped<double> Tape::at(const std::function<double(const Symbol&)>&, int) const;
extern template Sloped<Precise> Tape::at(const std::function<Precise(const Symbol&)>&, int) const;
extern template std::vector<double> Tape::values(const std::function<double(const Symbol&)>&) const;
extern template std::vector<Precise> Tape::values(const std::function<Precise(const Symbol&)>&) const;

}  // namespace eomgen::linear
