// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/expand_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/contact_shapes.hpp"
#include "model/names.hpp"
#include "model/syntax.hpp"

namespace eomgen::model {
namespace {

Value text_value(const Value& at, std::string text) {
  Value value;
  value.kind = Value::Kind::text;
  value.span = at.span;
  value.begin = at.begin;
  value.text_offsets.assign(text.size() + 1, at.begin);  // an error points to the table or to what was given there
  value.text = std::move(text);
  return value;
}

class ContactTable {
 public:
  ContactTable(const Source& source, const Value& table, std::vector<Value>& constraints)
      : source_(source), table_(table), constraints_(constraints) {}

  void expand() {
    const Value& name = require("name", "add name = \"..\"");
    require_text(name, "the name");
    name_ = name.text;
    struct Kind {
      const char* key;
      std::vector<std::string_view> further;
      void (ContactTable::*expand)(const Value&);
    };
    const std::array<Kind, 7> kinds{{{"points", {"body", "on", "friction"}, &ContactTable::points},
                                     {"corners", {"body", "on", "friction"}, &ContactTable::corners},
                                     {"shape", {"body", "on", "friction"}, &ContactTable::shape},
                                     {"spheres", {"radius", "friction"}, &ContactTable::spheres},
                                     {"capsules", {"friction"}, &ContactTable::capsules},
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
           "add points = { .. }, corners = [a, b, c] or shape = { .. } of a body, spheres = [\"A\", \"B\", ..], "
           "capsules = { A = [R, L], .. }, particles = [\"P\", ..], or limits = { q = [a, b] }");
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

 private:
  [[noreturn]] void fail(const Value& at, const std::string& what, const std::string& remedy) const {
    source_.fail(at.span, fmt::format("the [[contact]]{} {}", name_.empty() ? "" : " " + quote(name_), what), remedy);
  }
  const Value& require(const char* key, const char* remedy) const {
    const Value* value = table_.find(key);
    if (value == nullptr) fail(table_, fmt::format("has no {}", key), remedy);
    return *value;
  }
  void require_text(const Value& value, const std::string& what) const {
    if (!value.is(Value::Kind::text))
      fail(value, fmt::format("gives {} as {}", what, kind_name(value.kind)), "write it in quotes");
  }
  /// An expression, as written, in parentheses. A unit behind it, as in "2 m", stands in brackets.
  std::string expression(const Value& value, const std::string& what) const {
    if (!value.is(Value::Kind::text) && !value.is(Value::Kind::integer) && !value.is(Value::Kind::real))
      fail(value, fmt::format("gives {} as {}", what, kind_name(value.kind)), "write an expression or a number");
    return "(" + bracket_unit(value.text) + ")";
  }
  const std::vector<Value>& list(const Value& value, const std::string& what) const {
    if (!value.is(Value::Kind::array))
      fail(value, fmt::format("gives {} as {}", what, kind_name(value.kind)), "write a list in brackets");
    return value.items;
  }

  Value& begin(const Value& at, const std::string& suffix) {
    if (constraints_.size() >= max_contacts_of_tables)
      fail(at, fmt::format("makes more than {} contacts", max_contacts_of_tables), "split the model");
    Value constraint;
    constraint.kind = Value::Kind::table;
    constraint.span = at.span;
    constraint.begin = at.begin;
    constraint.entries.push_back({"name", at.span, text_value(at, name_ + "_" + suffix)});
    constraint.entries.push_back({"holds", at.span, text_value(at, "unilateral")});
    for (const char* key : {"restitution", "friction"}) {
      if (const Entry* entry = table_.entry(key)) constraint.entries.push_back(*entry);
    }
    constraints_.push_back(std::move(constraint));
    return constraints_.back();
  }

  /// A point of the body, by a vector from its centre of mass.
  void add_point(const Value& at, const std::string& suffix, const std::string& arm) {
    Value& constraint = begin(at, suffix);
    Value sliding;
    sliding.kind = Value::Kind::table;
    sliding.span = at.span;
    sliding.begin = at.begin;
    sliding.entries.push_back({"body", at.span, require("body", "add body = \"B\", whose points touch")});
    sliding.entries.push_back({"at", at.span, text_value(at, arm)});
    sliding.entries.push_back({"on", at.span, require("on", "add on = \"ground\", or a plane")});
    constraint.entries.push_back({"sliding", at.span, std::move(sliding)});
  }
  void points(const Value& value) {
    if (!value.is(Value::Kind::table) || value.entries.empty())
      fail(value, "has no points", "write points = { heel = \"<vector from the centre of mass>\", toe = \"..\" }");
    for (const Entry& entry : value.entries) add_point(entry.value, entry.key, expression(entry.value, "a point"));
  }
  void corners(const Value& value) {
    const std::vector<Value>& edges = list(value, "the edges");
    if (edges.size() != 3)
      fail(value, fmt::format("gives {} edges", edges.size()),
           "write corners = [\"a\", \"b\", \"c\"], the lengths along e1, e2, e3");
    const Value& body = require("body", "add body = \"B\", whose corners touch");
    require_text(body, "the body");
    for (std::size_t corner = 0; corner < 8; ++corner) {
      std::string arm;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool positive = (corner >> (2 - k) & 1) != 0;
        arm += fmt::format("{}{}/2*{}.e{}", positive ? (k == 0 ? "" : " + ") : (k == 0 ? "-" : " - "),
                           expression(edges[k], "an edge"), body.text, k + 1);
      }
      add_point(value, std::to_string(corner + 1), arm);
    }
  }

  /// The only entry of a table that names one of the kinds of `all`. further: other keys of that kind.
  template <class Kinds>
  const auto& kind_of(const Value& table, const Kinds& all, const std::string& what) const {
    std::vector<std::string> names;
    for (const auto& kind : all) names.emplace_back(kind.name);
    if (table.is(Value::Kind::table)) {
      for (const auto& kind : all) {
        if (table.find(kind.name) != nullptr) return kind;
      }
    }
    fail(table, fmt::format("names no {}", what), fmt::format("the kinds are {}", fmt::join(names, ", ")));
  }

  /// The unit normal of the plane under a body.
  std::string normal_of(const Value& on) const {
    if (on.is(Value::Kind::text) && on.text == "ground") return "E3";
    const Value* normal = on.is(Value::Kind::table) ? on.find("normal") : nullptr;
    if (normal == nullptr)
      fail(on, "has a shape, which touches planes",
           "write on = \"ground\", or on = { point = \"..\", normal = \"..\" }");
    return "unit(" + expression(*normal, "the normal") + ")";
  }

  void shape(const Value& value) {
    const BodyShape& kind = kind_of(value, body_shapes(), "shape");
    if (value.entries.size() != 1)
      fail(value, "has a shape with several kinds", fmt::format("write shape = {{ {} = .. }} alone", kind.name));
    const Value& body = require("body", "add body = \"B\", whose surface touches");
    require_text(body, "the body");
    const Value& given = *value.find(kind.name);
    std::vector<std::string> sizes;
    if (kind.sizes.size() == 1) {
      sizes.push_back(expression(given, fmt::format("the {}", kind.sizes[0])));
    } else {
      const std::vector<Value>& items = list(given, fmt::format("the sizes of the {}", kind.name));
      if (items.size() != kind.sizes.size())
        fail(given, fmt::format("gives {} sizes of the {}", items.size(), kind.name),
             fmt::format("write {} = [{}]", kind.name, fmt::join(kind.sizes, ", ")));
      for (std::size_t k = 0; k < items.size(); ++k)
        sizes.push_back(expression(items[k], fmt::format("the {}", kind.sizes[k])));
    }
    const std::string normal = normal_of(require("on", "add on = \"ground\", or a plane"));
    std::size_t count = 0;
    for (const std::string& point : kind.points(body.text, sizes, normal))
      add_point(value, std::to_string(++count), point);
  }

  void particles(const Value& value) {
    const std::vector<Value>& names = list(value, "the particles");
    if (names.empty()) fail(value, "has no particles", "write particles = [\"P\", ..]");
    const Value& on = require("on", "add on = { sphere = \"R\", centre = \"..\" }, or another obstacle");
    const Obstacle& kind = kind_of(on, obstacles(), "obstacle");
    std::vector<std::string> values{expression(*on.find(kind.name), fmt::format("the {}", kind.name))};
    for (const char* key : kind.further) {
      const Value* further = on.find(key);
      if (further == nullptr) fail(on, fmt::format("has no {}", key), fmt::format("add {} = \"..\"", key));
      values.push_back(expression(*further, fmt::format("the {}", key)));
    }
    for (const Entry& entry : on.entries) {
      const bool known = entry.key == kind.name ||
                         std::find(kind.further.begin(), kind.further.end(), entry.key) != kind.further.end();
      if (!known)
        source_.fail(entry.span, fmt::format("a {} that particles touch has no key {}", kind.name, quote(entry.key)),
                     kind.further.empty()
                         ? "remove it"
                         : fmt::format("its keys are {}, {}", kind.name, fmt::join(kind.further, ", ")));
    }
    const Value* radius = table_.find("radius");
    if (radius != nullptr && std::string_view(kind.name) == "surface")
      fail(*radius, "gives a radius, and a ball touches a surface beside the point below it", "remove radius");
    const std::string size = radius == nullptr ? "0" : expression(*radius, "the radius");
    for (const Value& name : names) {
      require_text(name, "a particle");
      begin(name, name.text)
          .entries.push_back({"holonomic", value.span, text_value(name, kind.gap(name.text, values, size))});
    }
  }

  void spheres(const Value& value) {
    const std::vector<Value>& names = list(value, "the spheres");
    if (names.size() < 2) fail(value, "needs two spheres", "write spheres = [\"A\", \"B\", ..]");
    const std::string radius = expression(require("radius", "add radius = \"R\", that of each sphere"), "the radius");
    for (const Value& name : names) require_text(name, "a sphere");
    if (const Entry* friction = table_.entry("friction"))
      source_.fail(friction->span, "spheres of one [[contact]] have no friction",
                   "write sliding = { body, on, shape, shape_b } of each pair, with friction");
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (std::size_t k = i + 1; k < names.size(); ++k) {
        const std::string apart = fmt::format("({} - {})", names[k].text, names[i].text);
        Value& constraint = begin(value, names[i].text + "_" + names[k].text);
        constraint.entries.push_back(
            {"holonomic", value.span, text_value(value, fmt::format("sqrt(dot({0}, {0})) - 2*{1}", apart, radius))});
      }
    }
  }

  void capsules(const Value& value) {
    if (!value.is(Value::Kind::table) || value.entries.size() < 2)
      fail(value, "needs two capsules or balls", "write capsules = { A = [\"R\", \"L\"], ball = \"R\", .. }");
    if (const Entry* friction = table_.entry("friction"))
      source_.fail(friction->span, "capsules of one [[contact]] have no friction",
                   "remove friction; capsules on a plane (shape = { capsule = [R, L] }) can have it");
    std::vector<Capsule> all;
    for (const Entry& entry : value.entries) {
      if (!entry.value.is(Value::Kind::array)) {
        all.push_back({entry.key, expression(entry.value, "the radius"), ""});
        continue;
      }
      if (entry.value.items.size() != 2)
        fail(entry.value, fmt::format("gives {} sizes of {}", entry.value.items.size(), quote(entry.key)),
             "write [radius, length between the centres of the ends], or the radius of a ball alone");
      all.push_back(
          {entry.key, expression(entry.value.items[0], "the radius"), expression(entry.value.items[1], "the length")});
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = i + 1; k < all.size(); ++k) {
        begin(value, all[i].centre + "_" + all[k].centre)
            .entries.push_back({"holonomic", value.span, text_value(value, gap_of_capsules(all[i], all[k]))});
      }
    }
  }

  void limits(const Value& value) {
    if (!value.is(Value::Kind::table) || value.entries.empty())
      fail(value, "has no limits", "write limits = { q = [\"lower\", \"upper\"] }");
    for (const Entry& entry : value.entries) {
      const std::vector<Value>& ends = list(entry.value, "the limits of " + quote(entry.key));
      if (ends.size() != 2)
        fail(entry.value, fmt::format("gives {} limits of {}", ends.size(), quote(entry.key)),
             "write [\"lower\", \"upper\"]");
      begin(ends[0], entry.key + "_lower")
          .entries.push_back({"holonomic", entry.span,
                              text_value(ends[0], fmt::format("{} - {}", entry.key, expression(ends[0], "a limit")))});
      begin(ends[1], entry.key + "_upper")
          .entries.push_back({"holonomic", entry.span,
                              text_value(ends[1], fmt::format("{} - {}", expression(ends[1], "a limit"), entry.key))});
    }
  }

  const Source& source_;
  const Value& table_;
  std::vector<Value>& constraints_;
  std::string name_;
};

}  // namespace

void expand_contacts(const Source& source, Value& root) {
  const auto found =
      std::find_if(root.entries.begin(), root.entries.end(), [](const Entry& entry) { return entry.key == "contact"; });
  if (found == root.entries.end()) return;
  if (!found->value.is(Value::Kind::array))
    source.fail(found->span, "[contact] is a list of entries", "write [[contact]] with two brackets, once for each");
  std::vector<Value> constraints;
  for (const Value& table : found->value.items) {
    if (!table.is(Value::Kind::table))
      source.fail(table.span, fmt::format("a [[contact]] is {}", kind_name(table.kind)),
                  "write [[contact]] and its keys below");
    ContactTable(source, table, constraints).expand();
  }
  const Span span = found->span;
  root.entries.erase(found);
  const auto given = std::find_if(root.entries.begin(), root.entries.end(),
                                  [](const Entry& entry) { return entry.key == "constraint"; });
  if (given == root.entries.end()) {
    Value list;
    list.kind = Value::Kind::array;
    list.span = span;
    list.items = std::move(constraints);
    root.entries.push_back({"constraint", span, std::move(list)});
    return;
  }
  if (!given->value.is(Value::Kind::array)) return;  // reported by its reader
  std::move(constraints.begin(), constraints.end(), std::back_inserter(given->value.items));
}

}  // namespace eomgen::model
