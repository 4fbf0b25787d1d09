// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "cli/command.hpp"

namespace eomgen::cli {

/// Runs the program: parses the command line, executes the command, reports errors. Returns the exit code. `team`: the
/// group of processes that shares the work, or nullptr.
int run_program(std::span<char* const> words, const char* name, std::span<const Command> commands, ProcessGroup* group);

}  // namespace eomgen::cli
