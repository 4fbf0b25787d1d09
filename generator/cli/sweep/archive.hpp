// SPDX-License-Identifier: GPL-3.0-or-later
// A zip archive of members that are stored as they are (PKWARE's APPNOTE 6.3, with the 64-bit fields of section 4.5.3
// throughout). In: names and sizes, then bytes of any member in any order of members. Out: the archive, with the
// checksum of each.
#pragma once

#include <cstdint>
#include <eom/output/whole_file.hpp>
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
  /// Throws std::system_error, as all here; std::invalid_argument where `path` cannot be written at any place.
  Archive(const std::string& path, std::vector<Member> members);

  /// The next bytes of a member.
  void write(std::size_t member, std::string_view bytes);
  /// Once all bytes are there.
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

  eom::WholeFile file_;
  std::vector<Member> members_;
  std::vector<Place> places_;
  std::uint64_t end_ = 0;  // of the members
};

/// CRC-32 of ISO 3309 of all bytes up to here; begins with 0.
std::uint32_t checksum(std::uint32_t before, std::string_view bytes);

}  // namespace eomgen::cli
