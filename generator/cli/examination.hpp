// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "analysis/examination.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

/// Returns the document of docs/schema/check.schema.json.
Json to_json(const model::Model& model, const analysis::Examination& examination);

}  // namespace eomgen::cli
