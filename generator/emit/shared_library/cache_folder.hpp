// SPDX-License-Identifier: GPL-3.0-or-later
// Folders from which code is loaded and run: nobody else can have put anything there.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace eomgen::emit {

/// A folder that is removed, with all in it, at the end. As long as it is there it is locked.
class Workplace {
 public:
  /// A new one of unpredictable name in `parent`, for this user alone. Throws std::system_error.
  Workplace(const std::filesystem::path& parent, const std::string& name);
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

struct CacheFolder {
  std::filesystem::path path;
  std::shared_ptr<Workplace> passing;  // where the cache cannot be trusted: for this process alone
  std::string why;                     // then
};

/// $EOMGEN_CACHE_DIR, $XDG_CACHE_HOME/eomgen, ~/.cache/eomgen, or eomgen-UID in the folder of temporary files; made if
/// it is not there. One that is a link, belongs to another user, or that others may enter, is not used: a private one
/// takes its place. Throws Error{Fault::tool}.
CacheFolder cache_folder();

/// Of this user, no link, of the kind that is expected.
bool is_own_file(const std::filesystem::path& path);
bool is_own_folder(const std::filesystem::path& path);

/// Removes the workplaces called `name` that killed runs left in a folder.
void clear_leftovers(const std::filesystem::path& folder, const std::string& name);

inline constexpr const char* workplace_name = "make-";

}  // namespace eomgen::emit
