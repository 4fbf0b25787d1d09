// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/expand_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/contact_table.hpp"
#include "model/names.hpp"
#include "model/syntax.hpp"

namespace eomgen::model {

Value text_value(const Value& at, std::string text) {
  Value value;
  value.kind = Value::Kind::text;
  value.span = at.span;
  value.begin = at.begin;
  value.text_offsets.assign(text.size() + 1, at.begin);  // an error points to the table or to what was given there
  value.text = std::move(text);
  return value;
}

Value empty_table(const Value& at) {
  Value table;
  table.span = at.span;
  table.begin = at.begin;
  return table;
}

void ContactTable::expand() {
  const Value& name = require("name", "add name = \"..\"");
  require_text(name, "the name");
  name_ = name.text;
  struct Kind {
    const char* key;
    std::vector<std::string_view> further;
    void (ContactTable::*expand)(const Value&);
  };
  const std::array<Kind, 8> kinds{
      {{"points", {"body", "on", "shape_b", "tangent", "friction"}, &ContactTable::points},
       {"corners", {"body", "on", "shape_b", "tangent", "friction"}, &ContactTable::corners},
       {"shape", {"body", "on", "shape_b", "tangent", "friction"}, &ContactTable::shape},
       {"shapes", {"tangent", "friction"}, &ContactTable::shapes},
       {"spheres", {"radius", "tangent", "friction"}, &ContactTable::spheres},
       {"capsules", {"tangent", "friction"}, &ContactTable::capsules},
       {"particles", {"radius", "on", "friction"}, &ContactTable::particles},
       {"limits", {}, &ContactTable::limits}}};
  const Kind* chosen = nullptr;
  for (const Kind& kind : kinds) {
    if (table_.find(kind.key) == nullptr) continue;
    if (chosen != nullptr) fail(table_, fmt::format("has both '{}' and '{}'", chosen->key, kind.key), "write two");
    chosen = &kind;
  }
  if (chosen == nullptr)
    fail(table_, "does not state what touches what",
         "add points = { .. }, corners = [a, b, c] or shape = { .. } of a body, shapes = { A = { capsule = [R, L] }, "
         ".. }, spheres = [\"A\", \"B\", ..], capsules = { A = [R, L], .. }, particles = [\"P\", ..], or limits = { "
         "q = [a, b] }");
  std::vector<std::string> known{"name", "restitution", chosen->key};
  known.insert(known.end(), chosen->further.begin(), chosen->further.end());
  for (const Entry& entry : table_.entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    const std::string hint = did_you_mean(entry.key, known);
    source_.fail(entry.span, fmt::format("a [[contact]] of {} has no key {}", chosen->key, quote(entry.key)),
                 hint.empty() ? fmt::format("its keys are {}", fmt::join(known, ", ")) : hint);
  }
  (this->*chosen->expand)(*table_.find(chosen->key));
}

void ContactTable::fail(const Value& at, const std::string& what, const std::string& remedy) const {
  source_.fail(at.span, fmt::format("the [[contact]]{} {}", name_.empty() ? "" : " " + quote(name_), what), remedy);
}

const Value& ContactTable::require(const char* key, const char* remedy) const {
  const Value* value = table_.find(key);
  if (value == nullptr) fail(table_, fmt::format("has no {}", key), remedy);
  return *value;
}

void ContactTable::require_text(const Value& value, const std::string& what) const {
  if (!value.is(Value::Kind::text))
    fail(value, fmt::format("gives {} as {}", what, kind_name(value.kind)), "write it in quotes");
}

std::string ContactTable::expression(const Value& value, const std::string& what) const {
  if (!value.is(Value::Kind::text) && !value.is(Value::Kind::integer) && !value.is(Value::Kind::real))
    fail(value, fmt::format("gives {} as {}", what, kind_name(value.kind)), "write an expression or a number");
  return "(" + bracket_unit(value.text) + ")";
}

std::string ContactTable::length(const Value& value, const std::string& what) const {
  lengths_.push_back(text_value(value, expression(value, what)));
  return lengths_.back().text;
}

std::string ContactTable::vector(const Value& value, const std::string& what) const {
  if (!value.is(Value::Kind::array)) return expression(value, what);
  if (value.items.size() != 3)
    fail(value, fmt::format("gives {} with {} components", what, value.items.size()),
         "write three, along E1, E2, E3, or a vector as text");
  std::vector<std::string> terms;
  for (std::size_t k = 0; k < 3; ++k)
    terms.push_back(fmt::format("{}*E{}", expression(value.items[k], "a component"), k + 1));
  return fmt::format("({})", fmt::join(terms, " + "));
}

const std::vector<Value>& ContactTable::list(const Value& value, const std::string& what) const {
  if (!value.is(Value::Kind::array))
    fail(value, fmt::format("gives {} as {}", what, kind_name(value.kind)), "write a list in brackets");
  return value.items;
}

Value& ContactTable::begin(const Value& at, const std::string& suffix) {
  if (constraints_.size() >= max_contacts_of_tables)
    fail(at, fmt::format("makes more than {} contacts", max_contacts_of_tables), "split the model");
  Value constraint = empty_table(at);
  constraint.entries.push_back({"name", at.span, text_value(at, name_ + "_" + suffix)});
  constraint.entries.push_back({"holds", at.span, text_value(at, "unilateral")});
  for (const char* key : {"restitution", "friction"}) {
    if (const Entry* entry = table_.entry(key)) constraint.entries.push_back(*entry);
  }
  constraints_.push_back(std::move(constraint));
  return constraints_.back();
}

void ContactTable::particles(const Value& value) {
  const std::vector<Value>& names = list(value, "the particles");
  if (names.empty()) fail(value, "has no particles", "write particles = [\"P\", ..]");
  const Value& on = require("on", "add on = \"ground\", a plane { point, normal }, or an obstacle");
  const Value* radius = table_.find("radius");
  const std::string size = radius == nullptr ? "0" : length(*radius, "the radius");
  const std::function<std::string(const std::string&)> gap = gap_of_particle(on, radius, size);
  for (const Value& name : names) {
    require_text(name, "a particle");
    begin(name, name.text).entries.push_back({"holonomic", value.span, text_value(name, gap(name.text))});
  }
}

std::function<std::string(const std::string&)> ContactTable::gap_of_particle(const Value& on, const Value* radius,
                                                                             const std::string& size) const {
  if (on.is(Value::Kind::text)) {
    if (on.text != "ground")
      fail(on, fmt::format("puts particles on {}", quote(on.text)),
           "write on = \"ground\", a plane or an obstacle; pairs are spheres = [..] or shapes = { .. }");
    return [size](const std::string& name) { return fmt::format("dot({}, E3) - {}", name, size); };
  }
  if (on.is(Value::Kind::table) && is_on_plane() && (on.find("normal") != nullptr || on.find("point") != nullptr)) {
    const Value* point = on.find("point");
    if (point == nullptr) fail(on, "has a plane without a point", "add point = \"..\", a point of the plane");
    for (const Entry& entry : on.entries) {
      if (entry.key != "point" && entry.key != "normal")
        source_.fail(entry.span, fmt::format("a plane under particles has no key {}", quote(entry.key)),
                     "its keys are point, normal; a plane that moves along itself needs a [[body]] with points");
    }
    return [size, normal = normal_of(on), at = vector(*point, "the point")](const std::string& name) {
      return fmt::format("dot({} - {}, {}) - {}", name, at, normal, size);
    };
  }
  const Obstacle& kind = kind_of(on, obstacles(), "plane or obstacle");
  const std::vector<std::string> values = values_of(on, kind);
  if (kind.nearest == nullptr) {
    if (radius != nullptr)
      fail(*radius, "gives a radius, and a ball touches a surface beside the point below it", "remove radius");
    return [f = values[0]](const std::string& name) { return height_above(f, name); };
  }
  return [&kind, values, size](const std::string& name) {
    Names inlined{true};
    return kind.nearest({Core::Kind::point, name, size, "", ""}, values, inlined)[0].gap;
  };
}

void ContactTable::spheres(const Value& value) {
  const std::vector<Value>& names = list(value, "the spheres");
  if (names.size() < 2) fail(value, "needs two spheres", "write spheres = [\"A\", \"B\", ..]");
  const std::string radius = length(require("radius", "add radius = \"R\", that of each sphere"), "the radius");
  std::vector<Part> all;
  for (const Value& name : names) {
    require_text(name, "a sphere");
    all.push_back({name, {Core::Kind::point, name.text, radius, "", ""}});
  }
  pairs(value, all);
}

void ContactTable::capsules(const Value& value) {
  if (!value.is(Value::Kind::table) || value.entries.size() < 2)
    fail(value, "needs two capsules or balls", "write capsules = { A = [\"R\", \"L\"], ball = \"R\", .. }");
  std::vector<Part> all;
  for (const Entry& entry : value.entries) {
    const Value name = text_value(entry.value, entry.key);
    if (!entry.value.is(Value::Kind::array)) {
      all.push_back({name, {Core::Kind::point, entry.key, length(entry.value, "the radius"), "", ""}});
      continue;
    }
    if (entry.value.items.size() != 2)
      fail(entry.value, fmt::format("gives {} sizes of {}", entry.value.items.size(), quote(entry.key)),
           "write [radius, length between the centres of the ends], or the radius of a ball alone");
    all.push_back({name,
                   {Core::Kind::segment, entry.key, length(entry.value.items[0], "the radius"), entry.key + ".e3",
                    length(entry.value.items[1], "the length")}});
  }
  pairs(value, all);
}

void ContactTable::shapes(const Value& value) {
  if (!value.is(Value::Kind::table) || value.entries.size() < 2)
    fail(value, "needs two shapes", "write shapes = { A = { capsule = [\"R\", \"L\"] }, B = { sphere = \"R\" }, .. }");
  std::vector<Part> all;
  for (const Entry& entry : value.entries)
    all.push_back({text_value(entry.value, entry.key), core_of(entry.value, entry.key)});
  pairs(value, all);
}

void ContactTable::pairs(const Value& at, const std::vector<Part>& all) {
  for (const Part& part : all) {
    if (is_body(part.name.text)) continue;
    if (const Entry* friction = table_.entry("friction"))
      source_.fail(friction->span,
                   fmt::format("friction turns what it acts on, and {} is no body", quote(part.name.text)),
                   "remove friction, or give a [[body]] with its inertia");
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = i + 1; k < all.size(); ++k) pair(at, all[i], all[k]);
  }
}

void ContactTable::pair(const Value& at, const Part& a, const Part& b) {
  const bool bodies = is_body(a.name.text) && is_body(b.name.text);
  Names names{!bodies};
  const std::vector<Nearest> found = nearest_of_cores(a.core, b.core, names);
  if (found.empty()) refuse_pair(b.name, fmt::format("that of {}", quote(a.name.text)));
  const std::string suffix = a.name.text + "_" + b.name.text;
  if (bodies) return add_nearest(at, suffix, a.name, b.name, found[0], names, {});
  begin(at, suffix).entries.push_back({"holonomic", at.span, text_value(at, found[0].gap)});
}

namespace {

/// A number that is written, with its unit in brackets or without one.
struct WrittenNumber {
  ExactNumber number;
  std::string_view unit;
};

/// None: an expression.
std::optional<WrittenNumber> number_of(const Value& value) {
  if (!value.is(Value::Kind::integer) && !value.is(Value::Kind::real) && !value.is(Value::Kind::text)) return {};
  const bool is_negative = value.text.starts_with('-');
  const std::string_view text = std::string_view(value.text).substr(is_negative ? 1 : 0);
  const std::size_t unit = text.ends_with(']') ? text.find('[') : text.size();
  if (unit == std::string_view::npos) return {};
  ExactNumber number = parse_exact_number(text.substr(0, unit));
  if (!number.problem.empty()) return {};
  if (is_negative) number.value = -number.value;
  return WrittenNumber{std::move(number), text.substr(unit)};
}

}  // namespace

void ContactTable::limits(const Value& value) {
  if (!value.is(Value::Kind::table) || value.entries.empty())
    fail(value, "has no limits", "write limits = { q = [\"lower\", \"upper\"] }");
  for (const Entry& entry : value.entries) {
    const std::vector<Value>& ends = list(entry.value, "the limits of " + quote(entry.key));
    if (ends.size() != 2)
      fail(entry.value, fmt::format("gives {} limits of {}", ends.size(), quote(entry.key)),
           "write [\"lower\", \"upper\"]");
    const std::array<std::optional<WrittenNumber>, 2> numbers{number_of(ends[0]), number_of(ends[1])};
    if (numbers[0] && numbers[1] && numbers[0]->unit == numbers[1]->unit &&
        numbers[0]->number.value >= numbers[1]->number.value)
      fail(entry.value,
           fmt::format("has limits of {} of which the lower one is not below the upper one", quote(entry.key)),
           "write [\"lower\", \"upper\"]");
    begin(ends[0], entry.key + "_lower")
        .entries.push_back({"holonomic", entry.span,
                            text_value(ends[0], fmt::format("{} - {}", entry.key, expression(ends[0], "a limit")))});
    begin(ends[1], entry.key + "_upper")
        .entries.push_back({"holonomic", entry.span,
                            text_value(ends[1], fmt::format("{} - {}", expression(ends[1], "a limit"), entry.key))});
  }
}

namespace {

/// Adds entries to a section, which may not exist yet.
void append(Value& root, const char* section, Span span, std::vector<Value> entries) {
  if (entries.empty()) return;
  const auto given =
      std::find_if(root.entries.begin(), root.entries.end(), [&](const Entry& entry) { return entry.key == section; });
  if (given == root.entries.end()) {
    Value list;
    list.kind = Value::Kind::array;
    list.span = span;
    list.items = std::move(entries);
    root.entries.push_back({section, span, std::move(list)});
    return;
  }
  if (!given->value.is(Value::Kind::array)) return;  // reported by its reader
  std::move(entries.begin(), entries.end(), std::back_inserter(given->value.items));
}

}  // namespace

std::vector<Value> expand_contacts(const Source& source, Value& root) {
  const auto found =
      std::find_if(root.entries.begin(), root.entries.end(), [](const Entry& entry) { return entry.key == "contact"; });
  if (found == root.entries.end()) return {};
  if (!found->value.is(Value::Kind::array))
    source.fail(found->span, "[contact] is a list of entries", "write [[contact]] with two brackets, once for each");
  Sections sections;
  for (const Value& table : found->value.items) {
    if (!table.is(Value::Kind::table))
      source.fail(table.span, fmt::format("a [[contact]] is {}", kind_name(table.kind)),
                  "write [[contact]] and its keys below");
    ContactTable(source, root, table, sections).expand();
  }
  const Span span = found->span;
  root.entries.erase(found);
  append(root, "constraint", span, std::move(sections.constraints));
  append(root, "point", span, std::move(sections.points));
  append(root, "event", span, std::move(sections.events));
  if (sections.coordinates.empty()) return sections.lengths;
  if (root.find("coordinates") == nullptr) root.entries.push_back({"coordinates", span, Value{}});
  for (Entry& entry : root.entries) {
    if (entry.key == "coordinates")
      std::move(sections.coordinates.begin(), sections.coordinates.end(), std::back_inserter(entry.value.entries));
  }
  return sections.lengths;
}

}  // namespace eomgen::model
