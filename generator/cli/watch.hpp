// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace eomgen::cli {

/// Looks at the stages (work.hpp) of a command from a thread of its own: after two seconds a terminal is told which one
/// is under way, and what does not end soon after Ctrl-C is left with the exit code 3, unless something is kept.
class Watch {
 public:
  Watch();
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  void look();
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

/// What an interrupted command says on standard error.
void tell_interrupted(const char* stage);
inline constexpr int exit_interrupted = 3;

}  // namespace eomgen::cli
