// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of rolling = { .. } and sliding = { .. } of a [[constraint]]: a body on a plane or on another body.
#pragma once

#include <map>

#include "model/section_reader.hpp"

namespace eomgen::model {

class ContactsReader : private SectionReader {
 public:
  explicit ContactsReader(ReaderContext& context) : SectionReader(context) {}
  void read(Constraint& constraint, const Value& table, bool rolling, bool rough);

 private:
  std::map<std::string, TypedNode> plane_of_contact(const Value& on);
  /// "t1" and "t2" for the normal "n", unless the model gives a direction.
  void default_tangents(bool turns, Span span, std::map<std::string, TypedNode>& local);
  void tangent_of_contact(const Value& table, std::map<std::string, TypedNode>& local);
  void name_motion(std::uint32_t frame, const std::string& ending, Span span, std::map<std::string, TypedNode>& local);
  void read_contact_point(Constraint& constraint, const Value& table, const std::map<std::string, TypedNode>& local);
  /// Adds the radius of a shape as "R".
  TypedNode contact_arm(const Value& table, std::map<std::string, TypedNode>& local);
  void set_range_of_tilt(std::uint32_t frame, const Value& table, const std::map<std::string, TypedNode>& local);
  void draw_shapes(const BodyContact& contact, const Value& table, const std::map<std::string, TypedNode>& local);
  bool touches_body(const Value& on);
  void other_body(BodyContact& contact, const Value& on, std::map<std::string, TypedNode>& local);
  /// The text of psi; nothing for the general psi of two points and a normal.
  std::optional<std::string> between_bodies(BodyContact& contact, const Value& table,
                                            std::map<std::string, TypedNode>& local);
  /// Of a contact that [[contact]] wrote; the text of psi.
  std::string nearest_points(BodyContact& contact, const Value& table, std::map<std::string, TypedNode>& local);
  void spheres_in_contact(const Value& table, std::map<std::string, TypedNode>& local);
  void points_in_contact(const Value& table, std::map<std::string, TypedNode>& local);
};

}  // namespace eomgen::model
