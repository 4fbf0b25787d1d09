// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/icon.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "emit/fmu/zip.hpp"

namespace eomgen::emit {
namespace {

constexpr int size = 64;

/// Distance of a point from the segment between two points.
double distance(double x, double y, double x0, double y0, double x1, double y1) {
  const double dx = x1 - x0, dy = y1 - y0;
  const double s = std::clamp(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(x - x0 - s * dx, y - y0 - s * dy);
}

/// White outside of the lines, black inside; grey within half a pixel of their edge.
unsigned char shade(double x, double y) {
  const double inside = std::max(
      {2.5 - distance(x, y, 8, 8, 56, 8), 2.0 - distance(x, y, 32, 8, 48, 44), 9.0 - std::hypot(x - 48, y - 44)});
  return static_cast<unsigned char>(std::lround(255 * std::clamp(0.5 - inside, 0.0, 1.0)));
}

void put_big_endian(std::string& out, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(value >> shift & 0xff);
}

std::string chunk(const std::string& type, const std::string& data) {
  std::string out;
  put_big_endian(out, static_cast<std::uint32_t>(data.size()));
  out += type + data;
  put_big_endian(out, crc32(type + data));
  return out;
}

/// One stored block of deflate in a zlib stream.
std::string stored(const std::string& bytes) {
  std::uint32_t a = 1, b = 0;
  for (const char byte : bytes) {
    a = (a + static_cast<unsigned char>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  const auto length = static_cast<std::uint32_t>(bytes.size());
  std::string out = "\x78\x01\x01";
  for (const std::uint32_t part : {length, ~length}) {
    out += static_cast<char>(part & 0xff);
    out += static_cast<char>(part >> 8 & 0xff);
  }
  out += bytes;
  put_big_endian(out, b << 16 | a);
  return out;
}

}  // namespace

std::string icon_png() {
  std::string header, pixels;
  put_big_endian(header, size);
  put_big_endian(header, size);
  header += std::string("\x08\x00\x00\x00\x00", 5);  // 8 bits of grey
  for (int row = 0; row < size; ++row) {
    pixels += '\0';  // no filter
    for (int column = 0; column < size; ++column) pixels += static_cast<char>(shade(column + 0.5, row + 0.5));
  }
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", stored(pixels)) + chunk("IEND", "");
}

}  // namespace eomgen::emit
