// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace eomgen::cli {

Json::Json(std::initializer_list<Json> list) {
  const bool members = std::all_of(list.begin(), list.end(), [](const Json& element) {
    return element.is_array() && element.size() == 2 && element.elements().front().is_string();
  });
  if (!members || list.size() == 0) {
    value_ = Array(list);
    return;
  }
  Object object;
  for (const Json& member : list) object.emplace_back(member.elements()[0].text(), member.elements()[1]);
  value_ = std::move(object);
}

Json Json::array(std::initializer_list<Json> list) {
  Json result;
  result.value_ = Array(list);
  return result;
}

Json Json::object() {
  Json result;
  result.value_ = Object();
  return result;
}

void Json::refuse(const char* what) { throw std::logic_error(std::string("a JSON value is not ") + what); }

bool Json::truth() const {
  if (const bool* value = std::get_if<bool>(&value_)) return *value;
  refuse("a truth value");
}

const std::string& Json::text() const {
  if (const std::string* value = std::get_if<std::string>(&value_)) return *value;
  refuse("a text");
}

double Json::number() const {
  if (const double* value = std::get_if<double>(&value_)) return *value;
  if (const std::uint64_t* value = std::get_if<std::uint64_t>(&value_)) return static_cast<double>(*value);
  return static_cast<double>(whole());
}

std::int64_t Json::whole() const {
  if (const std::int64_t* value = std::get_if<std::int64_t>(&value_)) return *value;
  const std::uint64_t* value = std::get_if<std::uint64_t>(&value_);
  if (value != nullptr && std::in_range<std::int64_t>(*value)) return static_cast<std::int64_t>(*value);
  refuse("a whole number");
}

const Json::Array& Json::elements() const {
  static const Array none;
  if (is_null()) return none;
  if (const Array* value = std::get_if<Array>(&value_)) return *value;
  refuse("a list");
}

const Json::Object& Json::items() const {
  if (const Object* value = std::get_if<Object>(&value_)) return *value;
  refuse("an object");
}

Json& Json::operator[](std::string_view key) {
  if (is_null()) value_ = Object();
  Object* object = std::get_if<Object>(&value_);
  if (object == nullptr) refuse("an object");
  for (auto& [name, value] : *object) {
    if (name == key) return value;
  }
  return object->emplace_back(std::string(key), Json()).second;
}

const Json& Json::operator[](std::string_view key) const {
  for (const auto& [name, value] : items()) {
    if (name == key) return value;
  }
  refuse("an object with that member");
}

bool Json::contains(std::string_view key) const {
  return is_object() && std::any_of(items().begin(), items().end(), [key](const Member& m) { return m.first == key; });
}

void Json::push_back(Json element) {
  if (is_null()) value_ = Array();
  Array* array = std::get_if<Array>(&value_);
  if (array == nullptr) refuse("a list");
  array->push_back(std::move(element));
}

Json& Json::back() {
  Array* array = std::get_if<Array>(&value_);
  if (array == nullptr || array->empty()) refuse("a list with elements");
  return array->back();
}

const Json& Json::operator[](std::size_t element) const {
  if (element < elements().size()) return elements()[element];
  refuse("a list with that element");
}

std::size_t Json::size() const { return is_object() ? items().size() : elements().size(); }

bool operator==(const Json& a, const Json& b) {
  const auto is_whole = [](const Json& j) { return j.value_.index() == 2 || j.value_.index() == 3; };
  if (is_whole(a) && is_whole(b)) return a.whole() == b.whole();
  return a.value_ == b.value_;
}

/// Converts to the value type of the library.
struct Writer {
  bool signed_zero;

  nlohmann::ordered_json of(const Json& json) const {
    return std::visit([this](const auto& value) { return made(value); }, json.value_);
  }

 private:
  template <typename T>
  nlohmann::ordered_json made(const T& value) const {
    return value;
  }
  nlohmann::ordered_json made(double value) const { return value == 0 && !signed_zero ? 0.0 : value; }
  nlohmann::ordered_json made(const Json::Array& elements) const {
    nlohmann::ordered_json result = nlohmann::ordered_json::array();
    for (const Json& element : elements) result.push_back(of(element));
    return result;
  }
  nlohmann::ordered_json made(const Json::Object& members) const {
    nlohmann::ordered_json result = nlohmann::ordered_json::object();
    for (const auto& [name, value] : members) result.push_back({name, of(value)});
    return result;
  }
};

std::string Json::dump(int indent, bool signed_zero) const {
  return Writer{signed_zero}.of(*this).dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace eomgen::cli
