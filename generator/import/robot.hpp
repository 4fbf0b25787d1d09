// SPDX-License-Identifier: GPL-3.0-or-later
// A robot as its file describes it: links and joints, not yet a tree. Readers of formats produce it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "import/findings.hpp"
#include "import/rigid.hpp"

namespace eomgen::import {

enum class ShapeKind { box, cylinder, sphere };

/// A shape for drawing: sides of a box; radius and length of a cylinder along its z axis; radius of a sphere.
struct Shape {
  ShapeKind kind;
  Vector size;
  Pose pose;
  SourceLocation where;
};

struct Link {
  std::string name;
  SourceLocation where;
  Inertia inertia;  // along the link's axes; zero if it has none
  std::vector<Shape> shapes;
};

enum class JointType { revolute, continuous, prismatic, fixed, floating, planar };
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

struct Joint {
  std::string name;
  SourceLocation where;
  JointType type = JointType::fixed;
  std::string parent, child;
  SourceLocation parent_where, child_where;
  Pose origin;  // of the child's axes at zero, in the parent's
  Vector axis;  // a unit vector along the child's axes; of fixed and floating joints unused
  Limits limits;
  Number damping, friction;
  std::optional<Mimic> mimic;
  std::optional<std::string> transmission;  // its name, if there is one
};

struct Robot {
  std::string name, file;
  SourceLocation where;
  std::vector<Link> links;
  std::vector<Joint> joints;
  Findings findings;
};

}  // namespace eomgen::import
