// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/table_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <eom/output/atomic_file.hpp>
#include <system_error>
#include <utility>

#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

constexpr ::mode_t owner_only = 0600;

/// Whether a path still leads to an open file: the process that held the lock before may have removed it meanwhile.
bool leads_to(const std::string& path, int file) {
  struct stat opened {
  }, found{};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &found) == 0 && opened.st_dev == found.st_dev &&
         opened.st_ino == found.st_ino;
}

}  // namespace

TableLock::TableLock(const std::filesystem::path& table) {
  const std::string name = eom::AtomicFile::shorten_name(table.filename().string()) + ".lock";
  path_ = (table.parent_path() / name).string();
  while (true) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, owner_only);
    if (file_ < 0) throw std::system_error(errno, std::generic_category(), "cannot open " + path_);
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      ::close(std::exchange(file_, -1));
      if (reason == EINTR) continue;
      if (reason != EWOULDBLOCK) return;  // some clusters have no locks
      throw Error("sweep", {}, fmt::format("another sweep is writing {}", model::quote(table.string())),
                  "wait until it ends, or write to another file with --out");
    }
    if (leads_to(path_, file_)) return;
    ::close(std::exchange(file_, -1));
  }
}

TableLock::TableLock(TableLock&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

TableLock& TableLock::operator=(TableLock&& other) noexcept {
  if (this == &other) return *this;
  release();
  path_ = std::move(other.path_);
  file_ = std::exchange(other.file_, -1);
  return *this;
}

void TableLock::release() noexcept {
  if (file_ < 0) return;
  ::unlink(path_.c_str());  // before the lock ends, so that no other process holds the lock of a removed file
  ::close(std::exchange(file_, -1));
}

}  // namespace eomgen::cli
