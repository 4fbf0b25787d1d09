// SPDX-License-Identifier: GPL-3.0-or-later
// A command of the program. Each has one file in commands/ and one line in commands/registry.inc.
#pragma once

#include <functional>
#include <span>

#include "cli/arguments.hpp"
#include "error.hpp"

namespace eomgen::cli {

class ProcessGroup;

/// Options common to all commands, and the group of processes that shares the work (nullptr: a single process).
struct CommonOptions {
  bool json = false;
  std::uint64_t seed = 1;
  ProcessGroup* group = nullptr;
};

/// A command. `declare` adds its options to the parser and returns the function that executes the command and returns
/// the exit code. Results go to standard output, messages to standard error.
struct Command {
  const char* name;
  const char* summary;
  std::function<int(const CommonOptions&)> (*declare)(Arguments&);
};

std::span<const Command> commands();

}  // namespace eomgen::cli
