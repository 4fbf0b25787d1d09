// SPDX-License-Identifier: GPL-3.0-or-later
// Folders from which code is loaded and run, to which no other user can write.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace eomgen::emit {

/// A temporary folder that is locked while it exists and removed with its contents by the destructor.
class ScratchFolder {
 public:
  /// Creates a folder with an unpredictable name in `parent`, accessible to this user only. Throws std::system_error.
  ScratchFolder(const std::filesystem::path& parent, const std::string& name);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

struct CacheFolder {
  std::filesystem::path path;
  std::shared_ptr<ScratchFolder> scratch;  // private replacement for this process if the cache is not trusted
  std::string reason;                      // reason for the replacement
};

/// The cache folder: $EOMGEN_CACHE_DIR, $XDG_CACHE_HOME/eomgen, ~/.cache/eomgen, or eomgen-UID in the temporary folder.
/// It is created if missing. A folder that is a link, belongs to another user, or is accessible to others is replaced
/// by a private one. Throws Error{ErrorKind::tool}.
CacheFolder cache_folder();

/// Whether the path belongs to this user, is not a link, and is a file or folder respectively.
bool is_own_file(const std::filesystem::path& path);
bool is_own_folder(const std::filesystem::path& path);

/// Removes folders with the prefix `name` that killed runs left behind.
void clear_leftovers(const std::filesystem::path& folder, const std::string& name);

inline constexpr const char* scratch_prefix = "make-";

}  // namespace eomgen::emit
