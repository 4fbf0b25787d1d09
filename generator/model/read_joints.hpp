// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[joint]]: two ends with points and axes fixed in each, and the equations of the registry between them.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "joints/joint.hpp"
#include "model/model.hpp"
#include "model/section_reader.hpp"

namespace eomgen::model {

/// Evaluation of expressions at the start of the default scene: coordinates are replaced by the initial values of the
/// scene (default 0) and t by the start of the run. The result depends on parameters only.
class StartSubstitution {
 public:
  /// Adds nodes to the arena of the model, whose scenes must have been read. `open` coordinates have no default of 0:
  /// other conditions determine them.
  StartSubstitution(Model& model, std::set<std::uint32_t> open) : model_(model), open_(std::move(open)) {}

  /// The vector or scalar at the start; no_node if it cannot be determined. obstacle() then contains the reason.
  NodeId operator()(NodeId node);
  const std::string& obstacle() const { return obstacle_; }

 private:
  NodeId replaced(NodeId id);
  NodeId reference(const Node& node);
  NodeId coordinate(const Node& node);
  NodeId push(Node node);

  Model& model_;
  std::set<std::uint32_t> open_;
  std::map<NodeId, NodeId> known_;
  std::string obstacle_;
};

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
