// SPDX-License-Identifier: GPL-3.0-or-later
// Values of JSON documents. Members of objects keep their order.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "work.hpp"

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

/// The array of write(entry) for each entry of a list.
template <class List, class Write>
Json list_of(const List& list, const Write& write) {
  Json result = Json::array();
  for (const auto& entry : list) result.push_back(write(entry));
  return result;
}

/// The value of a member of an object: null for a number that is not finite and for an optional without value.
template <class T>
Json member_value(const T& value) {
  return value;
}
inline Json member_value(double value) { return finite_or_null(value); }
template <class T>
Json member_value(const std::optional<T>& value) {
  return or_null(value);
}

/// {"a": x.a, "b": x.b, ..}: members of a struct under their names.
#define EOMGEN_MEMBER(member) json_members[#member] = member_value(json_struct.member);
#define EOMGEN_MEMBERS(x, ...)                                            \
  [&json_struct = x] {                                                    \
    Json json_members = Json::object();                                   \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(EOMGEN_MEMBER, __VA_ARGS__)) \
    return json_members;                                                  \
  }()

inline Json to_json(const std::vector<work::LeftOut>& list) {
  return list_of(list, [](const work::LeftOut& one) { return EOMGEN_MEMBERS(one, what, why); });
}

}  // namespace eomgen::cli
