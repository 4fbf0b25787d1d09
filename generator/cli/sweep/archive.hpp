// SPDX-License-Identifier: GPL-3.0-or-later
// Zip archive with uncompressed members (PKWARE APPNOTE 6.3, with the 64-bit fields of section 4.5.3 throughout). In:
// names and sizes, then bytes of the members in any order. Out: the archive with a checksum of each member.
#pragma once

#include <cstdint>
#include <eom/output/atomic_file.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::cli {

class Archive {
 public:
  struct Member {
    std::string name;
    std::uint64_t bytes = 0;
  };
  /// Throws std::invalid_argument if `path` does not support writing at an offset. All members throw std::system_error.
  Archive(const std::string& path, std::vector<Member> members);

  /// Appends bytes to a member.
  void write(std::size_t member, std::string_view bytes);
  /// Writes the directory. Call it after all bytes of all members.
  void finish();
  void discard() { file_.discard(); }

 private:
  struct Place {
    std::uint64_t header, begin, next;
    std::uint32_t checksum;
  };
  std::string local_header(std::size_t member) const;
  std::string central_header(std::size_t member) const;
  void write_at(std::uint64_t offset, std::string_view bytes);

  eom::AtomicFile file_;
  std::vector<Member> members_;
  std::vector<Place> places_;
  std::uint64_t end_ = 0;  // of the members
};

}  // namespace eomgen::cli
