// SPDX-License-Identifier: GPL-3.0-or-later
// Compiles source text to a shared library. The cache (cache_folder.hpp) is keyed by content: the same source, compiler
// and flags are compiled once.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace eomgen::emit {

class ScratchFolder;

struct Recipe {
  std::string name;                                        // name of the library without its suffix
  std::vector<std::pair<std::string, std::string>> files;  // name and text; the first file is compiled
  std::string suffix = ".so";
  bool uses_own_headers = false;  // the folder of the files is searched for headers, and its path enters no result
  std::vector<std::string> flags, libraries;
  std::vector<std::string> objects;  // names of object files among the files, which are linked as well
  // The compiler: the value of the first variable that is set, or the first of these that runs.
  std::string language = "C", package = "gcc libc6-dev";
  std::vector<std::string> variables = {"EOMGEN_CC", "CC"}, compilers = {"cc", "gcc"};
  std::string what, remedy;                      // parts of the error message on failure
  const std::atomic<bool>* interrupt = nullptr;  // terminates the compiler
};

struct BuiltLibrary {
  std::string path;     // path of the library in the cache
  bool cached = false;  // true if it was cached already
  double seconds = 0;   // time of the compiler
  std::shared_ptr<const ScratchFolder> folder =
      {};                 // private folder of this process, which lives as long as this pointer
  std::string note = {};  // reason for the private folder
};

/// Builds a library or finds it in the cache. `examine` is called on a new library before it enters the cache and
/// throws to reject it. Throws Error{ErrorKind::tool}: no compiler (with the install command), or a compiler failure
/// (with its output).
BuiltLibrary build_library(const Recipe& recipe, const std::function<void(const std::string& path)>& examine = {});

/// The reason why no compiler of the recipe runs; empty if one does.
std::string compiler_refusal(const Recipe& recipe = {});

}  // namespace eomgen::emit
