// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are there whole or not at all.
#pragma once

#include <string>
#include <vector>

#include "emit/targets.hpp"

namespace eomgen::emit {

/// Writes each file beside its place and renames it; makes the folder if need be. Gives the paths. Throws Error
/// {stage "emit", Fault::tool} that names the path and the system's reason; files already there are then untouched.
std::vector<std::string> write_files(const std::string& folder, const std::vector<EmittedFile>& files);

}  // namespace eomgen::emit
