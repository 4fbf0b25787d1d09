// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

namespace eomgen::python {
namespace {

constexpr std::chrono::milliseconds progress_interval{100};

class Runs {
 public:
  Runs(const Model& model, const SweepRequest& request, std::stop_token stop)
      : model_(model), request_(request), stop_(std::move(stop)) {
    result_.ends.resize(request.names.empty() ? 0 : request.points.size() / request.names.size(),
                        {"interrupted", "", 0, std::numeric_limits<double>::quiet_NaN(), {}});
  }

  std::size_t size() const { return result_.ends.size(); }
  std::size_t done() const { return done_; }
  /// Runs points until none is left.
  void work() {
    while (!stop_.stop_requested()) {
      const std::size_t k = next_++;
      if (k >= size()) return;
      run(k);
      ++done_;
    }
  }
  SweepResult take() {
    if (refused_ == size() && first_) throw Error(*first_);
    return std::move(result_);
  }

 private:
  void run(std::size_t k) {
    RunOptions options = request_.options;
    const std::size_t P = request_.names.size();
    for (std::size_t i = 0; i < P; ++i) options.parameters[request_.names[i]] = request_.points[k * P + i];
    options.row = [](double, std::span<const double>) {};
    SweepEnd& end = result_.ends[k];
    try {
      const Motion motion = model_.run(options, {.stop = stop_});
      end.outcome = motion.outcome;
      end.detail = motion.detail;
      end.t = motion.t;
      if (!motion.error_estimate.empty()) end.error = motion.error_estimate.back().second;
      if (motion.is_complete()) {
        for (const auto& [name, value] : motion.final) end.values.push_back(value);
      }
      const std::scoped_lock lock(mutex_);
      if (!result_.columns.empty()) return;
      for (const auto& [name, value] : motion.final) {
        result_.columns.push_back(name);
        const auto place = std::find(motion.columns.begin(), motion.columns.end(), name);
        result_.units.push_back(place == motion.columns.end()
                                    ? ""
                                    : motion.units[static_cast<std::size_t>(place - motion.columns.begin())]);
      }
    } catch (const Error& error) {
      end.outcome = "refused";
      end.detail = error.message();
      const std::scoped_lock lock(mutex_);
      ++refused_;
      if (!first_) first_ = error;
    } catch (const Interrupted&) {
    }
  }

  const Model& model_;
  const SweepRequest& request_;
  std::stop_token stop_;
  std::atomic<std::size_t> next_{0}, done_{0};
  std::mutex mutex_;
  std::size_t refused_ = 0;
  std::optional<Error> first_;
  SweepResult result_;
};

}  // namespace

SweepResult sweep(const Model& model, const SweepRequest& request, const CallControl& control) {
  Runs runs(model, request, control.stop);
  const std::size_t jobs = std::clamp<std::size_t>(request.jobs, 1, std::max<std::size_t>(runs.size(), 1));
  std::mutex mutex;
  std::condition_variable ended;
  std::size_t working = jobs;
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < jobs; ++i) {
    threads.emplace_back([&] {
      runs.work();
      const std::scoped_lock lock(mutex);
      --working;
      ended.notify_all();
    });
  }
  std::unique_lock lock(mutex);
  while (!ended.wait_for(lock, progress_interval, [&] { return working == 0; })) {
    if (!control.on_progress) continue;
    lock.unlock();
    control.on_progress(static_cast<double>(runs.done()) / static_cast<double>(runs.size()));
    lock.lock();
  }
  lock.unlock();
  threads.clear();
  return runs.take();
}

}  // namespace eomgen::python
