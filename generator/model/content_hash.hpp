// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace eomgen::model {

/// The SHA-256 hash of `bytes` (FIPS 180-4) as 64 hexadecimal digits.
std::string content_hash(const std::string& bytes);

}  // namespace eomgen::model
