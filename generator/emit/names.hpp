// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of user names to identifiers of C, C++ or JavaScript that are unique per scope.
#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace eomgen::emit {

/// Whether a name is reserved in emitted code: keywords of C and C++, names and macros of headers that it is likely to
/// meet, names that the emitted code itself uses.
bool is_reserved(const std::string& name);

/// `text` with each character that is invalid in identifiers replaced by _.
std::string identifier(const std::string& text);

/// Reserved words of JavaScript, and names in pages and modules, that C and C++ do not reserve.
std::span<const std::string_view> javascript_reserved_words();

/// The id of a model as an identifier that is none of the `taken` words of a language.
std::string id_beside(const std::string& id, std::span<const std::string_view> taken);

/// Identifiers of one scope. `declare` returns the wanted name, with trailing underscores if it is taken. A name of
/// more than `longest` characters is cut and numbered.
class NameTable {
 public:
  static constexpr std::size_t unlimited = static_cast<std::size_t>(-1);
  explicit NameTable(std::size_t longest = unlimited) : longest_(longest) {}
  std::string declare(const std::string& wanted);

 private:
  std::size_t longest_, cut_ = 0;
  std::set<std::string> taken_;
};

}  // namespace eomgen::emit
