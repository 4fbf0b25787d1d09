// SPDX-License-Identifier: GPL-3.0-or-later
// Archives in the zip format, without compression. In: names and contents. Out: the bytes of the archive, which depend
// on nothing else: every entry has the earliest time of the format.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "emit/targets.hpp"

namespace eomgen::emit {

/// The checksum of zip and PNG (ISO 3309, reflected polynomial 0xedb88320). `before`: that of the bytes before these.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

/// Throws Error if an entry or the archive exceeds 2 GB, or there are more than 65535 entries.
std::string zip(const std::vector<EmittedFile>& files);

}  // namespace eomgen::emit
