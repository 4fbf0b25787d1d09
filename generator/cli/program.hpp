// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "cli/command.hpp"

namespace eomgen::cli {

/// The whole program: reads its words, calls the command that they name, tells what went wrong. Returns the exit code.
/// `team`: as Common has it.
int run_program(std::span<char* const> words, const char* name, std::span<const Command> commands, Team* team);

}  // namespace eomgen::cli
