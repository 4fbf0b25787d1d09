// SPDX-License-Identifier: GPL-3.0-or-later
// URDF, the Unified Robot Description Format. liburdfdom, its reference reader, gives no lines of the file and reports
// errors on a log of its own, so the file is read here on an XML library.
// In: <robot> with <link>, <joint>, <transmission>. Out: Robot; the rest is in its findings.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "import/import.hpp"
#include "import/robot.hpp"
#include "import/xml.hpp"
#include "model/names.hpp"

namespace eomgen::import {
namespace {

class UrdfReader {
 public:
  UrdfReader(const Element& root, const ImportOptions& options) : root_(root), options_(options) {}

  Robot read() {
    robot_.where = root_.where;
    robot_.file = root_.where.file;
    robot_.name = require_attribute(root_, "name").value;
    report_unknown(root_, {"name", "version"}, {"link", "joint", "transmission", "material"}, robot_.findings);
    for (const Element& child : root_.children) {
      if (child.name == "link") read_link(child);
      if (child.name == "joint") read_joint(child);
      if (child.name == "material") omit(child, "colours are not drawn");
    }
    for (const Element& child : root_.children)
      if (child.name == "transmission") read_transmission(child);
    if (robot_.links.empty()) fail(root_.where, "the robot has no link", "add <link name=\"..\">");
    return std::move(robot_);
  }

 private:
  void omit(const Element& element, const std::string& why) {
    robot_.findings.add(fmt::format("<{}>", element.name), why, element.where);
  }

  Vector read_angles(const Attribute& attribute) {
    Vector rpy = vector_of(attribute);
    if (options_.exact_angles) return rpy;
    for (Number& angle : rpy) {
      const std::optional<Number> multiple = multiple_of_pi(angle);
      if (!multiple) continue;
      if (std::fabs(multiple->value - angle.value) > 1e-15L * std::fabs(angle.value))
        robot_.findings.add("decimals of pi",
                            "angles that are multiples of pi/12 in the digits given are these multiples",
                            attribute.where);
      angle = *multiple;
    }
    return rpy;
  }

  Pose read_origin(const Element& owner) {
    Pose pose;
    const Element* origin = only_child(owner, "origin");
    if (origin == nullptr) return pose;
    report_unknown(*origin, {"xyz", "rpy"}, {}, robot_.findings);
    if (const Attribute* xyz = origin->find("xyz")) pose.p = vector_of(*xyz);
    if (const Attribute* rpy = origin->find("rpy")) {
      pose.rpy = read_angles(*rpy);
      pose.R = rotation(*pose.rpy);
    }
    return pose;
  }

  void require_new_name(const Element& element, const std::string& name, std::map<std::string, SourceLocation>& taken) {
    const auto [place, fresh] = taken.emplace(name, element.where);
    if (!fresh)
      fail(element.where,
           fmt::format("there are two {}s {}; the first is in line {}", element.name, model::quote(name),
                       place->second.line),
           "give each its own name");
  }

  void read_link(const Element& element) {
    Link link;
    link.name = require_attribute(element, "name").value;
    link.where = element.where;
    require_new_name(element, link.name, link_names_);
    report_unknown(element, {"name"}, {"inertial", "visual", "collision"}, robot_.findings);
    if (const Element* inertial = only_child(element, "inertial")) link.inertia = read_inertia(*inertial, link.name);
    for (const Element& child : element.children) {
      if (child.name == "visual") read_visual(child, link);
      if (child.name == "collision") omit(child, "contacts between links are not imported");
    }
    robot_.links.push_back(std::move(link));
  }

  Inertia read_inertia(const Element& element, const std::string& link) {
    report_unknown(element, {}, {"origin", "mass", "inertia"}, robot_.findings);
    const Attribute& mass = require_attribute(require_child(element, "mass"), "value");
    Inertia result;
    result.mass = number_of(mass);
    if (result.mass.value < 0)
      fail(mass.where, fmt::format("the mass of the link {} is negative", model::quote(link)),
           "a mass is above 0; a link without mass has no <inertial>");
    const Element& tensor = require_child(element, "inertia");
    constexpr std::array<std::array<const char*, 3>, 3> names{
        {{"ixx", "ixy", "ixz"}, {"ixy", "iyy", "iyz"}, {"ixz", "iyz", "izz"}}};
    report_unknown(tensor, {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}, {}, robot_.findings);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        // Products of inertia that are left out are 0; moments are needed.
        const Attribute* entry = i == k ? &require_attribute(tensor, names[i][k]) : tensor.find(names[i][k]);
        if (entry != nullptr) result.tensor[i][k] = number_of(*entry);
      }
    if (!is_positive_semidefinite(result.tensor))
      fail(tensor.where, fmt::format("the inertia tensor of the link {} is not positive definite", model::quote(link)),
           "it is about the centre of mass; ixy, ixz, iyz are the off-diagonal entries, with their signs");
    if (!satisfies_triangle_inequality(result.tensor))
      robot_.findings.add("inertia tensors that no body has",
                          "one principal moment is larger than the other two together; the values are kept",
                          tensor.where);
    return read_origin(element) * result;
  }

  void read_visual(const Element& element, Link& link) {
    report_unknown(element, {"name"}, {"origin", "geometry", "material"}, robot_.findings);
    if (const Element* material = only_child(element, "material")) omit(*material, "colours are not drawn");
    const Element& geometry = require_child(element, "geometry");
    const Pose pose = read_origin(element);
    for (const Element& child : geometry.children) {
      Shape shape{ShapeKind::box, {}, pose, child.where};
      if (child.name == "box") {
        shape.size = vector_of(require_attribute(child, "size"));
      } else if (child.name == "cylinder") {
        shape.kind = ShapeKind::cylinder;
        shape.size[0] = number_of(require_attribute(child, "radius"));
        shape.size[1] = number_of(require_attribute(child, "length"));
      } else if (child.name == "sphere") {
        shape.kind = ShapeKind::sphere;
        shape.size[0] = number_of(require_attribute(child, "radius"));
      } else if (child.name == "mesh") {
        shape.kind = ShapeKind::mesh;
        shape.file = require_attribute(child, "filename").value;
        shape.size = {Number(1, "1"), Number(1, "1"), Number(1, "1")};
        if (const Attribute* scale = child.find("scale")) shape.size = vector_of(*scale);
        link.shapes.push_back(std::move(shape));
        continue;
      } else {
        omit(child, "boxes, cylinders, spheres and meshes are drawn");
        continue;
      }
      const std::size_t lengths = shape.kind == ShapeKind::box ? 3 : shape.kind == ShapeKind::cylinder ? 2 : 1;
      const bool is_drawable =
          std::all_of(shape.size.begin(), shape.size.begin() + lengths, [](const Number& x) { return x.value > 0; });
      if (is_drawable)
        link.shapes.push_back(std::move(shape));
      else
        robot_.findings.add("shapes without extent", "a length is not above 0", child.where);
    }
  }

  JointType read_type(const Element& element) {
    constexpr std::array types{JointType::revolute, JointType::continuous, JointType::prismatic,
                               JointType::fixed,    JointType::floating,   JointType::planar};
    const Attribute& type = require_attribute(element, "type");
    std::vector<std::string> known;
    for (const JointType candidate : types) {
      if (type.value == name_of(candidate)) return candidate;
      known.push_back(name_of(candidate));
    }
    fail(type.where, fmt::format("there is no joint type {}", model::quote(type.value)),
         model::suggest_choice(type.value, known));
  }

  void read_joint(const Element& element) {
    Joint joint;
    joint.name = require_attribute(element, "name").value;
    joint.where = element.where;
    require_new_name(element, joint.name, joint_names_);
    report_unknown(
        element, {"name", "type"},
        {"origin", "parent", "child", "axis", "calibration", "dynamics", "limit", "mimic", "safety_controller"},
        robot_.findings);
    joint.type = read_type(element);
    joint.origin = read_origin(element);
    const Attribute& parent = require_attribute(require_child(element, "parent"), "link");
    const Attribute& child = require_attribute(require_child(element, "child"), "link");
    joint.parent = parent.value;
    joint.parent_where = parent.where;
    joint.child = child.value;
    joint.child_where = child.where;
    read_axis(element, joint);
    for (const char* name : {"calibration", "safety_controller"})
      if (const Element* found = only_child(element, name)) omit(*found, "it belongs to a controller");
    if (joint.type == JointType::fixed) return keep(std::move(joint));
    const bool has_one_coordinate = joint.type != JointType::floating && joint.type != JointType::planar;
    for (const char* name : {"dynamics", "limit", "mimic"}) {
      const Element* found = only_child(element, name);
      if (found == nullptr) continue;
      if (!has_one_coordinate) {
        omit(*found, "a floating or planar joint has several coordinates");
      } else if (found->name == "dynamics") {
        read_dynamics(*found, joint);
      } else if (found->name == "limit") {
        read_limits(*found, joint);
      } else {
        read_mimic(*found, joint);
      }
    }
    keep(std::move(joint));
  }
  void keep(Joint joint) { robot_.joints.push_back(std::move(joint)); }

  void read_axis(const Element& element, Joint& joint) {
    joint.axis[0] = Number(1, "1");  // the format's default
    const Element* axis = only_child(element, "axis");
    if (axis == nullptr || joint.type == JointType::fixed || joint.type == JointType::floating) return;
    report_unknown(*axis, {"xyz"}, {}, robot_.findings);
    const Attribute& xyz = require_attribute(*axis, "xyz");
    joint.axis = vector_of(xyz);
    const long double length = std::hypot(joint.axis[0].value, joint.axis[1].value, joint.axis[2].value);
    if (length == 0)
      fail(xyz.where, fmt::format("the axis of the joint {} has no direction", model::quote(joint.name)),
           "write xyz=\"0 0 1\", for example");
    if (std::fabs(length - 1) < 1e-15L) return;
    if (std::fabs(length - 1) > 1e-3L) robot_.findings.add("lengths of axes", "an axis is a unit vector", xyz.where);
    for (Number& entry : joint.axis) {
      const Number unit(entry.value / length);
      entry = std::fabs(unit.value) == 1 ? Number(unit.value, unit.value > 0 ? "1" : "-1")
              : unit.value == 0          ? Number()
                                         : unit;
    }
  }

  void read_dynamics(const Element& element, Joint& joint) {
    report_unknown(element, {"damping", "friction"}, {}, robot_.findings);
    for (const auto& [name, value] : {std::pair{"damping", &joint.damping}, std::pair{"friction", &joint.friction}}) {
      const Attribute* attribute = element.find(name);
      if (attribute == nullptr) continue;
      *value = number_of(*attribute);
      if (value->value < 0)
        fail(attribute->where, fmt::format("the {} of the joint {} is negative", name, model::quote(joint.name)),
             "it takes energy out of the motion and is at least 0");
    }
  }

  void read_limits(const Element& element, Joint& joint) {
    report_unknown(element, {"lower", "upper", "effort", "velocity"}, {}, robot_.findings);
    joint.limits.where = element.where;
    const auto take = [&](const char* name, std::optional<Number>& value) {
      if (const Attribute* attribute = element.find(name)) value = number_of(*attribute);
    };
    take("effort", joint.limits.effort);
    take("velocity", joint.limits.velocity);
    if (joint.type == JointType::continuous) return;
    take("lower", joint.limits.lower);
    take("upper", joint.limits.upper);
    // The format's defaults.
    if (joint.limits.lower && !joint.limits.upper) joint.limits.upper = Number();
    if (joint.limits.upper && !joint.limits.lower) joint.limits.lower = Number();
    if (joint.limits.lower && joint.limits.lower->value > joint.limits.upper->value)
      fail(element.where,
           fmt::format("the lower limit of the joint {} is above the upper one", model::quote(joint.name)),
           "exchange lower and upper");
  }

  void read_mimic(const Element& element, Joint& joint) {
    report_unknown(element, {"joint", "multiplier", "offset"}, {}, robot_.findings);
    const Attribute& master = require_attribute(element, "joint");
    Mimic mimic{master.value, Number(1, "1"), Number(), master.where};
    if (const Attribute* multiplier = element.find("multiplier")) mimic.multiplier = number_of(*multiplier);
    if (const Attribute* offset = element.find("offset")) mimic.offset = number_of(*offset);
    joint.mimic = std::move(mimic);
  }

  void read_transmission(const Element& element) {
    const Attribute* name = element.find("name");
    bool has_joint = false;
    for (const Element& child : element.children) {
      if (child.name != "joint") continue;
      has_joint = true;
      const Attribute& joint_name = require_attribute(child, "name");
      const auto joint = std::find_if(robot_.joints.begin(), robot_.joints.end(),
                                      [&](const Joint& candidate) { return candidate.name == joint_name.value; });
      if (joint == robot_.joints.end())
        fail(joint_name.where, fmt::format("there is no joint {}", model::quote(joint_name.value)),
             "a transmission names a joint of this robot");
      joint->transmission = name != nullptr ? name->value : "";
      report_unknown(child, {"name"}, {"hardwareInterface"}, robot_.findings);
    }
    if (!has_joint) return omit(element, "it names no joint");
    for (const Element& child : element.children)
      if (child.name == "actuator" || child.name == "mechanicalReduction")
        omit(child, "inputs act on joints; motors and their gears are not imported");
    report_unknown(element, {"name", "type"}, {"joint", "actuator", "mechanicalReduction", "type"}, robot_.findings);
  }

  const Element& root_;
  const ImportOptions& options_;
  Robot robot_;
  std::map<std::string, SourceLocation> link_names_, joint_names_;
};

}  // namespace

Robot read_urdf(const Element& root, const ImportOptions& options) { return UrdfReader(root, options).read(); }

}  // namespace eomgen::import
