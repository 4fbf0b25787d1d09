// SPDX-License-Identifier: GPL-3.0-or-later
// Context of a library call: takes the lock, forwards stop requests and callbacks of the CallControl. Not installed.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>

#include "eomgen/call_control.hpp"
#include "eomgen/formulas.hpp"
#include "pipeline/pipeline.hpp"
#include "print/render.hpp"
#include "run/scene.hpp"
#include "work.hpp"

namespace eomgen {

/// The lock of the whole process. CLN and GiNaC count references without atomics and share constants. Recursive,
/// because callbacks may call the library again.
std::recursive_mutex& library_mutex();

/// Forwards progress and warnings of one call to its CallControl, and its stop request to the stages.
class CallListener : public work::Listener {
 public:
  /// `control` must outlive this object.
  explicit CallListener(const CallControl& control);

  /// True after a stop request; stages poll it.
  const std::atomic<bool>* stopped() const { return &stopped_; }
  /// The callback for progress in [0, 1]; may be empty.
  std::function<void(double)> progress() const { return control_.on_progress; }
  void on_stage(const char* stage) override {
    if (control_.on_stage) control_.on_stage(stage);
  }
  void on_warning(const std::string& text) override {
    if (control_.on_warning) control_.on_warning(text);
  }

 private:
  struct SetFlag {
    std::atomic<bool>* flag;
    void operator()() const { flag->store(true); }
  };
  std::atomic<bool> stopped_{false};
  const CallControl& control_;
  std::stop_callback<SetFlag> stop_callback_;
};

/// Runs `work(call)` and returns its result. Throws Interrupted if the call was stopped. `work` takes the lock itself
/// where it needs it.
template <class Work>
auto with_listener(const CallControl& control, Work&& work) {
  CallListener call(control);
  try {
    return work(call);
  } catch (const work::Interrupted&) {
    throw Interrupted();
  }
}

/// The same under the lock.
template <class Work>
auto with_lock(const CallControl& control, Work&& work) {
  const std::scoped_lock lock(library_mutex());
  return with_listener(control, std::forward<Work>(work));
}

/// The same choice as an argument of the stages.
pipeline::ApproachChoice approach_choice(Approach approach);
/// Converts each value to the exact shortest decimal that denotes it, as on the command line. Throws Error for values
/// that are not finite.
std::map<std::string, symbolic::Rational> exact_rationals(const std::map<std::string, double>& values);
}  // namespace eomgen
