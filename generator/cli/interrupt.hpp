// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>

namespace eomgen::cli {

/// While one exists, Ctrl-C (and a polite kill) raises a flag in place of ending the program; a second one ends it.
/// Before there is one, Ctrl-C ends the program: nothing is lost that would have to be kept.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  static const std::atomic<bool>& flag();
};

}  // namespace eomgen::cli
