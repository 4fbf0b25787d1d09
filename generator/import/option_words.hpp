// SPDX-License-Identifier: GPL-3.0-or-later
// The words of the options of an import, as commands and the library take them.
#pragma once

#include <string>
#include <vector>

#include "import/import.hpp"
#include "results.hpp"

namespace eomgen::import {

/// Throws Error with the possible words. `prefix`: what the user writes before the name of an option.
ImportOptions import_options(const RobotOptions& options, const std::string& prefix = "");

std::vector<std::string> attitude_words();
std::vector<std::string> friction_words();
std::vector<std::string> actuation_words();

}  // namespace eomgen::import
