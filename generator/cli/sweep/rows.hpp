// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a sweep's table, in files: memory holds the place of each, 24 bytes, whatever its length. In: lines that
// begin with the number of their run. Out: the lines in the order of the runs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::cli {

/// An open file; closed when the last copy is gone. What was unlinked is read until then.
class OpenFile {
 public:
  OpenFile() = default;
  explicit OpenFile(int descriptor);
  /// A file without a name, for what is kept while the process is there. Throws std::system_error.
  static OpenFile unnamed();

  explicit operator bool() const { return descriptor_ != nullptr; }
  int descriptor() const { return *descriptor_; }
  void write(std::string_view text) const;  // throws std::system_error
  std::uint64_t bytes() const;

 private:
  std::shared_ptr<const int> descriptor_;
};

/// The lines of a file from its beginning, as long as `take` wants them; the last one only if it ends with a line
/// break.
void each_line(const OpenFile& file, const std::function<bool(std::string_view line, std::uint64_t offset)>& take);

/// The number of the run that a line begins with, if it has as many fields as `header`: what was written while a disk
/// was full has not.
bool reads_as_row(std::string_view line, std::string_view header, std::size_t& run);

class Rows {
 public:
  /// Rows of this file are added with the number that it gives.
  std::uint32_t add(OpenFile file);
  void add(std::size_t run, std::uint32_t file, std::uint64_t offset, std::size_t length);
  /// Puts them in order; of those of one run the last stays. Before what follows.
  void sort();

  std::size_t size() const { return places_.size(); }
  std::size_t run(std::size_t i) const { return places_[i].run; }
  std::size_t length(std::size_t i) const { return places_[i].length; }
  /// Those from `first` to before `last`. Throws std::system_error.
  void each(std::size_t first, std::size_t last,
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
