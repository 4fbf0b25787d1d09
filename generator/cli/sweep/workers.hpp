// SPDX-License-Identifier: GPL-3.0-or-later
// Runs jobs in forked child processes, which share the loaded and derived data of the parent.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace eomgen::cli {

/// Calls `line` for every job in a child process, and `done` with the result in this process, in the order of
/// completion. If a job returns an empty line, it and the remaining jobs of its process are skipped. Returns early if
/// `interrupt` is set. Throws Error if a process dies.
void run_in_processes(const std::vector<std::size_t>& jobs, std::size_t processes,
                      const std::function<std::string(std::size_t)>& line,
                      const std::function<void(std::size_t job, const std::string& line)>& done,
                      const std::atomic<bool>& interrupt);

}  // namespace eomgen::cli
