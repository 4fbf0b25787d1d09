// SPDX-License-Identifier: GPL-3.0-or-later
// A cache of positive certificates, with a key of everything that they depend on: the next command for the same model
// need not verify again. It is in the user's private folder of compiled code. `verify` does not use it.
#pragma once

#include <optional>
#include <string>

#include "verify/certificate.hpp"

namespace eomgen::pipeline {

/// Identifies everything except the model: the file of this program.
std::string program_identity();

/// The cached certificate; nothing if there is none, or it cannot be read.
std::optional<verify::Certificate> load_certificate(const std::string& key);

/// Stores a certificate if it is positive and complete. A failure to write is no error.
void store_certificate(const std::string& key, const verify::Certificate& certificate);

}  // namespace eomgen::pipeline
