// SPDX-License-Identifier: GPL-3.0-or-later
// The version line of the program.
#pragma once

#include <string>

namespace eomgen::cli {

/// "eomgen 0.2.0 (commit 1a2b3c4d5e6f)"; without the commit if the source tree is no git repository. A commit that
/// ends in "+" has local changes.
std::string version_text();

}  // namespace eomgen::cli
