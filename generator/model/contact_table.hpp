// SPDX-License-Identifier: GPL-3.0-or-later
// A [[contact]] and the constraints that it stands for. In: the table as written. Out: entries of other sections.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "model/contact_shapes.hpp"
#include "model/document.hpp"

namespace eomgen::model {

/// The sections that contacts become.
struct Sections {
  std::vector<Value> constraints, points, events;
  std::vector<Value> lengths;  // of shapes, which must not be negative
  std::vector<Entry> coordinates;
};

/// A text that eomgen writes; an error points to `at`.
Value text_value(const Value& at, std::string text);
Value empty_table(const Value& at);

class ContactTable {
 public:
  ContactTable(const Source& source, const Value& root, const Value& table, Sections& sections)
      : source_(source),
        root_(root),
        table_(table),
        constraints_(sections.constraints),
        points_(sections.points),
        events_(sections.events),
        lengths_(sections.lengths),
        coordinates_(sections.coordinates) {}
  void expand();

 private:
  /// A shape about a body or a particle.
  struct Part {
    Value name;
    Core core;
  };

  // expand_contacts.cpp
  [[noreturn]] void fail(const Value& at, const std::string& what, const std::string& remedy) const;
  const Value& require(const char* key, const char* remedy) const;
  void require_text(const Value& value, const std::string& what) const;
  /// An expression, as written, in parentheses. A unit behind it, as in "2 m", stands in brackets.
  std::string expression(const Value& value, const std::string& what) const;
  /// The same of a length of a shape, which must not be negative.
  std::string length(const Value& value, const std::string& what) const;
  /// The same of a vector, which may be three components.
  std::string vector(const Value& value, const std::string& what) const;
  const std::vector<Value>& list(const Value& value, const std::string& what) const;
  Value& begin(const Value& at, const std::string& suffix);
  void particles(const Value& value);
  /// The gap of a ball about a particle, by the name of the particle. `radius`: where its size is written, or null.
  std::function<std::string(const std::string&)> gap_of_particle(const Value& on, const Value* radius,
                                                                 const std::string& size) const;
  void spheres(const Value& value);
  void capsules(const Value& value);
  void shapes(const Value& value);
  void pairs(const Value& at, const std::vector<Part>& all);
  void pair(const Value& at, const Part& a, const Part& b);
  void limits(const Value& value);

  // expand_body_contacts.cpp
  const Value& body() const;
  const Value& on() const;
  bool is_body(const std::string& name) const;
  /// Whether `on` is a plane, which has points of contact of its own.
  bool is_on_plane() const;
  /// A point of the body, by a vector from its centre of mass.
  void add_point(const Value& at, const std::string& suffix, const std::string& arm);
  /// A shape of the body on what `on` names. Several contacts are numbered.
  void add_core(const Value& at, const std::string& suffix, const Core& core);
  [[noreturn]] void refuse_pair(const Value& at, const std::string& what) const;
  /// The contact of a body where it is nearest to another body or to an obstacle.
  void add_nearest(const Value& at, const std::string& suffix, const Value& body, const Value& on,
                   const Nearest& nearest, const Names& names, const std::vector<Value>& at_rest);
  /// On the surface z = f(x, y), from above.
  void add_on_surface(const Value& at, const std::string& suffix, const Core& core, const std::string& f);
  void points(const Value& value);
  void corners(const Value& value);
  /// The unit normal of the plane under a body.
  std::string normal_of(const Value& on) const;
  /// The sizes of a shape, and its kind.
  std::pair<const BodyShape*, std::vector<std::string>> sizes_of(const Value& value) const;
  Core core_of(const Value& value, const std::string& body) const;
  void shape(const Value& value);
  /// The values of an obstacle: of its key, then of the further ones.
  std::vector<std::string> values_of(const Value& on, const Obstacle& kind) const;

  // expand_tracked_contacts.cpp
  /// The nearest points, and their gap, of a core.
  using Approach = std::function<std::vector<Nearest>(const Core&, Names&)>;
  /// Coordinates that `equations` determine; the point is nearest while `room` is positive.
  void follow(const Value& at, const std::string& name, const std::vector<std::string>& equations,
              const std::string& room);
  /// The end of a run where one of the heights falls below the limit.
  void stop_below(const Value& at, const std::string& name, const std::vector<std::string>& heights,
                  const std::string& limit);
  void foot_of(const Value& at, const std::string& name, const std::string& f);
  void stop_beside(const Value& at, const std::string& name, const Core& ball, const std::string& f);
  void ball_on_surface(const Value& at, const std::string& suffix, const Core& ball, const std::string& f);
  void capsule_on_surface(const Value& at, const Core& capsule, const std::string& f);
  /// through_face: distances that are negative where the other shape has passed through the face of the disk.
  void rim(const Value& at, const Core& disk, const Approach& approach, const std::vector<Value>& at_rest,
           const std::vector<std::string>& through_face);
  void rim_on_surface(const Value& at, const Core& disk, const std::string& f);

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

  const Source& source_;
  const Value& root_;
  const Value& table_;
  std::vector<Value>& constraints_;
  std::vector<Value>& points_;
  std::vector<Value>& events_;
  std::vector<Value>& lengths_;
  std::vector<Entry>& coordinates_;
  std::string name_;
};

}  // namespace eomgen::model
