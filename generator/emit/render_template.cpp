// SPDX-License-Identifier: GPL-3.0-or-later
#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "emit/metadata.hpp"

namespace eomgen::emit {

std::string render_template(const std::string& skeleton, const std::vector<std::pair<std::string, std::string>>& values,
                            const std::vector<std::vector<std::pair<std::string, std::string>>>& functions) {
  kainjow::mustache::mustache text{skeleton};
  if (!text.is_valid()) throw std::logic_error(text.error_message());
  text.set_custom_escape([](const std::string& s) { return s; });
  kainjow::mustache::data all{kainjow::mustache::data::type::object};
  for (const auto& [key, value] : values) all.set(key, value);
  kainjow::mustache::data list{kainjow::mustache::data::type::list};
  for (const auto& function : functions) {
    kainjow::mustache::data entry{kainjow::mustache::data::type::object};
    for (const auto& [key, value] : function) entry.set(key, value);
    list << entry;
  }
  all.set("functions", list);
  return text.render(all);
}

}  // namespace eomgen::emit
