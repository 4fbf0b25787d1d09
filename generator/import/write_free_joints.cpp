// SPDX-License-Identifier: GPL-3.0-or-later
// Damping d and armature a of joints that turn freely: ball and floating joints.
// Equations: the moment -d w and, of floating joints, the force -d v; the kinetic energy a w^2/2 and a v^2/2. w is the
// angular velocity relative to the link before. |w|^2 = 4 sum e_i_dot^2 for Euler parameters. On the ground a w^2/2 is
// the energy of an inertia a about every axis of the link.
#include <fmt/format.h>

#include <algorithm>

#include "import/model_text.hpp"

namespace eomgen::import {

bool ModelWriter::turns_freely(std::size_t joint) const {
  const JointType type = robot_.joints[joint].type;
  return type == JointType::floating || type == JointType::ball;
}

const Part& ModelWriter::part_of_joint(std::size_t joint) const {
  return *std::find_if(assembly_.parts.begin(), assembly_.parts.end(),
                       [&](const Part& part) { return part.joint == joint; });
}

bool ModelWriter::is_on_ground(const Part& part) const { return part.parent == 0 && !options_.floating; }

/// Whether the inertia of the link contains the rotational armature of its joint.
bool ModelWriter::contains_armature(const Part& part) const {
  return part.joint != no_index && turns_freely(part.joint) && is_on_ground(part) && !part.inertia.mass.is_zero() &&
         !robot_.joints[part.joint].armature.is_zero();
}

/// Of each Euler parameter; empty if the armature is written otherwise.
std::string ModelWriter::armature_of_parameters(std::size_t joint) {
  const Number& armature = robot_.joints[joint].armature;
  if (armature.is_zero() || options_.attitude == Attitude::euler || contains_armature(part_of_joint(joint))) return "";
  return value(Number(4, "4") * armature, "kg*m^2", "a_" + joint_names_[joint]);
}

std::string ModelWriter::relative_rotation(const Part& part) const {
  const std::string own = fmt::format("omega({})", link_names_[part.link]);
  return is_on_ground(part) ? own
                            : fmt::format("({} - omega({}))", own, link_names_[assembly_.parts[part.parent].link]);
}

void ModelWriter::write_free_damping() {
  for (const std::size_t j : moving_joints()) {
    const Joint& joint = robot_.joints[j];
    if (!turns_freely(j) || joint.damping.is_zero()) continue;
    const Part& part = part_of_joint(j);
    const std::string& stem = joint_names_[j];
    const std::string moment =
        fmt::format("{}*{}", factor(joint.damping, "N*m*s", "d_" + stem), relative_rotation(part));
    const auto add = [&](const char* sign, const std::string& name, std::size_t link) {
      body_ += fmt::format("[[force]]\nname = \"{}\"\nmoment = \"{}{}\"\non = \"{}\"\n", names_.claim(name, "_force"),
                           sign, moment, link_names_[link]);
    };
    body_ += fmt::format("\n# Damping of {} (line {})\n", quoted(joint.name), joint.where.line);
    add("-", "damping_" + stem, part.link);
    if (!is_on_ground(part)) add("", "reaction_of_damping_" + stem, assembly_.parts[part.parent].link);
    if (joint.type == JointType::ball) continue;
    body_ +=
        fmt::format("[[force]]\nname = \"{}\"\n[force.generalized]\n", names_.claim("damping_along_" + stem, "_force"));
    const std::string along = factor(joint.damping, "N*s/m", "d_along_" + stem);
    for (const CoordinateText& coordinate : coordinates_)
      if (coordinate.joint == j && coordinate.unit == "m")
        body_ += fmt::format("{} = \"-{}*{}_dot\"\n", coordinate.name, along, coordinate.name);
  }
}

void ModelWriter::write_free_armature() {
  std::string kinetic;
  for (const std::size_t j : moving_joints()) {
    const Joint& joint = robot_.joints[j];
    if (!turns_freely(j) || joint.armature.is_zero() || options_.attitude != Attitude::euler) continue;
    const Part& part = part_of_joint(j);
    if (contains_armature(part)) continue;
    const std::string w = relative_rotation(part);
    kinetic += fmt::format("{}{}/2*dot({}, {})", kinetic.empty() ? "" : " + ",
                           factor(joint.armature, "kg*m^2", "a_" + joint_names_[j]), w, w);
  }
  if (!kinetic.empty()) body_ += fmt::format("\n# Armatures of ball joints.\n[energy]\nkinetic = \"{}\"\n", kinetic);
}

}  // namespace eomgen::import
