// SPDX-License-Identifier: GPL-3.0-or-later
// A TOML file as a tree of values with exact positions, in the order of the file. The only user of toml++.
#pragma once

#include <string>
#include <vector>

#include "model/source.hpp"

namespace eomgen::model {

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
