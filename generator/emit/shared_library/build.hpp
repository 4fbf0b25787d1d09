// SPDX-License-Identifier: GPL-3.0-or-later
// Source text into a shared library, kept in a cache by content: the same source, compiler and flags are compiled once.
// The cache is that of cache_folder.hpp.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace eomgen::emit {

class Workplace;

struct Recipe {
  std::string name;                                        // of the library, without .so
  std::vector<std::pair<std::string, std::string>> files;  // name and text; the first is compiled
  std::vector<std::string> flags, libraries;
  // Which compiler: of the first variable that is set, or the first of these that runs.
  std::string language = "C", package = "gcc libc6-dev";
  std::vector<std::string> variables = {"EOMGEN_CC", "CC"}, compilers = {"cc", "gcc"};
  std::string what, remedy;                      // of the error where it fails
  const std::atomic<bool>* interrupt = nullptr;  // ends the compiler
};

struct Built {
  std::string path;                              // in the cache
  bool cached = false;                           // it was there already
  double seconds = 0;                            // of the compiler
  std::shared_ptr<const Workplace> folder = {};  // where it is kept for this process alone: as long as this is there
  std::string note = {};                         // why
};

/// `examine` sees a new library before it is kept, and throws where it is not to be. Throws Error{Fault::tool}: no
/// compiler (with the command that installs one), a failed one (with what it said).
Built build_library(const Recipe& recipe, const std::function<void(const std::string& path)>& examine = {});

}  // namespace eomgen::emit
