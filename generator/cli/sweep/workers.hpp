// SPDX-License-Identifier: GPL-3.0-or-later
// Jobs by processes: what is loaded and derived is shared by fork, nothing else is.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace eomgen::cli {

/// `line` in a child for every job, `done` with what it returned here, in the order in which they end. A job that
/// returns an empty line, and all that its process would have done after it, is left out. Returns early when
/// `interrupt` is set. Throws Error if a process dies.
void by_processes(const std::vector<std::size_t>& jobs, std::size_t processes,
                  const std::function<std::string(std::size_t)>& line,
                  const std::function<void(std::size_t job, const std::string& line)>& done,
                  const std::atomic<bool>& interrupt);

}  // namespace eomgen::cli
