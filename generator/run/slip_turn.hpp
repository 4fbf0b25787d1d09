// SPDX-License-Identifier: GPL-3.0-or-later
// The turn of friction with slip in two directions, of contacts whose forces are solved for. Friction along w/|w| turns
// at the rate w'/|w|: where slip ends, |w| is smaller than any width of differences. So derivatives are taken at fixed
// directions, and those by the directions are added. In: the equations, a state, the derivative of each slip. Out: the
// derivative of the right-hand side by the turn.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "run/variational_equations.hpp"

namespace eomgen::run {

/// A slip of each turning contact, or its derivative.
using Slips = std::vector<std::array<double, 2>>;

/// The turning contacts at one state. While an object lives, the equations given to hold() have fixed directions.
class SlipTurn {
 public:
  SlipTurn(VariationalEquations& own, double t, const double* x);
  SlipTurn(const SlipTurn&) = delete;
  SlipTurn& operator=(const SlipTurn&) = delete;
  ~SlipTurn();

  /// Fixes the directions of the same contacts in other equations, too.
  void hold(VariationalEquations& in);
  /// Adds weight times the slips at a state to `sum`. Returns a code.
  int add_slips(VariationalEquations& in, double t, const double* x, double weight, Slips& sum) const;
  /// A sum to begin with.
  Slips zero() const { return Slips(contacts_.size()); }
  /// Adds the derivative of the right-hand side at (t, x) by the turn that the slips with these derivatives make.
  /// Returns a code.
  int add_turn(double t, const double* x, const Slips& rates, double* slope);

 private:
  struct Contact {
    std::size_t place;
    std::array<double, 2> slip, direction;
  };
  void prescribe(VariationalEquations& in, const std::vector<double>& angles) const;

  VariationalEquations& own_;
  std::vector<Contact> contacts_;
  std::vector<VariationalEquations*> held_;
};

}  // namespace eomgen::run
