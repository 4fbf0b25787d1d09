// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "utf8.hpp"

namespace eomgen::model {

Source::Source(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {
  if (text_.size() > max_file_bytes) {
    throw Error("model", SourceLocation{file_, 0, 0, 1, ""},
                fmt::format("the file has {} bytes; a model may have {}", text_.size(), max_file_bytes),
                "check that this is a model file; split a model that is really this large");
  }
  if (text_.starts_with("\xef\xbb\xbf")) text_.erase(0, 3);  // remove the byte order mark
  starts_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') starts_.push_back(i + 1);
  }
  check_bytes();
  for (std::size_t k = 0; k < starts_.size(); ++k) {
    const std::size_t end = k + 1 < starts_.size() ? starts_[k + 1] - 1 : text_.size();
    if (end - starts_[k] > max_line_bytes) {
      throw Error("model", SourceLocation{file_, static_cast<std::uint32_t>(k + 1), 1, 1, ""},
                  fmt::format("the line has more than {} bytes", max_line_bytes),
                  "a TOML text may have several lines: \"\"\"...\"\"\"");
    }
    lines_.push_back(text_.substr(starts_[k], end - starts_[k]));
    if (!lines_.back().empty() && lines_.back().back() == '\r') lines_.back().pop_back();
  }
  check_nesting();
}

Span Source::span(std::size_t offset, std::size_t length) const {
  offset = std::min(offset, text_.size());
  const auto next = std::upper_bound(starts_.begin(), starts_.end(), offset);
  const auto line = static_cast<std::size_t>(next - starts_.begin());
  const std::size_t line_end = next == starts_.end() ? text_.size() : *next - 1;
  const std::size_t column = offset - starts_[line - 1] + 1;
  const std::size_t room = line_end > offset ? line_end - offset : 1;
  return Span{static_cast<std::uint32_t>(line), static_cast<std::uint32_t>(column),
              static_cast<std::uint32_t>(std::clamp<std::size_t>(length, 1, room))};
}

std::size_t Source::offset(std::size_t line, std::size_t character_column) const {
  if (line == 0 || line > line_characters_.size() || character_column == 0) return text_.size();
  const std::size_t index = line_characters_[line - 1] + character_column - 1;
  return index < characters_.size() ? characters_[index] : text_.size();
}

SourceLocation Source::where(const Span& span) const { return locate(file_, lines_, span); }

SourceLocation locate(const std::string& file, const std::vector<std::string>& lines, const Span& span) {
  SourceLocation where{file, span.line, span.column, span.length, ""};
  if (span.line > 0 && span.line <= lines.size()) where.text = lines[span.line - 1];
  return where;
}

void Source::fail(const Span& span, std::string what, std::string remedy) const {
  throw Error("model", where(span), std::move(what), std::move(remedy));
}

void Source::check_bytes() {
  line_characters_.push_back(0);
  for (std::size_t at = 0; at < text_.size();) {
    const auto c = static_cast<unsigned char>(text_[at]);
    const std::size_t length = utf8_length(std::string_view(text_).substr(at));
    const bool control = (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7f;
    const bool lone_return = c == '\r' && (at + 1 >= text_.size() || text_[at + 1] != '\n');
    if (length == 0 || control || lone_return) {
      // The location has no line text, so that bytes of a binary file do not reach the terminal.
      const Span place = span(at, 1);
      throw Error("model", SourceLocation{file_, place.line, place.column, 1, ""},
                  length == 0 ? fmt::format("byte 0x{:02x} is not UTF-8 text", c)
                              : fmt::format("control character 0x{:02x} in the file", c),
                  "a model is a TOML file in UTF-8; check that this is one, or save it as UTF-8");
    }
    characters_.push_back(static_cast<std::uint32_t>(at));
    if (c == '\n') line_characters_.push_back(characters_.size());
    at += length;
  }
}

namespace {

// The lexical rules of TOML for strings and comments.
struct Skim {
  const std::string& text;
  std::size_t at = 0;

  bool ahead(std::string_view what) const { return text.compare(at, what.size(), what) == 0; }
  // Skips a comment or a string; false if neither starts here.
  bool skip() {
    const char c = text[at];
    if (c == '#') {
      while (at < text.size() && text[at] != '\n') ++at;
      return true;
    }
    if (c != '"' && c != '\'') return false;
    const std::string triple(3, c);
    const bool multiline = ahead(triple);
    at += multiline ? 3 : 1;
    while (at < text.size()) {
      if (c == '"' && text[at] == '\\') {
        at += 2;
      } else if (multiline ? ahead(triple) : text[at] == c) {
        at += multiline ? 3 : 1;
        while (multiline && at < text.size() && text[at] == c) ++at;  // """" ends with a quote inside
        return true;
      } else if (!multiline && text[at] == '\n') {
        return true;  // unterminated: toml++ reports it
      } else {
        ++at;
      }
    }
    at = text.size();
    return true;
  }
};

}  // namespace

// toml++ destroys its tables recursively, so the nesting depth is checked before parsing.
void Source::check_nesting() const {
  Skim skim{text_};
  std::size_t depth = 0;
  std::size_t dots = 0;
  while (skim.at < text_.size()) {
    if (skim.skip()) continue;
    const char c = text_[skim.at];
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') dots = 0;
    if (c == '.') ++dots;
    if (depth > max_toml_depth || dots > max_toml_depth) {
      fail(span(skim.at, 1),
           depth > max_toml_depth ? fmt::format("arrays and tables are nested more than {} deep", max_toml_depth)
                                  : fmt::format("a key has more than {} parts", max_toml_depth),
           "nothing in a model needs this; see docs/model-format.md for the sections and keys");
    }
    ++skim.at;
  }
}

}  // namespace eomgen::model
