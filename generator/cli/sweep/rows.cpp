// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/rows.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <system_error>

namespace eomgen::cli {
namespace {

[[noreturn]] void fail(const char* what, int reason) { throw std::system_error(reason, std::generic_category(), what); }

/// Reads up to `count` bytes and returns their number.
std::size_t read_at(int file, char* to, std::size_t count, std::uint64_t offset) {
  std::size_t there = 0;
  while (there < count) {
    const ssize_t n = ::pread(file, to + there, count - there, static_cast<off_t>(offset + there));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("cannot read a table", errno);
    if (n == 0) break;
    there += static_cast<std::size_t>(n);
  }
  return there;
}

}  // namespace

OpenFile::OpenFile(int descriptor)
    : descriptor_(new int(descriptor), [](const int* held) {
        ::close(*held);
        delete held;
      }) {}

OpenFile OpenFile::temporary() {
  std::string path = (std::filesystem::temp_directory_path() / "eomgen-XXXXXX").string();
  const int file = ::mkostemp(path.data(), O_CLOEXEC);
  if (file < 0) fail(("cannot open " + path).c_str(), errno);
  ::unlink(path.c_str());
  return OpenFile(file);
}

void OpenFile::write(std::string_view text) const {
  while (!text.empty()) {
    const ssize_t n = ::write(descriptor(), text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("cannot write to the folder for temporary files (TMPDIR)", errno);
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

std::uint64_t OpenFile::bytes() const {
  struct stat found {};
  if (::fstat(descriptor(), &found) != 0) fail("cannot read a table", errno);
  return static_cast<std::uint64_t>(found.st_size);
}

std::size_t for_each_line(const OpenFile& file, const std::function<bool(std::string_view, std::uint64_t)>& take) {
  constexpr std::size_t piece = 1 << 18, longest = 1 << 22;  // a model of 10^5 columns has rows of 2.5 MB
  std::string text;
  std::uint64_t at = 0;  // file offset of the start of `text`
  for (bool more = true; more;) {
    const std::size_t held = text.size();
    text.resize(held + piece);
    const std::size_t got = read_at(file.descriptor(), text.data() + held, piece, at + held);
    text.resize(held + got);
    if (got == 0) return held;
    std::size_t begin = 0;
    for (std::size_t end; more && (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
      more = take(std::string_view(text).substr(begin, end - begin), at + begin);
    }
    text.erase(0, begin);
    at += begin;
    if (more && text.size() > longest) return text.size();
  }
  return 0;
}

bool is_row_of_table(std::string_view line, const RowChecksum& checksum, std::size_t& run) {
  const auto [stop, error] = std::from_chars(line.data(), line.data() + line.size(), run);
  return error == std::errc() && stop != line.data() + line.size() && *stop == ',' && checksum.holds(line);
}

std::uint32_t Rows::add(OpenFile file) {
  files_.push_back(std::move(file));
  return static_cast<std::uint32_t>(files_.size() - 1);
}

void Rows::add(std::size_t run, std::uint32_t file, std::uint64_t offset, std::size_t length) {
  places_.push_back({run, offset, static_cast<std::uint32_t>(length), file});
}

void Rows::sort() {
  std::stable_sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.run < b.run; });
  const auto same = [](const Place& a, const Place& b) { return a.run == b.run; };
  const auto first = std::unique(places_.rbegin(), places_.rend(), same);  // reversed, so the last of equal rows stays
  places_.erase(places_.begin(), first.base());
}

void Rows::for_each(std::size_t first, std::size_t last,
                    const std::function<void(std::size_t, std::string_view)>& take) const {
  constexpr std::size_t piece = 1 << 14;
  std::string held;  // a block of one file, since neighbouring rows are mostly adjacent
  std::uint32_t file = 0;
  std::uint64_t from = 0;
  for (std::size_t i = first; i < last; ++i) {
    const Place& place = places_[i];
    if (held.empty() || place.file != file || place.offset < from || place.offset + place.length > from + held.size()) {
      file = place.file;
      from = place.offset;
      held.resize(std::max<std::size_t>(piece, place.length));
      held.resize(read_at(files_[file].descriptor(), held.data(), held.size(), from));
      if (held.size() < place.length) fail("a table became shorter while it was read", EIO);
    }
    take(place.run, std::string_view(held).substr(place.offset - from, place.length));
  }
}

}  // namespace eomgen::cli
