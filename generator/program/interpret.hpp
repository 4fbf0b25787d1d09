// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a Function without a compiler: in binary64 or binary32 as the emitted code would, or with CLN at any number of
// digits, so that verify can hold the optimised program against the expressions that it was made of.
#pragma once

#include <cln/real.h>

#include <utility>
#include <vector>

#include "program/program.hpp"

namespace eomgen::program {

template <class Real>
struct Arguments {
  Real t{};
  std::vector<Real> x, p, u;
  std::vector<Real> w{};        // what `prepare` made of p
  std::vector<Real> side = {};  // of the kinks; left out: their branches follow the state
  int mode = 0;                 // of friction contacts
};

template <class Real>
struct Values {
  std::vector<std::vector<Real>> results;     // one list per Function::results
  std::vector<std::pair<Real, Real>> pivots;  // pivot, scale
};

/// Throws std::domain_error where a function leaves its real domain or a division is by zero.
Values<cln::cl_R> interpret(const Function& function, const Arguments<cln::cl_R>& arguments, int digits);
/// Not-a-number or infinite where there is no value.
Values<double> interpret(const Function& function, const Arguments<double>& arguments);
Values<float> interpret(const Function& function, const Arguments<float>& arguments);

}  // namespace eomgen::program
