// SPDX-License-Identifier: GPL-3.0-or-later
// An assembly as the text of a model file. Axes of bodies are those of links; a constant rotation between two joints is
// a [[frame]]. Positions start at the origin of the link before, so that the formulations over trees find the tree.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "import/assembly.hpp"
#include "import/import.hpp"

namespace eomgen::import {

/// Names of links and joints as legal names of a model, each once.
class Names {
 public:
  /// A legal name that nothing else has: `wanted` if it is one; else illegal characters become underscores, and
  /// `suffix` or a number is appended. Reserves it.
  std::string claim(std::string_view wanted, std::string_view suffix);

 private:
  std::set<std::string, std::less<>> taken_;
};

/// Expressions in the model language, with names of links and joints.
class ModelWriter {
 public:
  ModelWriter(const Robot& robot, const Tree& tree, const Assembly& assembly, const ImportOptions& options);
  ImportedModel write();

 private:
  struct CoordinateText {
    std::string name, unit, comment;
    std::size_t joint = no_index;
    Number start;
    std::string armature;
  };

  void name_coordinates();
  void name_free_coordinates(const std::string& prefix, std::size_t joint, const std::string& comment);
  void write_parts();
  void write_root(const Part& part);
  void write_joint(std::size_t index);
  void write_body(std::size_t index, const std::string& rotation, const std::string& axes_of);
  void write_fused(std::size_t index);
  void write_shapes(std::size_t index);
  void write_shape(const Shape& shape, const Pose& pose, const Vector& centre, std::vector<std::string>& texts);
  void write_mesh(const Shape& shape, const Pose& pose, const Vector& centre, std::vector<std::string>& texts);
  void write_turned(const Shape& shape, const Matrix& R, const Vector& middle, std::vector<std::string>& texts);
  void write_forces();
  void write_drives();
  std::string drive_force(std::size_t joint);
  void write_springs();
  void write_dissipation();
  void write_free_damping();
  void write_free_armature();
  bool turns_freely(std::size_t joint) const;
  bool is_on_ground(const Part& part) const;
  bool contains_armature(const Part& part) const;
  const Part& part_of_joint(std::size_t joint) const;
  std::string armature_of_parameters(std::size_t joint);
  std::string relative_rotation(const Part& part) const;
  void write_constraints();
  void write_stops(std::size_t joint);
  void write_scene();
  std::string header() const;
  bool has_gravity_along_z() const;
  bool does_gravity_work() const;
  std::string gravity_text() const;

  /// A number with its unit as a value: "0.5 m", or the name of a new parameter.
  std::string value(const Number& number, const std::string& unit, const std::string& name);
  /// The same within an expression: 0.5[m].
  std::string factor(const Number& number, const std::string& unit, const std::string& name);
  /// " + 0.5[m]*B.e1 - ..", along axes such as "B.e" or "E".
  std::string along(const Vector& v, const std::string& axes, const std::string& parameter);
  std::string place_name(std::size_t part) const;
  std::string axes_name(std::size_t part) const;
  std::string rotation_of(const std::string& prefix, bool free) const;
  bool is_actuated(std::size_t joint) const;
  std::vector<std::size_t> moving_joints() const;

  const Robot& robot_;
  const Tree& tree_;
  const Assembly& assembly_;
  const ImportOptions& options_;
  Names names_;
  Findings findings_;
  std::vector<std::string> joint_names_, link_names_;  // of joints: their coordinate or the stem of several
  std::vector<std::string> origins_;                   // of parts: a place
  std::vector<CoordinateText> coordinates_;
  std::string parameters_, inputs_, body_, draw_;
  bool gravity_works_ = true;
  std::size_t meshes_ = 0, mesh_bytes_ = 0;  // of the robot; read so far
  std::size_t points_of_solids_ = 0;         // written so far
  ImportedModel result_;
};

/// "panda_link1" as in the file, in a comment: control characters replaced, shortened.
std::string quoted(const std::string& name);
std::string toml_text(const std::string& text);

}  // namespace eomgen::import
