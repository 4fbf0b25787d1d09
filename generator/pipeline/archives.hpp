// SPDX-License-Identifier: GPL-3.0-or-later
// The registry of targets that are archives: emitted sources with what compilers make of them, in one file. In: a
// program with all functions that the archive requires. Out: its file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "emit/targets.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

/// Material of an archive. The context has the run and the start of the default scene.
struct ArchiveContents {
  const DerivedModel& derived;
  const program::Program& program;
  const emit::EmissionContext& context;
  int version;  // of its format
};

struct Archive {
  const char* name;
  const char* title;
  std::span<const char* const> required;  // of emitted_functions(); those of inputs only if there are inputs
  std::span<const int> versions;          // of its format, the default first
  std::vector<emit::EmittedFile> (*make)(const ArchiveContents& contents);
};

/// The importer of an archive sets all inputs, so those of the scene do not belong to it.
std::span<const Archive> archives();
/// Null if the target is none.
const Archive* find_archive(const std::string& name);

/// Names of emit::targets() and of archives().
std::vector<std::string> target_names();

}  // namespace eomgen::pipeline
