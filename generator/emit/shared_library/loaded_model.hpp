// SPDX-License-Identifier: GPL-3.0-or-later
// In: emitted C. Out: its functions, compiled and loaded. Libraries are cached by content: the same source, compiler
// and flags are compiled once.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "abi/compiled.hpp"

namespace eomgen::emit {

/// The functions of the C ABI (docs/abi.md); null if a function was not requested. The destructor unloads the library.
class LoadedModel : public abi::CompiledFunctions {
 public:
  /// `name`: NAME of the symbols. `path`: a shared library. Throws Error{ErrorKind::tool} if it cannot be loaded, has
  /// another ABI, or fails its self-test.
  LoadedModel(const std::string& path, const std::string& name);
  ~LoadedModel();
  LoadedModel(LoadedModel&& other) noexcept;
  LoadedModel& operator=(LoadedModel&& other) noexcept;
  LoadedModel(const LoadedModel&) = delete;
  LoadedModel& operator=(const LoadedModel&) = delete;

  void (*defaults)(double* x, double* p) = nullptr;
  std::string info;  // JSON

 private:
  void* handle_ = nullptr;
};

class ScratchFolder;

struct CompiledModel {
  LoadedModel model;
  std::string path;                                  // path of the library in the cache
  bool cached = false;                               // true if it was cached already
  double seconds = 0;                                // time of the compiler
  std::shared_ptr<const ScratchFolder> folder = {};  // private folder of this process, if used
  std::string note = {};                             // reason for the private folder
};

/// Compiles `c_source` (NAME.c; `header` is NAME.h) into the cache, unless an intact entry exists, and loads it. The
/// cache: $EOMGEN_CACHE_DIR, $XDG_CACHE_HOME/eomgen or ~/.cache/eomgen. The compiler: $EOMGEN_CC, $CC, cc or gcc.
/// Throws Error{ErrorKind::tool}: no compiler (with the install command), or a compiler failure (with its output).
/// `interrupt` terminates the compiler.
CompiledModel compile_and_load(const std::string& c_source, const std::string& header, const std::string& name,
                               const std::atomic<bool>* interrupt = nullptr);

}  // namespace eomgen::emit
