// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of an MJCF file that hold for all of its elements: <compiler> and <default> classes. They give values to
// attributes that elements do not state, and meaning to angles and orientations.
// Equations: rotations by quaternions, axis and angle, Euler angles in any sequence, two axes, one axis.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "import/import.hpp"
#include "import/rigid.hpp"
#include "import/xml.hpp"

namespace eomgen::import {

/// An element and the class whose defaults hold for it.
struct MjcfElement {
  const Element& element;
  std::size_t defaults;
};

class MjcfSettings {
 public:
  /// Reads <compiler> and <default>. The root element must outlive this object.
  MjcfSettings(const Element& root, const ImportOptions& options, Findings& findings);

  /// The class of an element: the one that it names, or else `childclass`. Throws Error for unknown names.
  MjcfElement with_defaults(const Element& element, std::size_t childclass) const;
  /// The class that an attribute childclass="..." names; `current` without one.
  std::size_t childclass_of(const Element& element, std::size_t current) const;
  static constexpr std::size_t main_class = 0;

  /// An attribute that the element or its class states; nullptr without one.
  const Attribute* find(const MjcfElement& at, std::string_view attribute) const;
  /// Its number, or `otherwise`.
  Number number(const MjcfElement& at, std::string_view attribute, const Number& otherwise) const;
  Vector vector(const MjcfElement& at, std::string_view attribute, const Vector& otherwise) const;
  /// true, false; nothing for "auto" or without the attribute.
  std::optional<bool> flag(const MjcfElement& at, std::string_view attribute) const;

  /// The rotation that one of quat, axisangle, euler, xyaxes, zaxis states; nothing without one.
  std::optional<Matrix> rotation(const MjcfElement& at) const;
  /// pos and the rotation.
  Pose pose(const MjcfElement& at) const;
  /// The value in radians of a number that is an angle in the file.
  Number radians(const Number& angle) const;

  /// A mesh of <asset>: its file and factors along its axes.
  struct MeshAsset {
    std::string file;
    Vector scale;
  };
  /// By its name; nullptr if it has no file.
  const MeshAsset* mesh(const std::string& name) const;

  enum class FromGeoms { when_missing, always, never };
  FromGeoms inertia_from_geoms() const { return from_geoms_; }
  bool has_automatic_limits() const { return automatic_limits_; }

 private:
  struct Class {
    std::optional<std::size_t> parent;
    std::map<std::pair<std::string, std::string>, const Attribute*> values;  // by element and attribute
  };

  void read_meshes(const Element& assets);
  void read_compiler(const Element& element, Findings& findings);
  void read_defaults(const Element& element, std::optional<std::size_t> parent);
  std::size_t class_named(const Attribute& name) const;
  const Attribute* orientation_of(const MjcfElement& at) const;
  long double angle(const Number& number) const;
  Matrix by_euler(const Vector& angles) const;

  bool in_degrees_ = true, exact_angles_ = false, automatic_limits_ = true;
  std::string sequence_ = "xyz", mesh_folder_;
  std::map<std::string, MeshAsset> meshes_;
  FromGeoms from_geoms_ = FromGeoms::when_missing;
  std::vector<Class> classes_;
  std::map<std::string, std::size_t> names_;
};

/// The shortest rotation that turns the z axis into a direction, which need not have the length 1.
Matrix from_z_axis(const std::array<long double, 3>& direction);

}  // namespace eomgen::import
