// SPDX-License-Identifier: GPL-3.0-or-later
// A motion in 30 digits and more: the program in CLN arithmetic with Taylor steps, twice, with different order and
// precision. The reference claims the digits in which both agree. The time of a kink is known to rounding: one run
// continues across the gap, the other leaves it out. The time of an event is found in all digits. Parameters, starts
// and times are the exact values of the binary64 numbers, except that starts satisfy the constraints in all digits.
#pragma once

#include <cln/float.h>

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "program/program.hpp"

namespace eomgen::reference {

/// Inputs are constant until the end of each segment; the last segment lasts to the end.
struct InputSegment {
  double until;
  std::vector<double> u;
  double next = until;  // start of the following segment, beyond `until` by rounding at a kink in time
  std::optional<std::size_t> event = {};  // the segment ends where this event function is 0, near `until`
};

struct Problem {
  const program::Function& rhs;  // without branches that change within a segment
  std::vector<double> x, p;
  double t0 = 0;
  std::vector<InputSegment> segments;
  std::vector<double> times;  // of the requested states, in the direction of the run; the last is its end
  const program::Function* constraints =
      nullptr;                  // the function of that name, if there is one: the start is projected onto them
  std::size_t coordinates = 0;  // number of its coordinates, first in x; their rates follow
  /// Changes the state at a boundary: 0 at the start, k + 1 after segment k. Empty: nothing changes it.
  std::function<void(std::size_t boundary, const cln::cl_F& t, std::vector<cln::cl_F>& x, int digits)> change = {};
  /// The event function of a segment. Needed where a segment ends at an event.
  std::function<cln::cl_F(std::size_t segment, const cln::cl_F& t, const std::vector<cln::cl_F>& x, int digits)>
      event_value = {};
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double fraction)> progress = {};
};

/// Digits of the arithmetic, and order of the series; the last terms are 1e-(digits - 4) of the state.
struct Settings {
  int digits, order;
  /// Bits that a time has at least after rounding errors.
  int bits() const { return digits * 10 / 3 - 8; }
};
inline constexpr Settings coarse{38, 40}, fine{46, 50};

struct Solution {
  std::vector<std::vector<double>> x;  // per time, of the finer run, rounded
  std::vector<cln::cl_F> end;          // of the finer run, not rounded
  int digits = 0, digits_at_end = 0;   // that agree, relative to the largest value of each component
  std::size_t steps = 0;               // of the finer run
  std::string method;
};

/// Computes the reference solution. Throws Error{ErrorKind::numerical} if the motion cannot be computed to the end.
Solution solve(const Problem& problem, Settings first = coarse, Settings second = fine);

}  // namespace eomgen::reference
