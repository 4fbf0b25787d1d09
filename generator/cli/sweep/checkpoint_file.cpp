// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/checkpoint_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "cli/output.hpp"
#include "cli/sweep/npz.hpp"
#include "emit/write_files.hpp"
#include "error.hpp"
#include "model/names.hpp"
#include "work.hpp"

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

namespace {

namespace fs = std::filesystem;

constexpr const char* mark = "# sweep: ";

[[noreturn]] void lost(const std::system_error& error) {
  throw Error("sweep", {}, error.what(),
              "see to space on that disk and to your rights there; the same command goes on from what is there",
              emit::write_fault(error.code()));
}

[[noreturn]] void refuse_columns(const std::string& path) {
  throw Error("sweep", {}, fmt::format("{} has other columns than this sweep writes", model::quote(path)),
              "write to another file with --out, or remove this one; it is kept as it is");
}

/// Opens a file that may be taken over: regular, owned by the user, not a link, and not being written.
OpenFile open_own(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return {};
  OpenFile file(descriptor);
  struct stat found {};
  if (::fstat(descriptor, &found) != 0 || !S_ISREG(found.st_mode) || found.st_uid != ::geteuid()) return {};
  // A file of `run` that is being written, or of a worker whose leader was killed. File systems of some clusters have
  // no locks, so a writer is not detected. This loses nothing: two writers have different files.
  if (::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK) return {};
  return file;
}

}  // namespace

CheckpointFile::CheckpointFile(std::string file, std::string key, IsRowOfRun is_row_of_run, Role part)
    : file_(std::move(file)), place_(file_), key_(std::move(key)), is_row_of_run_(std::move(is_row_of_run)) {
  std::error_code none;
  kept_ = !is_standard_output(file_) && (!fs::exists(file_, none) || fs::is_regular_file(file_, none));
  if (!kept_ || part == Role::member) return;
  try {
    lock_ = TableLock(eom::AtomicFile::resolve_links(file_));
    for (const Unfinished& table : unfinished()) {
      if (!table.same) {
        throw Error("sweep", {}, fmt::format("{} is the unfinished table of another sweep", model::quote(table.path)),
                    "finish that sweep with its own options, remove the file, or write to another one with --out");
      }
      read(table.path, table.file);
      taken_over_.push_back(table.path);
      place_ = table.path;
    }
    if (taken_over_.empty()) {
      if (const OpenFile done = open_own(eom::AtomicFile::resolve_links(file_).string())) read(file_, done);
    }
  } catch (const std::system_error& error) {
    lost(error);
  }
  rows_.sort();
}

std::vector<CheckpointFile::Unfinished> CheckpointFile::unfinished() const {
  const fs::path target = eom::AtomicFile::resolve_links(file_);
  const std::string name = eom::AtomicFile::shorten_name(target.filename().string()) + ".partial";
  std::vector<Unfinished> found;
  std::error_code none;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(target.has_parent_path() ? target.parent_path() : fs::path("."), none)) {
    const std::string other = entry.path().filename().string();
    if (other != name && !(other.starts_with(name + "-") && other.size() == name.size() + 7)) continue;
    const std::string path = target.has_parent_path() ? entry.path().string() : other;
    OpenFile file = open_own(path);
    if (!file) continue;  // another process is writing it
    std::string first;
    for_each_line(file, [&](std::string_view line, std::uint64_t) { return first = line, false; });
    if (first.starts_with(mark)) found.push_back({path, std::move(file), first == mark + key_});  // else of `run`
  }
  std::sort(found.begin(), found.end(), [](const Unfinished& a, const Unfinished& b) { return a.path < b.path; });
  return found;
}

void CheckpointFile::read(const std::string& path, const OpenFile& file) {
  const std::uint32_t from = rows_.add(file);
  std::size_t number = 0;
  const std::size_t tail = for_each_line(file, [&](std::string_view line, std::uint64_t offset) {
    if (number == 0 && line != mark + key_) return false;
    if (number == 1 && header_.empty()) header_ = line;
    if (number == 1 && header_ != line) refuse_columns(path);
    if (number == 1) checksum_ = RowChecksum(header_);
    if (number++ < 2) return true;
    std::size_t run = 0;
    if (is_row_of_table(line, checksum_, run) && is_row_of_run_(run, line))
      rows_.add(run, from, offset, line.size());
    else
      ++damaged_;
    return true;
  });
  if (tail > 0 && number > 0 && path == file_) ++damaged_;  // the last line of a partial file is often incomplete
}

void CheckpointFile::warn_of_damage() {
  if (damaged_ == 0 || std::exchange(warned_, true)) return;
  work::warn(format_warning({{},
                             fmt::format("{} lines of {} are no rows of this sweep: a checksum or a point differs",
                                         damaged_, model::quote(place_)),
                             "these runs are computed again; check the disk if the table was not edited"}));
}

std::string CheckpointFile::file_header() const { return mark + key_ + "\n" + header_ + "\n"; }

void CheckpointFile::write(const std::function<void(std::string_view)>& to) const {
  constexpr std::size_t enough = 1 << 20;
  to(file_header());  // immediately, because a partial file without header cannot be recognised
  std::string text;
  rows_.for_each(0, rows_.size(), [&](std::size_t, std::string_view line) {
    text.append(line);
    text += '\n';
    if (text.size() < enough) return;
    to(text);
    text.clear();
  });
  to(text);
}

void CheckpointFile::set_header(const std::string& header) try {
  if (header_ != header && rows_.size() + damaged_ > 0) refuse_columns(place_);
  header_ = header;
  checksum_ = RowChecksum(header_);
  warn_of_damage();
  if (kept_) {
    out_.emplace(file_);
    if (out_->partial().empty()) {  // the file is open as standard output
      out_.reset();
      kept_ = false;
    }
  }
  if (!kept_) {
    own_ = OpenFile::temporary();
    number_ = rows_.add(own_);
    return;
  }
  ::flock(out_->descriptor(), LOCK_EX | LOCK_NB);  // released when this process ends
  place_ = out_->partial();
  own_ = OpenFile(::fcntl(out_->descriptor(), F_DUPFD_CLOEXEC, 3));
  Rows copied;
  number_ = copied.add(own_);
  end_ = file_header().size();
  write([this](std::string_view text) { out_->write(text); });
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    copied.add(rows_.run(i), number_, end_, rows_.length(i));
    end_ += rows_.length(i) + 1;
  }
  rows_ = std::move(copied);
  remove_others();
} catch (const std::system_error& error) {
  lost(error);
}

void CheckpointFile::add(std::size_t run, const std::string& row) try {
  const std::string line = checksum_.append_to(row);
  if (out_)
    out_->write(line + "\n");
  else
    own_.write(line + "\n");
  rows_.add(run, number_, end_, line.size());
  end_ += line.size() + 1;
} catch (const std::system_error& error) {
  lost(error);
}

void CheckpointFile::whole() const try {
  if (is_npz(file_)) return write_npz(file_, mark + key_, header_, rows_);
  eom::AtomicFile file = is_standard_output(file_) ? eom::AtomicFile::standard_output() : eom::AtomicFile(file_);
  try {
    write([&file](std::string_view piece) { file.write(piece); });
    file.finish();
  } catch (const std::system_error&) {
    file.discard();  // the partial file stores the rows
    throw;
  }
} catch (const std::system_error& error) {
  lost(error);
}

void CheckpointFile::remove_others() {
  for (const std::string& old : taken_over_) ::unlink(old.c_str());
  taken_over_.clear();
}

void CheckpointFile::require_file() const {
  if (kept_) return;
  throw Error("sweep", {}, fmt::format("several processes write one file, and {} is none", model::quote(file_)),
              "name a file with --out");
}

void CheckpointFile::finish() {
  warn_of_damage();
  if (kept_ && !open()) return;  // the table was complete
  rows_.sort();
  whole();
  remove_partial_files();
}

void CheckpointFile::remove_partial_files() {
  place_ = file_;
  if (out_) out_->discard();
  remove_others();
}

void CheckpointFile::interrupt() {
  if (kept_ || header_.empty()) return;
  rows_.sort();
  whole();
}

}  // namespace eomgen::cli
