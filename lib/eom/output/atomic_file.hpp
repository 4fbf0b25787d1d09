// SPDX-License-Identifier: MIT
// A file that is written completely or not at all. In: a path, bytes. Out: the file, replaced atomically by finish().
// Bytes go to a new file with an unpredictable name beside the result, PATH.partial-XXXXXX. It is created with O_EXCL,
// so it cannot be a link planted by others, and two writers never share one. Without finish it remains, so that the
// output of a killed program can be found. Symbolic links are followed: their target is replaced, the link remains.
// Terminals, pipes, devices (/dev/full), and files open as this process's standard output or error are written to
// directly.
#pragma once

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace eom {

/// A file that is complete or absent: bytes are written to a partial file, which finish() renames.
class AtomicFile {
 public:
  /// Throws std::system_error with the path and the system's reason, like every other function here.
  explicit AtomicFile(const std::filesystem::path& path) : path_(path) {
    struct stat found {};
    const bool there = ::stat(path.c_str(), &found) == 0;
    if (there && S_ISDIR(found.st_mode)) fail("open", path_, EISDIR);
    if (there && open_for_direct_write(found)) return;
    target_ = resolve_links(path);
    const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
    partial_ = (folder / (shorten_name(target_.filename().string()) + ".partial-XXXXXX")).string();
    file_ = ::mkostemp(partial_.data(), O_CLOEXEC);
    if (file_ < 0) fail("open", path_, errno);
    if (::fchmod(file_, there ? found.st_mode & 0777 : new_file_mode()) != 0) discard_and_fail("open", errno);
  }

  /// This process's standard output, under the name "standard output".
  static AtomicFile standard_output() {
    AtomicFile file;
    file.path_ = "standard output";
    file.file_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    if (file.file_ < 0) fail("open", file.path_, errno);
    return file;
  }

  /// The moved-from object has no file.
  AtomicFile(AtomicFile&& other) noexcept
      : path_(std::move(other.path_)),
        target_(std::move(other.target_)),
        partial_(std::exchange(other.partial_, {})),
        file_(std::exchange(other.file_, -1)),
        bytes_(other.bytes_) {}
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile() {
    if (file_ >= 0) ::close(file_);
  }

  /// Appends the text. Throws std::logic_error after finish().
  void write(std::string_view text) {
    if (file_ < 0) throw std::logic_error(path_.string() + ": written to after finish");
    while (!text.empty()) {
      const ssize_t n = ::write(file_, text.data(), text.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail("write", path_, errno);
      text.remove_prefix(static_cast<std::size_t>(n));
      bytes_ += static_cast<std::uint64_t>(n);
    }
  }

  /// Renames the partial file to its final name. If that fails, the partial file remains.
  void finish() {
    if (::close(std::exchange(file_, -1)) != 0) fail("close", path_, errno);
    if (partial_.empty()) return;
    if (::rename(partial_.c_str(), target_.c_str()) != 0) fail("rename to its final name", partial_, errno);
    partial_.clear();
  }

  /// Removes the partial file.
  void discard() {
    if (file_ >= 0) ::close(std::exchange(file_, -1));
    if (!partial_.empty()) ::unlink(std::exchange(partial_, {}).c_str());
  }

  /// The path as it was given.
  const std::filesystem::path& path() const { return path_; }
  /// Path of the bytes until finish; empty if they are written directly.
  const std::string& partial() const { return partial_; }
  /// Number of bytes written.
  std::uint64_t bytes() const { return bytes_; }
  /// The descriptor of the open file; -1 after finish().
  int descriptor() const { return file_; }

  /// The target of `path` with all links followed, even if it does not exist yet.
  static std::filesystem::path resolve_links(std::filesystem::path path) {
    constexpr int most_links = 40;  // the limit of the system
    for (int links = 0;; ++links) {
      std::error_code none;
      const std::filesystem::path next = std::filesystem::read_symlink(path, none);
      if (none) return path;
      if (links == most_links) fail("open", path, ELOOP);
      path = next.is_absolute() ? next : path.parent_path() / next;
    }
  }

  /// A file name, truncated so that ".partial-XXXXXX" can be appended.
  static std::string shorten_name(const std::string& name) {
    constexpr std::size_t longest = 255 - 15;
    return name.substr(0, longest);
  }

 private:
  AtomicFile() = default;

  /// Opens a file that must not be replaced. False if it is a regular file.
  bool open_for_direct_write(const struct stat& found) {
    for (const int own : {STDOUT_FILENO, STDERR_FILENO}) {
      struct stat standard {};
      if (::fstat(own, &standard) != 0 || standard.st_dev != found.st_dev || standard.st_ino != found.st_ino) continue;
      if (S_ISCHR(found.st_mode)) continue;  // a new descriptor of the same device is equivalent
      file_ = ::fcntl(own, F_DUPFD_CLOEXEC, 3);
      if (file_ < 0) fail("open", path_, errno);
      return true;
    }
    if (S_ISREG(found.st_mode)) return false;
    do file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    while (file_ < 0 && errno == EINTR);
    if (file_ < 0) fail("open", path_, errno);
    return true;
  }

  static ::mode_t new_file_mode() {
    const ::mode_t mask = ::umask(0);
    ::umask(mask);
    return 0666 & ~mask;
  }

  [[noreturn]] void discard_and_fail(const char* action, int reason) {
    discard();
    fail(action, path_, reason);
  }
  [[noreturn]] static void fail(const char* action, const std::filesystem::path& path, int reason) {
    throw std::system_error(reason, std::generic_category(), std::string("cannot ") + action + " " + path.string());
  }

  std::filesystem::path path_, target_;
  std::string partial_;
  int file_ = -1;
  std::uint64_t bytes_ = 0;
};

}  // namespace eom
