// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "cli/commands/commands.hpp"

namespace eomgen::cli {

std::span<const Command> commands() {
#define COMMAND(name, summary) Command{#name, summary, name##_command::declare},
  static constexpr std::array entries{
#include "cli/commands/registry.inc"
  };
#undef COMMAND
  return entries;
}

}  // namespace eomgen::cli
