// SPDX-License-Identifier: GPL-3.0-or-later
// A model made in code: the sections and keys of a model file (docs/model-format.md), as values.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace eomgen {

/// What a key of a model file may hold: text (expressions, names, values with units), a number, a truth value, a list,
/// a table.
class Value {
 public:
  using Array = std::vector<Value>;
  using Table = std::vector<std::pair<std::string, Value>>;

  Value(const char* text) : held_(std::string(text)) {}
  Value(std::string text) : held_(std::move(text)) {}
  Value(double number) : held_(number) {}
  Value(int number) : held_(static_cast<double>(number)) {}
  Value(bool truth) : held_(truth) {}
  Value(Array list) : held_(std::move(list)) {}
  Value(Table table) : held_(std::move(table)) {}
  /// A list: Value::list({0, 10}).
  static Value list(std::initializer_list<Value> entries) { return Value(Array(entries)); }
  /// A table: Value::table({{"x", 1}, {"y", "2 m"}}).
  static Value table(std::initializer_list<std::pair<std::string, Value>> entries) { return Value(Table(entries)); }

  /// As TOML in one line; text is escaped.
  std::string toml() const;

 private:
  std::variant<std::string, double, bool, Array, Table> held_;
};

/// Sections in the order in which they were added. What is wrong with them is told when a Model is made of it, with
/// line and column in text().
class Definition {
 public:
  explicit Definition(std::string title = "");

  /// [section] with one more key, made where it is not there yet: set("parameters", "m", "1 kg"). A section with a dot
  /// is one of several: "scene.default".
  Definition& set(const std::string& section, const std::string& key, Value value);
  /// One more [[section]]: add("particle", {{"name", "P"}, {"mass", "m"}, ..}).
  Definition& add(const std::string& section, std::initializer_list<std::pair<std::string, Value>> entries);
  Definition& add(const std::string& section, const Value::Table& entries);

  Definition& parameter(const std::string& name, Value value) { return set("parameters", name, std::move(value)); }

  /// The model file that says the same.
  std::string text() const;

 private:
  struct Section {
    std::string name;
    bool repeated = false;
    Value::Table entries;
  };
  std::string title_;
  std::vector<Section> sections_;
};

}  // namespace eomgen
