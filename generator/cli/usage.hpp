// SPDX-License-Identifier: GPL-3.0-or-later
// The command line as the user typed it: commands that are not there, and help.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {

using model::choice_of;

/// Throws Error where the first word is no command: with the nearest one, or with what can be done with a model.
void require_command(std::span<char* const> words, const std::vector<std::string>& commands);

/// `eomgen help` and `eomgen help COMMAND` as --help has them.
std::vector<std::string> with_help(std::span<char* const> words);

}  // namespace eomgen::cli
