// SPDX-License-Identifier: GPL-3.0-or-later
// A command of the program: one file each in commands/, one line each in registry.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "cli/arguments.hpp"
#include "error.hpp"

namespace eomgen::cli {

class Team;

/// Options that every command has; and the processes that share its work, if there are any.
struct Common {
  bool json = false;
  std::uint64_t seed = 1;
  Team* team = nullptr;
};

/// What main asks of a command: `declare` adds its options to the parser, `execute` does the work and returns the exit
/// code. Results go to standard output, everything else to standard error.
struct Command {
  const char* name;
  const char* summary;
  std::function<int(const Common&)> (*declare)(Arguments&);
};

std::span<const Command> commands();

}  // namespace eomgen::cli
