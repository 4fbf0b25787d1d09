// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace eomgen {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      result += c;
    }
  }
  return result + '"';
}

/// Quotes the key unless TOML accepts it as a bare key.
std::string key_text(const std::string& key) {
  const auto bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !key.empty() && std::all_of(key.begin(), key.end(), bare) ? key : quoted(key);
}

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return fmt::format("{}", value);
}

/// TOML header of a section: "scene.default" is the table `default` of `scene`.
std::string header(const std::string& section) {
  const std::size_t dot = section.find('.');
  if (dot == std::string::npos) return key_text(section);
  return key_text(section.substr(0, dot)) + "." + key_text(section.substr(dot + 1));
}

}  // namespace

std::string Value::toml() const {
  struct Writer {
    std::string operator()(const std::string& text) const { return quoted(text); }
    std::string operator()(double number) const { return number_text(number); }
    std::string operator()(bool truth) const { return truth ? "true" : "false"; }
    std::string operator()(const Array& list) const {
      std::string result = "[";
      for (const Value& entry : list) result += (result.size() > 1 ? ", " : "") + entry.toml();
      return result + "]";
    }
    std::string operator()(const Table& table) const {
      std::string result = "{";
      for (const auto& [key, value] : table)
        result += (result.size() > 1 ? ", " : " ") + key_text(key) + " = " + value.toml();
      return result + " }";
    }
  };
  return std::visit(Writer{}, held_);
}

Definition::Definition(std::string title) : title_(std::move(title)) {}

Definition& Definition::set(const std::string& section, const std::string& key, Value value) {
  auto found = std::find_if(sections_.begin(), sections_.end(),
                            [&](const Section& s) { return !s.repeated && s.name == section; });
  if (found == sections_.end()) found = sections_.insert(sections_.end(), {section, false, {}});
  found->entries.emplace_back(key, std::move(value));
  return *this;
}

Definition& Definition::add(const std::string& section, const Value::Table& entries) {
  sections_.push_back({section, true, entries});
  return *this;
}

Definition& Definition::add(const std::string& section, std::initializer_list<std::pair<std::string, Value>> entries) {
  return add(section, Value::Table(entries));
}

std::string Definition::text() const {
  std::string result = "format = 1\n";
  if (!title_.empty()) result += "title = " + quoted(title_) + "\n";
  for (const Section& section : sections_) {
    result += section.repeated ? "\n[[" + header(section.name) + "]]\n" : "\n[" + header(section.name) + "]\n";
    for (const auto& [key, value] : section.entries) result += key_text(key) + " = " + value.toml() + "\n";
  }
  return result;
}

}  // namespace eomgen
