// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/shared_library/cache_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <system_error>
#include <vector>

#include "emit/shared_library/environment.hpp"
#include "error.hpp"

namespace eomgen::emit {
namespace {

namespace fs = std::filesystem;

/// TMPDIR if it is a writable folder, else /tmp.
fs::path temporary_folder() {
  const fs::path named = environment("TMPDIR");
  return !named.empty() && ::access(named.c_str(), W_OK | X_OK) == 0 ? named : fs::path("/tmp");
}

struct RequestedFolder {
  fs::path path;
  bool by_name = true;  // a folder that this program created for itself
};

RequestedFolder requested_folder() {
  if (const std::string own = environment("EOMGEN_CACHE_DIR"); !own.empty()) return {own, false};
  if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty()) return {fs::path(xdg) / "eomgen"};
  if (const std::string home = environment("HOME"); !home.empty()) return {fs::path(home) / ".cache" / "eomgen"};
  return {temporary_folder() / ("eomgen-" + std::to_string(::geteuid()))};
}

/// The reason why other users may have written to this folder; empty if they cannot.
std::string distrust_reason(const fs::path& folder) {
  struct stat found {};
  if (::lstat(folder.c_str(), &found) != 0)
    return std::string("it cannot be looked at: ") + std::system_category().message(errno);
  if (S_ISLNK(found.st_mode)) return "it is a link";
  if (!S_ISDIR(found.st_mode)) return "it is no folder";
  if (found.st_uid != ::geteuid()) return "it belongs to another user";
  if ((found.st_mode & 0077) != 0) return fmt::format("others may enter it (mode {:o})", found.st_mode & 0777);
  struct stat parent {};
  const fs::path above = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
  if (::stat(above.c_str(), &parent) == 0 && (parent.st_mode & S_IWOTH) != 0 && (parent.st_mode & S_ISVTX) == 0) {
    return "others may put another one in its place";
  }
  return "";
}

[[noreturn]] void fail(const fs::path& folder) {
  throw Error("compile", {}, "cannot use the cache folder " + folder.string(),
              "set EOMGEN_CACHE_DIR to a folder that you may write to", ErrorKind::tool);
}

}  // namespace

ScratchFolder::ScratchFolder(const fs::path& parent, const std::string& name) {
  std::string place = (parent / (name + "XXXXXX")).string();
  if (::mkdtemp(place.data()) == nullptr)
    throw std::system_error(errno, std::generic_category(), "cannot make a folder in " + parent.string());
  path_ = place;
  lock_ = ::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (lock_ >= 0) ::flock(lock_, LOCK_EX | LOCK_NB);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

CacheFolder cache_folder() {
  const RequestedFolder requested = requested_folder();
  fs::path folder = requested.path;
  if (!folder.has_filename()) folder = folder.parent_path();  // trailing slash
  struct stat found {};
  if (::lstat(folder.c_str(), &found) != 0) {
    std::error_code failed;
    if (folder.has_parent_path()) fs::create_directories(folder.parent_path(), failed);
    if (failed || (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)) fail(folder);
  } else if (requested.by_name && S_ISDIR(found.st_mode) && found.st_uid == ::geteuid() &&
             (found.st_mode & 0022) == 0) {
    ::chmod(folder.c_str(), 0700);  // created by an earlier version: readable by others, not writable
  }
  std::string why = distrust_reason(folder);
  if (why.empty()) {
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(folder);
    return {folder, nullptr, ""};
  }
  try {
    constexpr const char* private_name = "eomgen-private-";
    clear_leftovers(temporary_folder(), private_name);
    auto scratch = std::make_shared<ScratchFolder>(temporary_folder(), private_name);
    return {scratch->path(), scratch, fmt::format("the cache folder {} is not used: {}", folder.string(), why)};
  } catch (const std::system_error&) {
    fail(temporary_folder());
  }
}

bool is_own_file(const fs::path& path) {
  struct stat found {};
  return ::lstat(path.c_str(), &found) == 0 && S_ISREG(found.st_mode) && found.st_uid == ::geteuid();
}

bool is_own_folder(const fs::path& path) { return distrust_reason(path).empty(); }

void clear_leftovers(const fs::path& folder, const std::string& name) {
  constexpr std::time_t creation_grace = 60;  // s, between creation and locking of a folder
  std::error_code none;
  std::vector<fs::path> left;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().filename().string().starts_with(name)) left.push_back(entry.path());
  }
  for (const fs::path& place : left) {
    struct stat found {};
    const int file = ::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) continue;
    const bool old = ::fstat(file, &found) == 0 && found.st_uid == ::geteuid() &&
                     std::time(nullptr) - found.st_mtime > creation_grace;
    if (old && ::flock(file, LOCK_EX | LOCK_NB) == 0) fs::remove_all(place, none);
    ::close(file);
  }
}

}  // namespace eomgen::emit
