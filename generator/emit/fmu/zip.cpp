// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/zip.hpp"

#include <array>

#include "error.hpp"

namespace eomgen::emit {
namespace {

constexpr std::size_t largest = 0x7fffffff, most_entries = 0xffff;
constexpr std::uint16_t version = 20;  // 2.0: folders
constexpr std::uint16_t names_are_utf8 = 0x800;
constexpr std::uint16_t first_day = 0x21;  // 1980-01-01

void put16(std::string& out, std::uint32_t value) {
  out += static_cast<char>(value & 0xff);
  out += static_cast<char>(value >> 8 & 0xff);
}
void put32(std::string& out, std::uint32_t value) {
  put16(out, value & 0xffff);
  put16(out, value >> 16);
}

/// The part that the header of an entry and the directory share.
std::string description(const EmittedFile& file) {
  std::string out;
  put16(out, version);
  put16(out, names_are_utf8);
  put16(out, 0);  // stored
  put16(out, 0);  // 00:00:00
  put16(out, first_day);
  put32(out, crc32(file.text));
  put32(out, static_cast<std::uint32_t>(file.text.size()));
  put32(out, static_cast<std::uint32_t>(file.text.size()));
  put16(out, static_cast<std::uint32_t>(file.name.size()));
  put16(out, 0);  // no extra field
  return out;
}

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> result{};
    for (std::uint32_t i = 0; i < result.size(); ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value & 1) != 0 ? 0xedb88320U ^ value >> 1 : value >> 1;
      result[i] = value;
    }
    return result;
  }();
  std::uint32_t sum = ~before;
  for (const char byte : bytes) sum = table[(sum ^ static_cast<unsigned char>(byte)) & 0xff] ^ sum >> 8;
  return ~sum;
}

std::string zip(const std::vector<EmittedFile>& files) {
  std::string archive, directory;
  for (const EmittedFile& file : files) {
    if (file.text.size() > largest || archive.size() > largest || files.size() > most_entries ||
        file.name.size() > 4096)
      throw Error("emit", {}, "the archive would be too large for the zip format", "emit a smaller model");
    directory += "PK\x01\x02";
    put16(directory, version);
    directory += description(file);
    put16(directory, 0);  // no comment
    put16(directory, 0);  // one disk
    put16(directory, 0);  // internal attributes
    put32(directory, 0);  // external attributes
    put32(directory, static_cast<std::uint32_t>(archive.size()));
    directory += file.name;
    archive += "PK\x03\x04" + description(file) + file.name + file.text;
  }
  if (archive.size() > largest || directory.size() > largest)
    throw Error("emit", {}, "the archive would be too large for the zip format", "emit a smaller model");
  const std::size_t begin = archive.size();
  archive += directory + "PK\x05\x06";
  put32(archive, 0);  // one disk
  put16(archive, static_cast<std::uint32_t>(files.size()));
  put16(archive, static_cast<std::uint32_t>(files.size()));
  put32(archive, static_cast<std::uint32_t>(directory.size()));
  put32(archive, static_cast<std::uint32_t>(begin));
  put16(archive, 0);  // no comment
  return archive;
}

}  // namespace eomgen::emit
