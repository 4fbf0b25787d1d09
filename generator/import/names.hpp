// SPDX-License-Identifier: GPL-3.0-or-later
// Names of links and joints as legal names of a model, each once.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace eomgen::import {

class Names {
 public:
  /// A legal name that nothing else has: `wanted` if it is one; else illegal characters become underscores, and
  /// `suffix` or a number is appended. Reserves it.
  std::string claim(std::string_view wanted, std::string_view suffix);

 private:
  std::set<std::string, std::less<>> taken_;
};

}  // namespace eomgen::import
