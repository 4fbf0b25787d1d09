// SPDX-License-Identifier: GPL-3.0-or-later
// The function `declare` of each command, in a namespace of its own.
#pragma once

#include "cli/command.hpp"

namespace eomgen::cli {

using Execute = std::function<int(const CommonOptions&)>;

#define COMMAND(name, summary)       \
  namespace name##_command {         \
    Execute declare(Arguments& app); \
  }
#include "cli/commands/registry.inc"
#undef COMMAND

}  // namespace eomgen::cli
