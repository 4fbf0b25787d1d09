// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stage_monitor.hpp"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "work.hpp"

namespace eomgen::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds interval{25}, patience{100};
constexpr std::chrono::seconds quiet{2};

// Does not allocate, because the process may fork while this runs.
void write_error(const char* text) {
  const ssize_t ignored = write(STDERR_FILENO, text, std::strlen(text));
  (void)ignored;
}

}  // namespace

void print_interrupted(const char* stage) {
  char text[160];
  std::snprintf(text, sizeof text, "interrupted%s%s\n", stage != nullptr ? " while " : "",
                stage != nullptr ? stage : "");
  write_error(text);
}

StageMonitor::StageMonitor() {
  // Signals are delivered to the main thread.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    thread_ = std::thread([this] { look(); });
  } catch (const std::system_error&) {  // a system without threads, or without another one: nothing is shown
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

StageMonitor::~StageMonitor() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  ended_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void StageMonitor::look() {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const Clock::time_point start = Clock::now();
  Clock::time_point asked{}, shown = start;
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, interval, [this] { return end_; })) {
    const Clock::time_point now = Clock::now();
    const char* stage = work::current_stage();
    if (!work::stop_requested())
      asked = {};
    else if (asked == Clock::time_point{})
      asked = now;
    else if (now - asked > patience) {
      work::clear_line();
      print_interrupted(stage);
      _exit(exit_interrupted);
    }
    if (terminal && stage != nullptr && now - start > quiet && now - shown > std::chrono::milliseconds(200)) {
      char text[160];
      std::snprintf(text, sizeof text, "%s, %.0f s", stage, std::chrono::duration<double>(now - start).count());
      work::show_line(text);
      shown = now;
    }
  }
}

}  // namespace eomgen::cli
