// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[joint]]: two ends with points and axes fixed in each, and the equations of the registry between them.
#pragma once

#include <optional>

#include "joints/joint.hpp"
#include "model/section_reader.hpp"
#include "model/start_substitution.hpp"

namespace eomgen::model {

class JointsReader : private SectionReader {
 public:
  explicit JointsReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  void read();

 private:
  struct JointEnd {
    std::uint32_t frame = 0;
    std::string name;
    TypedNode point;
    std::array<TypedNode, 3> axis;  // a, a1, a2, fixed in this body
  };
  void read_joint(Joint& joint, const Value& table);
  std::array<JointEnd, 2> joint_ends(const Value& table, const std::string& what);
  void joint_points(Joint& joint, std::array<JointEnd, 2>& ends, const Value& at, const std::string& what);
  void joint_axes(const joints::Joint& kind, std::array<JointEnd, 2>& ends, const Value& table,
                  const std::string& what);
  std::array<TypedNode, 3> triad_about(const Value& axis, const JointEnd& end, const std::string& what);
  /// k if the vector is E1, E2 or E3 and the body rotates about it only. It is then the body's own axis k at all times.
  std::optional<std::size_t> own_axis_of_plane(const TypedNode& vector, std::uint32_t frame) const;
  void axis_at_start(const TypedNode& direction, std::array<JointEnd, 2>& ends, StartSubstitution& start, Span span,
                     const std::string& what);
  StartSubstitution at_start(std::uint32_t constraint);
  TypedNode fixed_in_frame(const TypedNode& direction, std::uint32_t frame, StartSubstitution& start, Span span,
                           bool attitude = false);
};

}  // namespace eomgen::model
