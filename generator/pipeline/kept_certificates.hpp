// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates that were positive, by all that they depend on: the next command for the same model does not pay for
// them again. They lie in the folder of compiled code, which is this user's alone. `verify` compares anew each time.
#pragma once

#include <optional>
#include <string>

#include "verify/certificate.hpp"

namespace eomgen::pipeline {

/// Of everything that is not the model: this program itself, as it lies on the disk.
std::string program_identity();

/// Nothing where there is none, or it cannot be read.
std::optional<verify::Certificate> kept_certificate(const std::string& key);

/// Only where it is positive and whole. That it cannot be written is no error.
void keep_certificate(const std::string& key, const verify::Certificate& certificate);

}  // namespace eomgen::pipeline
