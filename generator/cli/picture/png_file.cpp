// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/picture/png_file.hpp"

#include <algorithm>
#include <array>

namespace eomgen::cli {
namespace {

std::uint32_t crc(const std::string& bytes) {
  std::uint32_t value = 0xffffffffu;
  for (const char c : bytes) {
    value ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? 0xedb88320u : 0);
  }
  return ~value;
}

std::string big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24 & 0xff), static_cast<char>(value >> 16 & 0xff),
          static_cast<char>(value >> 8 & 0xff), static_cast<char>(value & 0xff)};
}

std::string chunk(const std::string& type, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(crc(type + data));
}

/// DEFLATE (RFC 1951) encoder: one block with fixed codes; the only matches are repetitions of one byte.
class Deflate {
 public:
  std::string operator()(const std::string& bytes) {
    put(1, 1);  // the last block
    put(1, 2);  // fixed code
    for (std::size_t i = 0; i < bytes.size();) {
      std::size_t run = 0;
      while (i > 0 && i + run < bytes.size() && run < longest && bytes[i + run] == bytes[i - 1]) ++run;
      if (run < shortest) {
        literal(static_cast<std::uint8_t>(bytes[i++]));
        continue;
      }
      match(run);
      i += run;
    }
    symbol(end_of_block);
    if (count_ > 0) out_ += static_cast<char>(held_);
    return std::move(out_);
  }

 private:
  static constexpr std::size_t shortest = 3, longest = 258;
  static constexpr unsigned end_of_block = 256;

  void put(unsigned value, unsigned bits) {  // least significant bit first
    for (unsigned k = 0; k < bits; ++k) {
      held_ |= (value >> k & 1) << count_;
      if (++count_ < 8) continue;
      out_ += static_cast<char>(held_);
      held_ = count_ = 0;
    }
  }
  void code(unsigned value, unsigned bits) {  // codes are packed from the most significant bit
    for (unsigned k = bits; k-- > 0;) put(value >> k & 1, 1);
  }
  void symbol(unsigned s) {
    if (s < 144)
      code(0x30 + s, 8);
    else if (s < 256)
      code(0x190 + s - 144, 9);
    else if (s < 280)
      code(s - 256, 7);
    else
      code(0xc0 + s - 280, 8);
  }
  void literal(std::uint8_t byte) { symbol(byte); }
  void match(std::size_t length) {
    // Symbols 257 .. 285: eight lengths without extra bits, then groups of four with 1 .. 5 extra bits.
    if (length == longest) {
      symbol(285);
    } else if (length < 11) {
      symbol(static_cast<unsigned>(254 + length));
    } else {
      unsigned extra = 1;
      std::size_t base = 11;
      while (length >= base + (std::size_t{4} << extra)) base += std::size_t{4} << extra, ++extra;
      const std::size_t off = length - base;
      symbol(static_cast<unsigned>(261 + 4 * extra + (off >> extra)));
      put(static_cast<unsigned>(off & ((std::size_t{1} << extra) - 1)), extra);
    }
    code(0, 5);  // distance 1
  }

  std::string out_;
  unsigned held_ = 0, count_ = 0;
};

std::uint32_t adler(const std::string& bytes) {
  std::uint32_t a = 1, b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

}  // namespace

std::string encode_png(const Picture& picture) {
  constexpr char above = 2;  // the filter: differences to the row above
  const std::size_t row = 3 * picture.width;
  std::string filtered;
  filtered.reserve((row + 1) * picture.height);
  for (std::size_t y = 0; y < picture.height; ++y) {
    filtered += above;
    for (std::size_t i = 0; i < row; ++i) {
      const std::uint8_t before = y > 0 ? picture.rgb[(y - 1) * row + i] : 0;
      filtered += static_cast<char>(static_cast<std::uint8_t>(picture.rgb[y * row + i] - before));
    }
  }
  const std::string header = big_endian(static_cast<std::uint32_t>(picture.width)) +
                             big_endian(static_cast<std::uint32_t>(picture.height)) +
                             std::string("\x08\x02\x00\x00\x00", 5);
  return std::string("\x89PNG\r\n\x1a\n", 8) + chunk("IHDR", header) +
         chunk("IDAT", "\x78\x01" + Deflate()(filtered) + big_endian(adler(filtered))) + chunk("IEND", "");
}

}  // namespace eomgen::cli
