// SPDX-License-Identifier: GPL-3.0-or-later
// The words of the options of an import, as commands and the library take them.
#pragma once

#include <string>
#include <vector>

#include "import/import.hpp"

namespace eomgen::import {

// Each throws Error with the possible words. `option`: as the user writes it.
Attitude attitude_named(const std::string& option, const std::string& word);
FrictionLaw friction_named(const std::string& option, const std::string& word);
Actuation actuation_named(const std::string& option, const std::string& word);

std::vector<std::string> attitude_words();
std::vector<std::string> friction_words();
std::vector<std::string> actuation_words();

}  // namespace eomgen::import
