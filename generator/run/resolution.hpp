// SPDX-License-Identifier: GPL-3.0-or-later
// Whether steps of a fixed size resolve a motion. Where they do not, runs with different steps may still end alike: a
// method that damps what it cannot follow damps it in all of them. So the states on the way are compared, not the ends
// alone.
#pragma once

#include <eom/run_types.hpp>
#include <functional>
#include <vector>

namespace eomgen::run {

class Resolution {
 public:
  /// impacts: differences count as far as two states in a row have them, since one alone may lie between two times of
  /// the same impact.
  explicit Resolution(bool impacts) : impacts_(impacts) {}

  /// Of the run itself: some of its states.
  void see(const eom::StepView& step);

  /// Of a run with other steps: differences there. `align` may turn angles of the second state by whole turns.
  using Align = std::function<void(const std::vector<double>& first, std::vector<double>& other)>;
  void compare(const eom::StepView& step, const Align& align);

  /// Largest difference relative to the largest value of its component, and per component.
  double largest() const;
  const std::vector<double>& differences() const { return difference_; }

  /// From here on nothing can be said of the end: a tenth of what moves.
  static constexpr double unresolved = 0.1;

 private:
  static constexpr std::size_t most = 729;  // states kept
  struct Seen {
    double t;
    std::vector<double> x;
  };
  bool impacts_;
  std::vector<Seen> seen_;
  std::size_t stride_ = 1, steps_ = 0, next_ = 0;
  std::vector<double> size_, difference_, before_, x_;
};

}  // namespace eomgen::run
