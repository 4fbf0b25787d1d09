// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "program/program.hpp"

namespace eomgen::cli {

nlohmann::ordered_json to_json(const program::Operations& operations);
std::string to_text(const program::Operations& operations);

}  // namespace eomgen::cli
