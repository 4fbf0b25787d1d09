// SPDX-License-Identifier: GPL-3.0-or-later
// Builder of a model in code: sections and keys of a model file (docs/model-format.md) with their values.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace eomgen {

/// Value of a key: text (expressions, names, values with units), a number, a boolean, a list or a table.
class Value {
 public:
  /// A list.
  using Array = std::vector<Value>;
  /// A table: pairs of a key and its value, in order.
  using Table = std::vector<std::pair<std::string, Value>>;

  /// Text: an expression, a name, or a number with its unit, "2 m".
  Value(const char* text) : held_(std::string(text)) {}
  /// Text.
  Value(std::string text) : held_(std::move(text)) {}
  /// A number without a unit.
  Value(double number) : held_(number) {}
  /// A number without a unit.
  Value(int number) : held_(static_cast<double>(number)) {}
  /// A boolean.
  Value(bool truth) : held_(truth) {}
  /// A list.
  Value(Array list) : held_(std::move(list)) {}
  /// A table.
  Value(Table table) : held_(std::move(table)) {}
  /// Makes a list: Value::list({0, 10}).
  static Value list(std::initializer_list<Value> entries) { return Value(Array(entries)); }
  /// Makes a table: Value::table({{"x", 1}, {"y", "2 m"}}).
  static Value table(std::initializer_list<std::pair<std::string, Value>> entries) { return Value(Table(entries)); }

  /// Returns the value as TOML on one line, with text escaped.
  std::string toml() const;

 private:
  std::variant<std::string, double, bool, Array, Table> held_;
};

/// Sections in the order of insertion. Nothing is checked here: Model::from() reports errors, with line and column in
/// text().
class Definition {
 public:
  /// `title`: the title of the model; may be empty.
  explicit Definition(std::string title = "");

  /// Appends a key to [section], and creates the section if needed: set("parameters", "m", "1 kg"). A dot separates
  /// section and entry: "scene.default".
  Definition& set(const std::string& section, const std::string& key, Value value);
  /// Appends a [[section]]: add("particle", {{"name", "P"}, {"mass", "m"}, ..}).
  Definition& add(const std::string& section, std::initializer_list<std::pair<std::string, Value>> entries);
  /// The same with entries that are computed.
  Definition& add(const std::string& section, const Value::Table& entries);

  /// Appends a parameter, the same as set("parameters", name, value).
  Definition& parameter(const std::string& name, Value value) { return set("parameters", name, std::move(value)); }

  /// Returns the equivalent model file.
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
