// SPDX-License-Identifier: GPL-3.0-or-later
// Other programs, run without a shell.
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace eomgen::emit {

struct Finished {
  bool started = false;  // false: there is no such program
  int status = 0;        // of exit; 128 + signal where one ended it
  std::string output;    // of both streams
  bool interrupted = false;
};

/// `arguments[0]` is the program, searched in PATH. Nothing is read from standard input. Where `interrupt` is raised
/// meanwhile it is ended, with what it has started, and not waited for.
Finished run_process(const std::vector<std::string>& arguments, const std::atomic<bool>* interrupt = nullptr);

}  // namespace eomgen::emit
