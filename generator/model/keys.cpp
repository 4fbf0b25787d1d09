// SPDX-License-Identifier: GPL-3.0-or-later
// Tables and their keys: errors for unknown and missing keys.
#include <fmt/format.h>

#include <algorithm>

#include "model/section_reader.hpp"

namespace eomgen::model {

void SectionReader::check_keys(const Value& table, const Keys& keys) const {
  for (const Entry& entry : table.entries) {
    if (std::find(keys.known.begin(), keys.known.end(), entry.key) != keys.known.end()) continue;
    const std::string what = fmt::format("{} has no key {}", keys.what, quote(entry.key));
    if (const auto other = keys.synonyms.find(entry.key); other != keys.synonyms.end())
      source_.fail(entry.span, what, other->second);
    const std::vector<std::string> candidates(keys.known.begin(), keys.known.end());
    const std::string hint = did_you_mean(entry.key, candidates);
    source_.fail(entry.span, what, hint.empty() ? fmt::format("its keys are {}", fmt::join(keys.known, ", ")) : hint);
  }
}

const Value& SectionReader::require_value(const Value& table, std::string_view key, const std::string& what,
                                          const std::string& remedy) const {
  const Value* value = table.find(key);
  if (value == nullptr) source_.fail(table.span, fmt::format("{} has no {}", what, key), remedy);
  return *value;
}

const Value& SectionReader::require_kind(Value::Kind kind, const Value& value, const std::string& what,
                                         const std::string& remedy) const {
  if (!value.is(kind)) {
    source_.fail(value.span,
                 fmt::format("{} is {}, and {} is asked", what, model::kind_name(value.kind), model::kind_name(kind)),
                 remedy);
  }
  return value;
}

const Value* SectionReader::section(std::string_view name) const {
  const Entry* entry = root_.entry(name);
  if (entry == nullptr) return nullptr;
  return &require_kind(Value::Kind::table, entry->value, fmt::format("[{}]", name),
                       fmt::format("write [{}] and its keys below", name));
}

std::vector<const Value*> SectionReader::sections(std::string_view name) const {
  std::vector<const Value*> result;
  const Entry* entry = root_.entry(name);
  if (entry == nullptr) return result;
  const std::string remedy = fmt::format("write [[{}]] with two brackets, once for each", name);
  if (!entry->value.is(Value::Kind::array)) {
    source_.fail(entry->span, fmt::format("[{}] is a list of entries", name), remedy);
  }
  for (const Value& item : entry->value.items)
    result.push_back(&require_kind(Value::Kind::table, item, fmt::format("[[{}]]", name), remedy));
  return result;
}

std::string SectionReader::text_of_key(const Value& table, std::string_view key, const std::string& what) const {
  const Value& value = require_value(table, key, what, fmt::format("add {} = \"...\"", key));
  return require_kind(Value::Kind::text, value, fmt::format("the {} of {}", key, what), "write it in quotes").text;
}

Span SectionReader::key_span(const Value& table, std::string_view key) const {
  const Entry* entry = table.entry(key);
  return entry == nullptr ? table.span : entry->span;
}

std::string SectionReader::tex_of(const Value& table, const std::string& what) const {
  const Value* value = table.find("tex");
  if (value == nullptr) return "";
  require_kind(Value::Kind::text, *value, fmt::format("the tex of {}", what),
               "write it in quotes, such as '\\theta_{1}'");
  if (const auto problem = tex_error(value->text)) {
    source_.fail(
        value->span, fmt::format("the tex of {} is refused: {}", what, *problem),
        "letters, digits, blanks, _ ^ { } , ' and commands for Greek letters, accents and text styles are allowed");
  }
  return value->text;
}

MeasuredUnit SectionReader::any_unit(const Value& value, const std::string& what) const {
  require_kind(Value::Kind::text, value, fmt::format("the unit of {}", what), "write it in quotes, such as \"m/s\"");
  const auto unit = parse_unit(value.text);
  if (!unit) {
    const std::string hint = unit_hint(value.text);
    source_.fail(value.span, fmt::format("{} is not a unit", quote(value.text)),
                 hint.empty() ? "units are listed in docs/model-format.md" : hint);
  }
  return *unit;
}

Unit SectionReader::si_unit(const Value& value, const std::string& what) const {
  const MeasuredUnit unit = any_unit(value, what);
  if (unit.scale != 1 || unit.pi_power != 0) {
    source_.fail(value.span, fmt::format("{} is measured in SI units, and {} is not one", what, quote(value.text)),
                 fmt::format("state {}; single values may have any unit, as in \"30 deg\" or \"5 mm\"",
                             is_one(unit.dimension) ? "rad" : text_of(unit.dimension)));
  }
  return Unit{unit.text, unit.dimension};
}

}  // namespace eomgen::model
