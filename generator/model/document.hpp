// SPDX-License-Identifier: GPL-3.0-or-later
// A TOML file as a tree of values with exact positions, in the order of the file. The only user of toml++.
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

/// The user's file as bytes and lines. Source::fail reports every error in it.
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

struct Entry;

struct Value {
  enum class Kind { text, integer, real, boolean, date, array, table };
  Kind kind = Kind::table;
  std::string text;                       // strings: decoded; numbers: as written in the file
  bool boolean = false;                   // of booleans
  std::vector<Value> items;               // of arrays
  std::vector<Entry> entries;             // of tables
  std::size_t begin = 0;                  // byte offset in the file
  std::vector<std::size_t> text_offsets;  // strings: file offsets of every byte of `text` and of its end
  Span span;
  bool generated = false;  // tables: written by eomgen, which has keys that files have not

  const Value* find(std::string_view key) const;
  const Entry* entry(std::string_view key) const;
  bool is(Kind which) const { return kind == which; }
};

struct Entry {
  std::string key;
  Span span;  // of the key
  Value value;
};

/// The kind as text for messages: "a string", "an array".
const char* kind_name(Value::Kind kind);

/// Parses a file. Throws Error for everything that TOML 1.0 forbids.
Value read_document(const Source& source);

}  // namespace eomgen::model
