// SPDX-License-Identifier: GPL-3.0-or-later
// For systems that cannot fork, such as WebAssembly: the jobs run one after another.
#include "cli/sweep/workers.hpp"

namespace eomgen::cli {

void run_in_processes(const std::vector<std::size_t>& jobs, std::size_t,
                      const std::function<std::string(std::size_t)>& line,
                      const std::function<void(std::size_t, const std::string&)>& done,
                      const std::atomic<bool>& interrupt) {
  for (const std::size_t job : jobs) {
    const std::string text = interrupt ? std::string() : line(job);
    if (text.empty()) return;
    done(job, text);
  }
}

}  // namespace eomgen::cli
