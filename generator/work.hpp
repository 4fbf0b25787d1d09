// SPDX-License-Identifier: GPL-3.0-or-later
// What long calculations owe to those who wait for them: they end when they are asked to, have budgets counted in
// operations, and say what they do. The request and the name of what is under way are one for the process, as the
// signal and the terminal are; budgets belong to the thread that calculates. Hot loops call `spend`, which is a
// subtraction.
#pragma once

#include <atomic>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>

namespace eomgen::work {

/// Thrown by `spend` after a request to stop. It is no std::exception: what recovers from a failure lets it pass.
struct Interrupted {};

/// What is left out of an answer, and why: "acceleration of roll.1", "too many terms to be written out".
struct LeftOut {
  std::string what, why;
  bool over_budget = true;  // false: it does not apply
};

/// Thrown by `spend` where a budget is used up.
struct OverBudget : std::length_error {
  using std::length_error::length_error;
};

/// Safe in a signal handler.
void request_stop() noexcept;

/// While one exists, a request to stop is seen to by whoever made it: `spend` does not throw for it, and no progress is
/// shown.
class Kept {
 public:
  Kept() noexcept;
  ~Kept();
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
};
/// Whether what is under way has to be left: a stop was requested, and nothing is kept.
bool abandoned() noexcept;

/// Who called for what this thread does, while one exists: is told what begins and what to know beside the result, and
/// may ask for an end as request_stop does for the process. Listeners within listeners are in place of these.
class Listener {
 public:
  /// `stop` becomes true where what is under way is to end.
  explicit Listener(const std::atomic<bool>* stop = nullptr) noexcept;
  virtual ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  virtual void begins(const char* stage);
  /// A warning as format_warning gives it.
  virtual void warns(const std::string& text);

 private:
  friend bool abandoned() noexcept;
  friend const std::atomic<bool>& stop_flag() noexcept;
  const std::atomic<bool>* stop_;
  Listener* around_;
};
/// To the listener of this thread; lost where there is none.
void warn(const std::string& text);
/// What is true once an end was asked for: of the listener where it has one, or else of the process.
const std::atomic<bool>& stop_flag() noexcept;

/// Counts operations of some ten nanoseconds to a microsecond. Throws Interrupted, OverBudget.
void spend(std::size_t operations);
/// Throws Interrupted.
void check();

/// While one exists, `operations` may be spent, or what is left of the budget around it; the same on every machine.
class Budget {
 public:
  explicit Budget(std::size_t operations);
  ~Budget();
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

 private:
  std::size_t around_, given_;
};

/// While one exists, this is what the process says it does. Stages within stages are told in place of these.
class Stage {
 public:
  explicit Stage(const char* name);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  const char* around_;
};
/// The innermost; nullptr where none is under way.
const char* stage() noexcept;

/// A line on a terminal that the next one replaces; the end of the outermost stage clears it. Nothing is shown outside
/// of stages, nor while anything is kept.
void show_line(const char* text);
void clear_line() noexcept;

}  // namespace eomgen::work
