// SPDX-License-Identifier: GPL-3.0-or-later
// Interprets a Function: in binary64 or binary32 as emitted code would, or with CLN in any number of digits. `verify`
// compares optimised programs with their source expressions this way.
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
  std::vector<Real> w{};        // prepared values, from `prepare`
  std::vector<Real> side = {};  // sides of the kinks; empty: branches follow the state
  std::vector<int> mode = {};   // docs/abi.md; only the states of contacts are read; empty: all are 0
  std::vector<Real> v = {};     // of functions with a vector
};

/// The sign of a contact that the operand `index` of Slot::contact stands for (eom::contact_sign).
template <class Real>
int contact_sign(const Arguments<Real>& arguments, std::uint32_t index) {
  return eom::contact_sign(arguments.mode, index / 2, index % 2);
}

template <class Real>
struct Values {
  std::vector<std::vector<Real>> results;     // one list per Function::results
  std::vector<std::pair<Real, Real>> pivots;  // pivot, scale
};

/// Throws std::domain_error if a function leaves its real domain, and for a division by zero.
Values<cln::cl_R> interpret(const Function& function, const Arguments<cln::cl_R>& arguments, int digits);
/// NaN or infinite if there is no value.
Values<double> interpret(const Function& function, const Arguments<double>& arguments);
Values<float> interpret(const Function& function, const Arguments<float>& arguments);

}  // namespace eomgen::program
