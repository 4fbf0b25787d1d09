// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are there whole or not at all.
#pragma once

#include <string>
#include <system_error>
#include <vector>

#include "emit/targets.hpp"
#include "error.hpp"

namespace eomgen::emit {

/// Writes each file beside its place and renames it; makes the folder if need be. Gives the paths. Throws Error
/// {stage "emit"} that names the path and the system's reason; files already there are then untouched.
std::vector<std::string> write_files(const std::string& folder, const std::vector<EmittedFile>& files);

/// Whose fault it is that something cannot be written: a disk or a pipe that fails half-way is a tool that fails, a
/// place that cannot be written to is wrong input.
Fault fault_of_writing(const std::error_code& reason);

}  // namespace eomgen::emit
