// SPDX-License-Identifier: GPL-3.0-or-later
// Context of a library call: takes the lock, forwards stop requests and callbacks of the Task. Not installed.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>

#include "eomgen/formulas.hpp"
#include "eomgen/task.hpp"
#include "pipeline/pipeline.hpp"
#include "print/render.hpp"
#include "run/scene.hpp"
#include "work.hpp"

namespace eomgen {

/// The lock of the whole process. CLN and GiNaC count references without atomics and share constants. Recursive,
/// because callbacks may call the library again.
std::recursive_mutex& one_at_a_time();

/// Forwards progress and warnings of one call to its Task, and its stop request to the stages.
class Call : public work::Listener {
 public:
  explicit Call(const Task& task) : Listener(&stopped_), task_(task), asked_(task.stop, Raise{&stopped_}) {}

  const std::atomic<bool>* stopped() const { return &stopped_; }
  std::function<void(double)> progress() const { return task_.progress; }
  void on_stage(const char* stage) override {
    if (task_.begins) task_.begins(stage);
  }
  void on_warning(const std::string& text) override {
    if (task_.warns) task_.warns(text);
  }

 private:
  struct Raise {
    std::atomic<bool>* flag;
    void operator()() const { flag->store(true); }
  };
  std::atomic<bool> stopped_{false};
  const Task& task_;
  std::stop_callback<Raise> asked_;
};

/// Runs `work(call)` under the lock and returns its result. Throws Interrupted if the call was stopped.
template <class Work>
auto with_lock(const Task& task, Work&& work) {
  const std::scoped_lock lock(one_at_a_time());
  Call call(task);
  try {
    return work(call);
  } catch (const work::Interrupted&) {
    throw Interrupted();
  }
}

pipeline::ApproachChoice choice_of(Approach approach);
/// Converts each value to the exact shortest decimal that denotes it, as on the command line. Throws Error for values
/// that are not finite.
std::map<std::string, symbolic::Rational> exact(const std::map<std::string, double>& values);
Formula formula_of(const print::PrintedFormula& item);
std::vector<LeftOut> left_out_of(const std::vector<work::LeftOut>& list);

}  // namespace eomgen
