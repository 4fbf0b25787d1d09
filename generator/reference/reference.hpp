// SPDX-License-Identifier: GPL-3.0-or-later
// A motion to 30 digits and more: the program in CLN's arithmetic with Taylor steps, twice, at different order and
// precision. What the two agree in is what the reference claims. Parameters, starts and times are the binary64 numbers,
// exactly; but for constraints, which starts meet in all digits.
#pragma once

#include <cln/float.h>

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "program/program.hpp"

namespace eomgen::reference {

/// Inputs stand still until the end of each segment; the last one holds to the end.
struct InputSegment {
  double until;
  std::vector<double> u;
};

struct Problem {
  const program::Function& rhs;  // without branches that change on the way
  std::vector<double> x, p;
  double t0 = 0;
  std::vector<InputSegment> segments;
  std::vector<double> times;  // where the state is wanted, in the direction of the run; the last is its end
  const program::Function* constraints =
      nullptr;                  // the function of that name, where there is one: the start is moved to meet them
  std::size_t coordinates = 0;  // that it takes, first in x; their rates follow
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double fraction)> progress = {};
};

/// Digits of the arithmetic; the order of the series, whose last terms are 1e-(digits - 4) of the state.
struct Settings {
  int digits, order;
};
inline constexpr Settings coarse{38, 40}, fine{46, 50};

struct Solution {
  std::vector<std::vector<double>> x;  // per time, the finer run rounded
  std::vector<cln::cl_F> end;          // of it, not rounded
  int digits = 0, digits_at_end = 0;   // that agree, relative to the largest value of each component
  std::size_t steps = 0;               // of the finer run
  std::string method;
};

/// Throws Error{Fault::numerical} where the motion cannot be followed to the end.
Solution solve(const Problem& problem, Settings first = coarse, Settings second = fine);

}  // namespace eomgen::reference
