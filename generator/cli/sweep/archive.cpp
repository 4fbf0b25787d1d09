// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/archive.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "emit/fmu/zip.hpp"

namespace eomgen::cli {
namespace {

constexpr std::uint16_t version = 45;  // required to read 64-bit fields
constexpr std::uint16_t utf8_names = 0x800;
constexpr std::uint16_t first_day = 0x21;        // 1 January 1980, so equal runs give equal bytes
constexpr std::uint32_t elsewhere = 0xffffffff;  // the value is in the 64-bit fields

/// Little-endian on any machine.
template <class T>
void put(std::string& text, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) text += static_cast<char>(value >> (8 * i) & 0xff);
}

/// The part that the header of a member and the directory share.
std::string described(const std::string& name, std::uint32_t checksum) {
  std::string text;
  for (const std::uint16_t value : {version, utf8_names, std::uint16_t{0}, std::uint16_t{0}, first_day})
    put(text, value);
  for (const std::uint32_t value : {checksum, elsewhere, elsewhere}) put(text, value);
  put(text, static_cast<std::uint16_t>(name.size()));
  return text;
}

}  // namespace

Archive::Archive(const std::string& path, std::vector<Member> members) : file_(path), members_(std::move(members)) {
  if (file_.partial().empty()) throw std::invalid_argument("an archive is written at many places, and this is no file");
  for (std::size_t i = 0; i < members_.size(); ++i) {
    places_.push_back({end_, 0, 0, 0});
    places_[i].begin = places_[i].next = end_ + local_header(i).size();
    end_ = places_[i].begin + members_[i].bytes;
  }
}

std::string Archive::local_header(std::size_t i) const {
  std::string text;
  put<std::uint32_t>(text, 0x04034b50);
  text += described(members_[i].name, places_[i].checksum);
  put<std::uint16_t>(text, 20);
  text += members_[i].name;
  put<std::uint16_t>(text, 1);
  put<std::uint16_t>(text, 16);
  put(text, members_[i].bytes);
  put(text, members_[i].bytes);
  return text;
}

std::string Archive::central_header(std::size_t i) const {
  std::string text;
  put<std::uint32_t>(text, 0x02014b50);
  put<std::uint16_t>(text, 3 << 8 | version);  // file attributes of Unix
  text += described(members_[i].name, places_[i].checksum);
  put<std::uint16_t>(text, 28);
  for (int unused = 0; unused < 3; ++unused) put<std::uint16_t>(text, 0);
  put<std::uint32_t>(text, 0100644U << 16);
  put(text, elsewhere);
  text += members_[i].name;
  put<std::uint16_t>(text, 1);
  put<std::uint16_t>(text, 24);
  put(text, members_[i].bytes);
  put(text, members_[i].bytes);
  put(text, places_[i].header);
  return text;
}

void Archive::write_at(std::uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(file_.descriptor(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw std::system_error(errno, std::generic_category(), "cannot write " + file_.path().string());
    bytes.remove_prefix(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

void Archive::write(std::size_t member, std::string_view bytes) {
  Place& place = places_[member];
  if (place.next + bytes.size() > place.begin + members_[member].bytes)
    throw std::logic_error("more bytes than a member of the archive has");
  write_at(place.next, bytes);
  place.next += bytes.size();
  place.checksum = emit::crc32(bytes, place.checksum);
}

void Archive::finish() {
  std::string directory;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (places_[i].next != places_[i].begin + members_[i].bytes)
      throw std::logic_error("fewer bytes than a member of the archive has");
    write_at(places_[i].header, local_header(i));
    directory += central_header(i);
  }
  const std::uint64_t size = directory.size(), count = members_.size(), end = end_ + size;
  put<std::uint32_t>(directory, 0x06064b50);  // 64-bit end of the central directory
  put<std::uint64_t>(directory, 44);
  put(directory, version);
  put(directory, version);
  put<std::uint64_t>(directory, 0);
  for (const std::uint64_t value : {count, count, size, end_}) put(directory, value);
  put<std::uint32_t>(directory, 0x07064b50);  // locator of that record
  put<std::uint32_t>(directory, 0);
  put(directory, end);
  put<std::uint32_t>(directory, 1);
  put<std::uint32_t>(directory, 0x06054b50);  // 32-bit end of the central directory
  put<std::uint32_t>(directory, 0);
  const auto few = static_cast<std::uint16_t>(std::min<std::uint64_t>(count, 0xffff));
  put(directory, few);
  put(directory, few);
  put(directory, elsewhere);
  put(directory, elsewhere);
  put<std::uint16_t>(directory, 0);
  write_at(end_, directory);
  file_.finish();
}

}  // namespace eomgen::cli
