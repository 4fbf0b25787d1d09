// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/document.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>

#include "model/names.hpp"
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

namespace {

std::size_t offset_of(const Source& source, const toml::source_position& place) {
  return source.offset(place.line, place.column);
}

// Traverses a TOML string in the source along with its decoded bytes, to find the source offset of every byte.
class StringWalk {
 public:
  StringWalk(const std::string& source, std::size_t begin, const std::string& decoded)
      : source_(source), at_(begin), decoded_(decoded) {}

  std::vector<std::size_t> origin() {
    std::vector<std::size_t> result;
    const char quote = at_ < source_.size() ? source_[at_] : '\0';
    if (quote != '"' && quote != '\'') return fallback();
    const bool multiline = source_.compare(at_, 3, std::string(3, quote)) == 0;
    at_ += multiline ? 3 : 1;
    if (multiline && at_ < source_.size() && source_[at_] == '\r') ++at_;
    if (multiline && at_ < source_.size() && source_[at_] == '\n') ++at_;
    while (result.size() < decoded_.size()) {
      if (at_ >= source_.size()) return fallback();
      if (quote == '"' && source_[at_] == '\\') {
        if (!escape(result)) return fallback();
        continue;
      }
      if (source_[at_] != decoded_[result.size()]) {
        if (source_[at_] != '\r') return fallback();  // toml++ turns CRLF into LF
        ++at_;
        continue;
      }
      result.push_back(at_++);
    }
    result.push_back(at_);
    return result;
  }

 private:
  // If the traversal and toml++ disagree, every byte gets the offset of the start of the string.
  std::vector<std::size_t> fallback() const { return std::vector<std::size_t>(decoded_.size() + 1, begin_); }

  bool escape(std::vector<std::size_t>& result) {
    const std::size_t start = at_++;
    const char c = at_ < source_.size() ? source_[at_] : '\0';
    if (c == '\n' || c == '\r' || c == ' ' || c == '\t') {  // a line-ending backslash
      while (at_ < source_.size() && std::string_view(" \t\r\n").find(source_[at_]) != std::string_view::npos) ++at_;
      return true;
    }
    const std::size_t digits = c == 'u' ? 4 : c == 'U' ? 8 : 0;
    std::size_t bytes = 1;
    if (digits > 0) {
      const auto first = static_cast<unsigned char>(decoded_[result.size()]);
      bytes = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    }
    at_ += 1 + digits;
    if (result.size() + bytes > decoded_.size()) return false;
    result.insert(result.end(), bytes, start);
    return true;
  }

  const std::string& source_;
  std::size_t at_;
  std::size_t begin_ = at_;
  const std::string& decoded_;
};

std::string number_text(const std::string& text, std::size_t begin) {
  std::size_t end = begin;
  while (end < text.size() && std::string_view("+-._").find(text[end]) != std::string_view::npos) ++end;
  while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 ||
                               std::string_view("+-._").find(text[end]) != std::string_view::npos)) {
    ++end;
  }
  return text.substr(begin, end - begin);
}

Value convert(const Source& source, const toml::node& node);

void convert_table(const Source& source, const toml::table& table, Value& value) {
  value.kind = Value::Kind::table;
  std::vector<std::pair<std::size_t, Entry>> entries;
  for (const auto& [key, child] : table) {
    const std::size_t begin = offset_of(source, key.source().begin);
    const std::size_t end = offset_of(source, key.source().end);
    entries.push_back({begin, Entry{std::string(key.str()), source.span(begin, end - begin), convert(source, child)}});
  }
  // toml++ sorts keys by name; a model keeps the order of the file.
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [begin, entry] : entries) value.entries.push_back(std::move(entry));
}

void convert_string(const Source& source, const toml::node& node, Value& value) {
  value.kind = Value::Kind::text;
  value.text = node.as_string()->get();
  value.text_offsets = StringWalk(source.text(), value.begin, value.text).origin();
}

Value convert(const Source& source, const toml::node& node) {
  Value value;
  value.begin = offset_of(source, node.source().begin);
  const std::size_t end = offset_of(source, node.source().end);
  value.span = source.span(value.begin, end > value.begin ? end - value.begin : 1);
  if (const auto* table = node.as_table()) {
    convert_table(source, *table, value);
  } else if (const auto* array = node.as_array()) {
    value.kind = Value::Kind::array;
    for (const auto& item : *array) value.items.push_back(convert(source, item));
  } else if (node.is_string()) {
    convert_string(source, node, value);
  } else if (const auto* truth = node.as_boolean()) {
    value.kind = Value::Kind::boolean;
    value.boolean = truth->get();
  } else if (const auto* integer = node.as_integer()) {
    value.kind = Value::Kind::integer;
    value.text = std::to_string(integer->get());
  } else if (node.is_floating_point()) {
    value.kind = Value::Kind::real;
    value.text = number_text(source.text(), value.begin);
  } else {
    value.kind = Value::Kind::date;
  }
  return value;
}

// Removes the prefix of messages such as "Error while parsing string: unescaped ...".
std::string clean_description(std::string_view description) {
  constexpr std::string_view lead = "Error while parsing ";
  if (description.starts_with(lead)) description.remove_prefix(lead.size());
  return fmt::format("this is not TOML: {}", description);
}

}  // namespace

const Entry* Value::entry(std::string_view key) const {
  for (const Entry& candidate : entries) {
    if (candidate.key == key) return &candidate;
  }
  return nullptr;
}

const Value* Value::find(std::string_view key) const {
  const Entry* found = entry(key);
  return found == nullptr ? nullptr : &found->value;
}

const char* kind_name(Value::Kind kind) {
  switch (kind) {
    case Value::Kind::text: return "a string";
    case Value::Kind::integer:
    case Value::Kind::real: return "a number";
    case Value::Kind::boolean: return "true or false";
    case Value::Kind::date: return "a date or time";
    case Value::Kind::array: return "an array";
    case Value::Kind::table: return "a table";
  }
  return "a value";
}

namespace {

// key = 9,81 and key = 9.81 m/s^2: the error is in the value, not in the structure of the file.
void refuse_bare_value(const Source& source, std::size_t at) {
  const std::string& text = source.text();
  at = std::min(at, text.size());
  const std::size_t begin = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
  const std::size_t end = std::min(text.find('\n', begin), text.size());
  const std::string line = text.substr(begin, end - begin);
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos || line.find_first_of("\"'[{#", equals) != std::string::npos) return;
  const std::size_t first = line.find_first_not_of(" \t", equals + 1), last = line.find_last_not_of(" \t\r");
  if (first == std::string::npos || last < first) return;
  const std::string value = line.substr(first, last - first + 1);
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const Span span = source.span(begin + first, value.size());
  const std::size_t comma = value.find(',');
  if (comma != std::string::npos && comma > 0 && comma + 1 < value.size() && digit(value[comma - 1]) &&
      digit(value[comma + 1])) {
    std::string meant = value;
    meant[comma] = '.';
    source.fail(span, "a comma is no decimal point",
                fmt::format("write {}", meant.find(' ') == std::string::npos ? meant : '"' + meant + '"'));
  }
  // An invalid TOML number has its own message.
  const bool plain = value.find_first_not_of("0123456789.eE+-_xob") == std::string::npos;
  if (plain || value.size() > 100 || value.find(',') != std::string::npos) return;
  source.fail(span, fmt::format("{} is no TOML value: units and expressions are texts", quote(value)),
              fmt::format("write it in quotes: \"{}\"", value));
}

// theta. = 1: a dot without a name after it.
void refuse_dotted_key(const Source& source, std::size_t at) {
  const std::string& text = source.text();
  if (at >= text.size() || (text[at] != '=' && text[at] != ' ' && text[at] != '\t')) return;
  std::size_t end = at;
  while (end > 0 && (text[end - 1] == ' ' || text[end - 1] == '\t')) --end;
  if (end == 0 || text[end - 1] != '.') return;
  std::size_t begin = end - 1;
  const auto in_key = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.'; };
  while (begin > 0 && in_key(text[begin - 1])) --begin;
  const std::string key = text.substr(begin, end - 1 - begin);
  if (key.empty()) return;
  source.fail(source.span(begin, end - begin), fmt::format("the key {} ends with a dot", quote(key + '.')),
              fmt::format("write {0} = ..; the time derivative of a coordinate {0} is {0}_dot", key));
}

}  // namespace

Value read_document(const Source& source) {
  try {
    const toml::table table = toml::parse(source.text());
    Value root = convert(source, table);
    root.span = source.span(0, 1);
    return root;
  } catch (const toml::parse_error& error) {
    const std::size_t at = offset_of(source, error.source().begin);
    refuse_dotted_key(source, at);
    refuse_bare_value(source, at);
    source.fail(
        source.span(at, 1), clean_description(error.description()),
        "a model is a TOML 1.0 file: key = value, [section], [[entry]]; texts in quotes (docs/model-format.md)");
  }
}

}  // namespace eomgen::model
