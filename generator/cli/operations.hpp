// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cli/json.hpp"
#include "program/program.hpp"

namespace eomgen::cli {

Json to_json(const program::Operations& operations);
std::string to_text(const program::Operations& operations);

}  // namespace eomgen::cli
