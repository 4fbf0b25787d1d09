// SPDX-License-Identifier: GPL-3.0-or-later
// Index of the rows of a sweep's table. The rows stay in files; memory holds 24 bytes per row. In: lines that begin
// with the number of their run. Out: the lines in the order of the runs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "cli/sweep/row_checksum.hpp"

namespace eomgen::cli {

/// Shared file descriptor, closed with the last copy. An unlinked file stays readable until then.
class OpenFile {
 public:
  OpenFile() = default;
  explicit OpenFile(int descriptor);
  /// Opens a temporary file without a name, which ends with the process. Throws std::system_error.
  static OpenFile temporary();

  explicit operator bool() const { return descriptor_ != nullptr; }
  int descriptor() const { return *descriptor_; }
  void write(std::string_view text) const;  // throws std::system_error
  std::uint64_t bytes() const;

 private:
  std::shared_ptr<const int> descriptor_;
};

/// Calls `take` with the lines of a file from the start until it returns false. A last line without line break is
/// skipped, and nothing is read behind a line that is longer than any row. Returns the bytes that were read of such a
/// last line.
std::size_t for_each_line(const OpenFile& file,
                          const std::function<bool(std::string_view line, std::uint64_t offset)>& take);

/// Whether a line begins with a number and has its checksum; if so, sets `run` to the number. Lines written while the
/// disk was full, and edited ones, have not.
bool is_row_of_table(std::string_view line, const RowChecksum& checksum, std::size_t& run);

class Rows {
 public:
  /// Registers a file and returns its number, for the other overload.
  std::uint32_t add(OpenFile file);
  void add(std::size_t run, std::uint32_t file, std::uint64_t offset, std::size_t length);
  /// Sorts by run and keeps the last row of each run. Required before the functions below.
  void sort();

  std::size_t size() const { return places_.size(); }
  std::size_t run(std::size_t i) const { return places_[i].run; }
  std::size_t length(std::size_t i) const { return places_[i].length; }
  /// Calls `take` with the rows in [first, last). Throws std::system_error.
  void for_each(std::size_t first, std::size_t last,
                const std::function<void(std::size_t run, std::string_view line)>& take) const;

 private:
  struct Place {
    std::uint64_t run, offset;
    std::uint32_t length, file;
  };
  std::vector<Place> places_;
  std::vector<OpenFile> files_;
};

}  // namespace eomgen::cli
