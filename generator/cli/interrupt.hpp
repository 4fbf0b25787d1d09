// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>

#include "work.hpp"

namespace eomgen::cli {

/// From now on Ctrl-C (and a polite kill) is a request to stop (work.hpp) in place of the end of the program; a second
/// one ends it.
void heed_signals();

/// While one exists, the command sees to the request itself, and keeps what it has; before that, it is left where it
/// is.
class Interrupt {
 public:
  static const std::atomic<bool>& flag();

 private:
  work::Kept kept_;
};

}  // namespace eomgen::cli
