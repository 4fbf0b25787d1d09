// SPDX-License-Identifier: GPL-3.0-or-later
// Atomic writing of files.
#pragma once

#include <string>
#include <system_error>
#include <vector>

#include "emit/targets.hpp"
#include "error.hpp"

namespace eomgen::emit {

/// Writes each file under a temporary name and renames it; creates the folder if necessary. Returns the paths. Throws
/// Error{stage "emit"} with the path and the system's reason; existing files are then unchanged.
std::vector<std::string> write_files(const std::string& folder, const std::vector<EmittedFile>& files);

/// The fault category of a failed write: a disk or pipe that fails midway is a tool failure; a location without write
/// access is wrong input.
ErrorKind write_fault(const std::error_code& reason);

}  // namespace eomgen::emit
