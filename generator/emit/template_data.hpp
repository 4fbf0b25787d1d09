// SPDX-License-Identifier: GPL-3.0-or-later
// Values of templates.
#pragma once

#include <kainjow/mustache.hpp>
#include <string>
#include <utility>
#include <vector>

namespace eomgen::emit {

/// An object of the values that are not empty.
inline kainjow::mustache::data template_object(const std::vector<std::pair<std::string, std::string>>& values) {
  kainjow::mustache::data result{kainjow::mustache::data::type::object};
  for (const auto& [key, value] : values)
    if (!value.empty()) result.set(key, value);
  return result;
}

}  // namespace eomgen::emit
