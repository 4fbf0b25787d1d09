// SPDX-License-Identifier: GPL-3.0-or-later
// The registry of targets: one file and one line per target (docs/adding-a-target.md).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "emit/context.hpp"
#include "program/program.hpp"
#include "results.hpp"

namespace eomgen::emit {

using EmittedFile = SourceFile;

struct TargetEntry {
  const char* name;
  const char* title;
  std::vector<EmittedFile> (*emit)(const program::Program&, const EmissionContext&);
  std::string (*mangle)(const std::string& id);  // NAME of files and symbols, from the model's id
  bool integrates = false;     // its files set starts and integrate: they need start, events and resets
  bool can_set_starts = true;  // whether --with start has a form in it
};

std::span<const TargetEntry> targets();
std::vector<std::string> target_names();
/// nullptr if there is no target of this name, as for archives.
const TargetEntry* find_target(const std::string& name);

/// Emits the sources for `target`. Throws Error with the list of known targets if it is unknown.
std::vector<EmittedFile> emit(const program::Program& program, const EmissionContext& context,
                              const std::string& target = "cpp");

}  // namespace eomgen::emit
