// SPDX-License-Identifier: GPL-3.0-or-later
// Values of JSON documents. Members of objects keep their order.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace eomgen::cli {

using Json = nlohmann::ordered_json;

/// Serialises on one line, or with `indent` blanks per level. Invalid UTF-8 is replaced; numbers that are not finite
/// become null.
inline std::string serialised(const Json& value, int indent = -1) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// A number that JSON can represent, else null.
inline Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace eomgen::cli
