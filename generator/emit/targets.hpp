// SPDX-License-Identifier: GPL-3.0-or-later
// The registry of targets: one file and one line per target (docs/adding-a-target.md).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "emit/context.hpp"
#include "program/program.hpp"

namespace eomgen::emit {

struct EmittedFile {
  std::string name;  // without a folder
  std::string text;
};

struct TargetEntry {
  const char* name;
  const char* title;
  std::vector<EmittedFile> (*emit)(const program::Program&, const EmissionContext&);
  std::string (*mangle)(const std::string& id);  // NAME of files and symbols, from the model's id
};

std::span<const TargetEntry> targets();
std::vector<std::string> target_names();

/// Emits the sources for `target`. Throws Error with the list of known targets if it is unknown.
std::vector<EmittedFile> emit(const program::Program& program, const EmissionContext& context,
                              const std::string& target = "cpp");

}  // namespace eomgen::emit
