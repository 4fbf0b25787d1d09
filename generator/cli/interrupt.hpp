// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>

#include "work.hpp"

namespace eomgen::cli {

/// Turns the first SIGINT or SIGTERM into a stop request (work.hpp). A second one terminates the program.
void install_signal_handlers();

/// While an instance exists, the command handles stop requests itself and keeps partial results. Otherwise the
/// program is terminated wherever it is.
class InterruptGuard {
 public:
  static const std::atomic<bool>& flag();

 private:
  work::DeferInterrupt kept_;
};

}  // namespace eomgen::cli
