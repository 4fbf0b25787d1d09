// SPDX-License-Identifier: GPL-3.0-or-later
// The user's file as bytes and lines. Source::fail reports every error in it.
// In: the text of a model file. Out: locations (Span, SourceLocation) and errors.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "error.hpp"
#include "model/expression.hpp"

namespace eomgen::model {

/// Largest model file, in bytes.
inline constexpr std::size_t max_file_bytes = std::size_t{1} << 20;
/// Longest line, in bytes.
inline constexpr std::size_t max_line_bytes = 200000;
/// Deepest nesting of TOML arrays and inline tables, and most parts of a dotted key.
inline constexpr std::size_t max_toml_depth = 24;

class Source {
 public:
  /// Throws Error if the text is too large, is not UTF-8, contains control characters, or is nested too deeply.
  Source(std::string file, std::string text);

  const std::string& file() const { return file_; }
  const std::string& text() const { return text_; }
  const std::vector<std::string>& lines() const { return lines_; }

  /// The location of a range of bytes.
  Span span(std::size_t offset, std::size_t length) const;
  /// The byte offset of a line and a column in characters, not bytes (as in toml++); both count from 1.
  std::size_t offset(std::size_t line, std::size_t character_column) const;
  SourceLocation where(const Span& span) const;
  [[noreturn]] void fail(const Span& span, std::string what, std::string remedy) const;

 private:
  void check_bytes();
  void check_nesting() const;

  std::string file_;
  std::string text_;
  std::vector<std::size_t> starts_;           // offset of each line
  std::vector<std::uint32_t> characters_;     // offset of each character
  std::vector<std::size_t> line_characters_;  // index of each line's first character
  std::vector<std::string> lines_;
};

/// The location of a span in the lines of a file.
SourceLocation locate(const std::string& file, const std::vector<std::string>& lines, const Span& span);

}  // namespace eomgen::model
