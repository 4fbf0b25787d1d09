// SPDX-License-Identifier: GPL-3.0-or-later
// Archives in the zip format, without compression. In: names and contents. Out: an archive that depends on nothing
// else: every entry has the earliest time of the format.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "emit/targets.hpp"

namespace eomgen::emit {

/// Writes an archive entry by entry. All members throw std::system_error, with `name` in its text.
class ZipWriter {
 public:
  /// Owns `stream`, which is seekable and empty.
  ZipWriter(std::FILE* stream, std::string name);
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;
  ~ZipWriter();

  /// Starts an entry of `bytes` bytes.
  void start(const std::string& entry, std::uint64_t bytes);
  /// Appends to the entry.
  void write(std::string_view bytes);
  void finish();

 private:
  void require(int status) const;

  std::string name_;
  void* archive_;
};

std::string zip(const std::vector<EmittedFile>& files);

}  // namespace eomgen::emit
