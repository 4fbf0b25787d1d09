// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>

namespace eomgen::cli {

/// While one exists, Ctrl-C (and a polite kill) raises a flag in place of ending the program; a second one ends it.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  const std::atomic<bool>* flag() const;
};

}  // namespace eomgen::cli
