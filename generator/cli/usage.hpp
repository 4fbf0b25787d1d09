// SPDX-License-Identifier: GPL-3.0-or-later
// Errors in the command name, and the help command.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {

using model::suggest_choice;

/// Throws Error if the first word is not a command. The remedy is the nearest command, or commands for a model.
void require_command(std::span<char* const> words, const std::vector<std::string>& commands);

/// Replaces `eomgen help` and `eomgen help COMMAND` by the equivalent --help.
std::vector<std::string> expand_help(std::span<char* const> words);

}  // namespace eomgen::cli
