// SPDX-License-Identifier: GPL-3.0-or-later
// Calls of the library from Python: without the GIL, ended by Ctrl-C, with callbacks.
#pragma once

#include <pybind11/pybind11.h>

#include <eomgen/eomgen.hpp>
#include <optional>
#include <stop_token>
#include <utility>

namespace eomgen::python {

namespace py = pybind11;

/// While it exists, SIGINT requests a stop of the calls of the main thread. The handler of Python is called too.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  std::stop_token token() const { return stop_.get_token(); }
  void request_stop() { stop_.request_stop(); }

 private:
  bool installed_ = false;
  std::stop_source stop_;
};

/// Python functions that a call reports to, or None. `progress` may return False to end the call.
struct Callbacks {
  py::object stage, progress, warning;
};

/// The CallControl of one call. An exception of a callback ends the call and is thrown by `rethrow`.
class PythonControl {
 public:
  explicit PythonControl(const Callbacks& callbacks);

  const CallControl& control() const { return control_; }
  /// Calls a Python function in a thread without the GIL.
  template <class Function>
  void call(Function&& function) {
    const py::gil_scoped_acquire gil;
    if (failure_) return;
    try {
      function();
    } catch (py::error_already_set& error) {
      failure_.emplace(std::move(error));
      watch_.request_stop();
    }
  }
  /// With the GIL: throws the exception of a callback, or that of a handler of Python for a signal.
  void rethrow();
  bool is_stopped() const { return control_.stop.stop_requested(); }
  /// Whether a callback of progress asked for the end.
  bool is_ended() const { return ended_; }

 private:
  InterruptWatch watch_;
  CallControl control_;
  std::optional<py::error_already_set> failure_;
  bool ended_ = false;
};

/// Returns `work(control)`, computed without the GIL. A signal whose handler raises nothing does not end the call.
template <class Work>
auto call_library(const Callbacks& callbacks, Work&& work) {
  while (true) {
    PythonControl python(callbacks);
    std::optional<decltype(work(python))> result;
    bool interrupted = false;
    try {
      const py::gil_scoped_release released;
      result.emplace(work(python));
    } catch (const Interrupted&) {
      interrupted = true;
    }
    python.rethrow();
    if (interrupted && python.is_ended()) throw Interrupted();
    if (!interrupted && (!python.is_stopped() || python.is_ended())) return std::move(*result);
  }
}

}  // namespace eomgen::python
