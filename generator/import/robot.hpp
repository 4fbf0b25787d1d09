// SPDX-License-Identifier: GPL-3.0-or-later
// A robot as its file describes it: links and joints, not yet a tree. Readers of formats produce it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "import/findings.hpp"
#include "import/rigid.hpp"

namespace eomgen::import {

enum class ShapeKind { box, cylinder, capsule, sphere, ellipsoid, mesh };

/// A shape for drawing: sides of a box; radius and length of a cylinder along its z axis, which in a capsule is between
/// two half spheres; radius of a sphere; half axes of an ellipsoid; factors of a mesh along its axes.
struct Shape {
  ShapeKind kind;
  Vector size;
  Pose pose;
  SourceLocation where;
  std::string file = {};  // of a mesh, as the robot file names it
};

struct Link {
  std::string name;
  SourceLocation where;
  Inertia inertia;  // along the link's axes; zero if it has none
  std::vector<Shape> shapes;
};

enum class JointType { revolute, continuous, prismatic, fixed, floating, planar, ball };
const char* name_of(JointType type);

struct Limits {
  std::optional<Number> lower, upper, effort, velocity;
  SourceLocation where;
};

/// q = multiplier q_master + offset.
struct Mimic {
  std::string master;
  Number multiplier, offset;
  SourceLocation where;
};

/// An input u of a joint with one coordinate q. The force on q is gear (gain u + offset + stiffness l + damping l_dot)
/// with the length l = gear q of the drive.
struct Drive {
  enum class Input { force, position, velocity };
  std::string name, comment;
  Input input = Input::force;
  Number gear, gain, offset, stiffness, damping;
};

struct Joint {
  std::string name;
  SourceLocation where;
  JointType type = JointType::fixed;
  std::string parent, child;
  SourceLocation parent_where, child_where;
  Pose origin;  // of the child's axes at zero, in the parent's
  Vector axis;  // a unit vector along the child's axes; of fixed and floating joints unused
  Limits limits;
  // Of ball and floating joints for each component of the angular velocity, and of the velocity.
  Number damping, friction, armature;
  Number stiffness, spring_reference;  // the force -stiffness (q - spring_reference)
  Vector start;                        // of a floating joint: its place at the start
  bool moves_along_parent = false;     // of a floating joint: its place is along the axes of the parent, not its own
  std::optional<Mimic> mimic;
  std::optional<std::string> transmission;  // its name, if there is one
  std::vector<Drive> drives;
};

struct Robot {
  std::string name, file;
  SourceLocation where;
  std::vector<Link> links;
  std::vector<Joint> joints;
  Vector gravity{Number(), Number(), Number(-9.81L, "-9.81")};
  Findings findings;
};

}  // namespace eomgen::import
