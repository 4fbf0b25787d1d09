// SPDX-License-Identifier: GPL-3.0-or-later
// Execution of other programs without a shell.
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace eomgen::emit {

struct ProcessResult {
  bool started = false;  // false: the program was not found
  int status = 0;        // exit status; 128 + signal after a signal
  std::string output;    // standard output and standard error
  bool interrupted = false;
};

/// Whether this system starts programs at all.
bool can_start_programs();

/// Runs `arguments[0]`, which is searched in PATH. Standard input is empty. If `interrupt` is set meanwhile, the
/// process and its children are terminated.
ProcessResult run_process(const std::vector<std::string>& arguments, const std::atomic<bool>* interrupt = nullptr);

}  // namespace eomgen::emit
