// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/assignments.hpp"

#include <fmt/format.h>

#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {

std::map<std::string, symbolic::Rational> parse_assignments(const std::string& command, const std::string& option,
                                                            const std::vector<std::string>& assignments) {
  std::map<std::string, symbolic::Rational> result;
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw Error(command, {}, fmt::format("{} sets nothing", model::quote(assignment)),
                  fmt::format("write {0} NAME=VALUE, such as {0} m=2.5", option));
    }
    result[assignment.substr(0, equals)] = parse_decimal(assignment.substr(equals + 1), assignment);
  }
  return result;
}

}  // namespace eomgen::cli
