// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace eomgen::cli {

/// Monitors the stages (work.hpp) of a command in a separate thread. After two seconds it shows the current stage on a
/// terminal. If a stage does not end soon after Ctrl-C, it exits with code 3, unless the command defers interrupts.
class StageMonitor {
 public:
  StageMonitor();
  ~StageMonitor();
  StageMonitor(const StageMonitor&) = delete;
  StageMonitor& operator=(const StageMonitor&) = delete;

 private:
  void look();
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

/// Prints on standard error that the command was interrupted. `stage`: during which stage; may be nullptr.
void print_interrupted(const char* stage);
inline constexpr int exit_interrupted = 3;

}  // namespace eomgen::cli
