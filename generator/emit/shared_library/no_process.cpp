// SPDX-License-Identifier: GPL-3.0-or-later
// For systems that start no programs, such as WebAssembly: every compiler is missing.
#include "emit/shared_library/process.hpp"

namespace eomgen::emit {

bool can_start_programs() { return false; }

ProcessResult run_process(const std::vector<std::string>&, const std::atomic<bool>*) { return {}; }

}  // namespace eomgen::emit
