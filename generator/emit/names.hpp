// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the user's become identifiers of C, C++ or JavaScript, each once per scope.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>

namespace eomgen::emit {

/// True for what a user's name must not be in emitted code: keywords of C and C++, names and macros of the headers that
/// it is likely to meet, names that the emitted code itself uses.
bool is_reserved(const std::string& name);

/// `text` with everything that no identifier may hold replaced by _.
std::string identifier(const std::string& text);

/// Words of JavaScript, and what a page or a module has by name, that C and C++ leave free.
std::span<const std::string_view> javascript_words();

/// Identifiers of one scope: `declare` gives the name, or the name with trailing underscores where it is taken.
class NameTable {
 public:
  std::string declare(const std::string& wanted);

 private:
  std::set<std::string> taken_;
};

}  // namespace eomgen::emit
