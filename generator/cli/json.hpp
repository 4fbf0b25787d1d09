// SPDX-License-Identifier: GPL-3.0-or-later
// Values of JSON documents. Only json.cpp includes the JSON library, whose templates would add seconds of compilation
// to every file that makes a document.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace eomgen::cli {

/// Null, a boolean, a number, a string, a list, or an object whose members keep their order. A list in braces is an
/// object if each element is a pair that starts with a string, as in {{"format", 1}, {"file", name}}.
class Json {
 public:
  using Array = std::vector<Json>;
  using Member = std::pair<std::string, Json>;
  using Object = std::vector<Member>;

  Json() = default;
  Json(std::nullptr_t) {}
  Json(bool value) : value_(value) {}
  Json(double value) : value_(value) {}
  Json(const char* text) : value_(std::string(text)) {}
  Json(std::string_view text) : value_(std::string(text)) {}
  Json(std::string text) : value_(std::move(text)) {}
  template <std::signed_integral T>
  Json(T value) : value_(static_cast<std::int64_t>(value)) {}
  template <std::unsigned_integral T>
  requires(!std::same_as<T, bool>) Json(T value) : value_(static_cast<std::uint64_t>(value)) {}
  template <typename T>
  Json(const std::vector<T>& list) : value_(Array(list.begin(), list.end())) {}
  template <typename T, std::size_t n>
  Json(const std::array<T, n>& list) : value_(Array(list.begin(), list.end())) {}
  Json(std::initializer_list<Json> list);
  Json(const Json&) = default;
  Json(Json&&) noexcept = default;
  Json& operator=(const Json&) = default;
  Json& operator=(Json&&) noexcept = default;
  ~Json() = default;

  static Json array(std::initializer_list<Json> list = {});
  static Json object();

  bool is_null() const { return std::holds_alternative<std::nullptr_t>(value_); }
  bool is_string() const { return std::holds_alternative<std::string>(value_); }
  bool is_object() const { return std::holds_alternative<Object>(value_); }
  bool is_array() const { return std::holds_alternative<Array>(value_); }
  bool is_float() const { return std::holds_alternative<double>(value_); }

  /// Returns the value as T. Throws std::logic_error if it has another type or T cannot represent it.
  template <typename T>
  T get() const {
    if constexpr (std::same_as<T, bool>) {
      return truth();
    } else if constexpr (std::same_as<T, std::string>) {
      return text();
    } else if constexpr (std::floating_point<T>) {
      return number();
    } else {
      const std::int64_t value = whole();
      if (!std::in_range<T>(value)) refuse("a number of that type");
      return static_cast<T>(value);
    }
  }

  /// Member of an object. The non-const overload adds an absent member and turns null into an object; the const
  /// overload requires that the member exists.
  Json& operator[](std::string_view key);
  const Json& operator[](std::string_view key) const;
  Json& operator[](const char* key) { return (*this)[std::string_view(key)]; }
  const Json& operator[](const char* key) const { return (*this)[std::string_view(key)]; }
  bool contains(std::string_view key) const;
  const Object& items() const;

  /// Elements of a list. push_back() turns null into a list.
  void push_back(Json element);
  Json& back();
  const Json& operator[](std::size_t element) const;
  const Json& front() const { return (*this)[std::size_t{0}]; }
  Array::const_iterator begin() const { return elements().begin(); }
  Array::const_iterator end() const { return elements().end(); }
  /// Number of elements or members; 0 for null.
  std::size_t size() const;
  bool empty() const { return size() == 0; }

  friend bool operator==(const Json& a, const Json& b);

  /// Serialises on one line, or with `indent` blanks per level. Invalid UTF-8 is replaced; numbers that are not finite
  /// become null. `signed_zero`: whether -0 keeps its sign.
  std::string dump(int indent = -1, bool signed_zero = true) const;

 private:
  friend struct Writer;
  const Array& elements() const;
  bool truth() const;
  const std::string& text() const;
  double number() const;
  std::int64_t whole() const;
  [[noreturn]] static void refuse(const char* what);

  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object> value_ = nullptr;
};

/// A number that JSON can represent, else null.
Json finite_or_null(double value);

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace eomgen::cli
