// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace eomgen::model {

/// SHA-256 of some bytes (FIPS 180-4), 64 hexadecimal digits.
std::string content_hash(const std::string& bytes);

}  // namespace eomgen::model
