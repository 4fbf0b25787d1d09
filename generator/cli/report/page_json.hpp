// SPDX-License-Identifier: GPL-3.0-or-later
// What a page draws and runs, as its script reads it.
#pragma once

#include "analysis/drawing/parts.hpp"
#include "analysis/page/live_model.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

Json to_json(const analysis::DrawnParts& parts);
Json to_json(const analysis::LiveStart& start);

}  // namespace eomgen::cli
