// SPDX-License-Identifier: GPL-3.0-or-later
// Cancellation, operation budgets and progress of long calculations. The stop request and the name of the current
// stage are global to the process, like the signal and the terminal. Budgets belong to the calculating thread. Hot
// loops call work::consume_budget, which costs one subtraction.
#pragma once

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "results.hpp"

namespace eomgen::work {

/// Thrown by work::consume_budget after a request to stop. It is not a std::exception, so that error recovery does not
/// catch it.
struct Interrupted {};

using eomgen::LeftOut;

/// Thrown by work::consume_budget when a budget is exhausted.
struct BudgetExceeded : std::length_error {
  using std::length_error::length_error;
};

/// Requests the process to stop. Safe in a signal handler.
void request_stop() noexcept;

/// Defers interruption while it exists: the owner handles a request to stop, work::consume_budget does not throw for
/// it, and no progress is shown. It concerns the work of the listener of this thread if that listener has a stop flag
/// of its own, else the process. It ends in the thread that made it.
class DeferInterrupt {
 public:
  DeferInterrupt() noexcept;
  ~DeferInterrupt();
  DeferInterrupt(const DeferInterrupt&) = delete;
  DeferInterrupt& operator=(const DeferInterrupt&) = delete;

 private:
  std::atomic<int>& count_;
};
/// Whether the current work must end: a stop was requested, and no object defers it.
bool stop_requested() noexcept;

/// Receives the stages and warnings of the work of this thread while it exists. It may request a stop of this work, as
/// request_stop does for the process. A nested listener replaces the outer one.
class Listener {
 public:
  /// The work ends once `stop` is true; null: it ends only by request_stop.
  explicit Listener(const std::atomic<bool>* stop = nullptr) noexcept;
  virtual ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  /// Called at the start of each stage.
  virtual void on_stage(const char* stage);
  /// Called with each warning, as formatted by format_warning.
  virtual void on_warning(const std::string& text);

 private:
  friend bool stop_requested() noexcept;
  friend const std::atomic<bool>& stop_flag() noexcept;
  friend class DeferInterrupt;
  const std::atomic<bool>* stop_;
  std::atomic<int> deferred_{0};
  Listener* around_;
};
/// Sends a warning to the listener of this thread; without a listener it is discarded.
void warn(const std::string& text);
/// The flag that is true once a stop was requested: that of the listener if it has one, else that of the process.
const std::atomic<bool>& stop_flag() noexcept;

/// Subtracts operations from the current budget; one operation takes between ten nanoseconds and a microsecond.
/// Throws Interrupted, BudgetExceeded.
void consume_budget(std::size_t operations);
/// Throws Interrupted after a request to stop.
void throw_if_stopped();

/// Limits the operations of this thread while it exists: to `operations`, or to the rest of the enclosing budget if
/// that is less. The count is the same on every machine.
class Budget {
 public:
  explicit Budget(std::size_t operations);
  ~Budget();
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

 private:
  std::size_t around_, given_;
};

/// Names the current stage of the process while it exists. A nested stage replaces the outer one.
class Stage {
 public:
  explicit Stage(const char* name);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  const char* around_;
};
/// The name of the innermost stage; nullptr outside of stages.
const char* current_stage() noexcept;

/// Shows a progress line on a terminal, in place of the previous one. The end of the outermost stage clears it. Nothing
/// is shown outside of stages, or while interruption is deferred.
void show_line(const char* text);
void clear_line() noexcept;

}  // namespace eomgen::work
