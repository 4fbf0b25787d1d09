// SPDX-License-Identifier: GPL-3.0-or-later
// MJCF, the XML format of MuJoCo. Its bodies are nested, and a body may have several joints, none of which has to be at
// its origin.
// In: <mujoco> with <compiler>, <default>, <option>, <worldbody>, <actuator>, <equality>. Out: Robot; the rest is in
// its findings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "import/import.hpp"
#include "import/mjcf_drives.hpp"
#include "import/mjcf_geoms.hpp"
#include "import/mjcf_settings.hpp"
#include "model/names.hpp"

namespace eomgen::import {
namespace {

constexpr const char* ground = "world";

bool is_one_of(const std::string& name, const std::vector<const char*>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class MjcfReader {
 public:
  MjcfReader(const Element& root, const ImportOptions& options)
      : root_(root), settings_(root, options, robot_.findings) {
    if (options.floating)
      throw Error("import", root.where, "an MJCF file states itself which bodies are free",
                  "leave out --floating, or add <freejoint/> to the body");
  }

  Robot read() {
    robot_.where = root_.where;
    robot_.file = root_.where.file;
    const Attribute* name = root_.find("model");
    robot_.name = name != nullptr ? name->value : "MuJoCo Model";
    refuse_includes(root_);
    link_names_.insert(ground);
    robot_.links.push_back({ground, root_.where, {}, {}});
    // Names that the file states come before those that are made.
    for (const Element& child : root_.children)
      if (child.name == "worldbody") reserve_names(child);
    for (const Element& child : root_.children)
      if (child.name == "worldbody") read_contents(child, {0, Pose{}, MjcfSettings::main_class});
    for (const Element& child : root_.children) read_section(child);
    if (robot_.links.size() == 1) fail(root_.where, "the file has no body", "add <worldbody><body name=\"..\">");
    return std::move(robot_);
  }

 private:
  /// The place of an element: a link, the pose of the element's axes in those of the link, the class of defaults.
  struct Place {
    std::size_t link;
    Pose pose;
    std::size_t childclass;
  };

  void omit(const Element& element, const std::string& why) {
    robot_.findings.add(fmt::format("<{}>", element.name), why, element.where);
  }

  void refuse_includes(const Element& element) const {
    if (element.name == "include")
      fail(element.where, "other files are not included",
           "import the file that <include> names, or let MuJoCo save the whole model as one file");
    for (const Element& child : element.children) refuse_includes(child);
  }

  void read_section(const Element& element) {
    if (element.name == "actuator") return read_actuators(element, settings_, references_, robot_);
    if (element.name == "equality") return read_equalities(element, settings_, robot_);
    if (element.name == "option") return read_option(element);
    if (element.name == "asset") {
      for (const Element& child : element.children)
        if (child.name != "mesh") omit(child, "colours, textures and height fields are not drawn");
      return;
    }
    if (is_one_of(element.name, {"worldbody", "compiler", "default"})) return;
    omit(element, is_one_of(element.name, {"contact"})    ? "contacts between bodies are not imported"
                  : is_one_of(element.name, {"tendon"})   ? "tendons are not imported"
                  : is_one_of(element.name, {"sensor"})   ? "sensors are not imported; outputs of scenes measure"
                  : is_one_of(element.name, {"keyframe"}) ? "scenes of the model have starts of their own"
                  : is_one_of(element.name, {"deformable", "flex"}) ? "bodies are rigid here"
                                                                    : "it has no meaning in a model");
  }

  void read_option(const Element& element) {
    for (const Attribute& attribute : element.attributes) {
      if (attribute.name == "gravity") {
        robot_.gravity = vector_of(attribute);
      } else if (is_one_of(attribute.name, {"density", "viscosity", "wind"})) {
        robot_.findings.add("fluids", "forces of air and water are not imported", attribute.where);
      } else {
        robot_.findings.add("<option>", "settings of MuJoCo's solver; eomgen run has its own", attribute.where);
      }
    }
    for (const Element& child : element.children)
      if (child.name == "flag") omit(child, "forces of every kind are on");
  }

  void reserve_names(const Element& element) {
    for (const Element& child : element.children) {
      const bool is_body = child.name == "body";
      const Attribute* name = child.find("name");
      if (name != nullptr && (is_body || child.name == "joint" || child.name == "freejoint") &&
          !(is_body ? link_names_ : joint_names_).insert(name->value).second)
        fail(name->where, fmt::format("the name {} comes twice", model::quote(name->value)), "give each its own name");
      reserve_names(child);
    }
  }

  std::string claim(std::set<std::string>& taken, const std::string& wanted) {
    for (std::size_t k = 1;; ++k) {
      std::string name = k == 1 ? wanted : fmt::format("{}{}", wanted, k);
      if (taken.insert(name).second) return name;
    }
  }

  void read_contents(const Element& element, const Place& place) {
    for (const Element& child : element.children) {
      if (child.name == "body") {
        read_body(child, place);
      } else if (child.name == "frame") {
        const Pose pose = place.pose * settings_.pose({child, place.childclass});
        for (const Element& inner : child.children)
          if (is_one_of(inner.name, {"joint", "freejoint", "inertial"}))
            fail(inner.where, fmt::format("<{}> inside of <frame> is not read", inner.name), "write it into the body");
        read_contents(child, {place.link, pose, settings_.childclass_of(child, place.childclass)});
      } else if (child.name == "geom") {
        // Geoms of bodies are read with their inertia.
        if (place.link == 0)
          keep_shape(read_geom(settings_.with_defaults(child, place.childclass), settings_, robot_.findings), place);
      } else if (child.name == "site") {
        read_site(child, place);
      } else if (is_one_of(child.name, {"replicate", "composite", "flexcomp", "attach", "plugin"})) {
        omit(child, "it is not expanded; let MuJoCo save the model as one file");
      } else if (is_one_of(child.name, {"camera", "light"})) {
        omit(child, "cameras and lights are not imported");
      } else if (!is_one_of(child.name, {"joint", "freejoint", "inertial"})) {
        omit(child, "it has no meaning in a model");
      }
    }
  }

  void keep_shape(MjcfGeom geom, const Place& place) {
    if (!geom.shape) return;
    geom.shape->pose = place.pose * geom.shape->pose;
    robot_.links[place.link].shapes.push_back(std::move(*geom.shape));
  }

  /// A site is a point: a link without mass.
  void read_site(const Element& element, const Place& place) {
    const Attribute* name = element.find("name");
    if (name == nullptr) return;
    const MjcfElement at = settings_.with_defaults(element, place.childclass);
    add_fixed(claim(link_names_, name->value), element.where, place.link, place.pose * settings_.pose(at));
  }

  std::size_t add_fixed(const std::string& name, const SourceLocation& where, std::size_t parent, const Pose& pose) {
    Joint joint;
    joint.name = claim(joint_names_, name + "_mount");
    joint.where = where;
    connect(joint, parent, name);
    joint.origin = pose;
    return add(std::move(joint), {name, where, {}, {}});
  }

  void connect(Joint& joint, std::size_t parent, const std::string& child) const {
    joint.parent = robot_.links[parent].name;
    joint.child = child;
    joint.parent_where = joint.child_where = joint.where;
  }

  std::size_t add(Joint joint, Link link) {
    robot_.joints.push_back(std::move(joint));
    references_.emplace_back();
    robot_.links.push_back(std::move(link));
    return robot_.links.size() - 1;
  }

  void read_body(const Element& element, const Place& above) {
    const std::size_t childclass = settings_.childclass_of(element, above.childclass);
    const Attribute* stated = element.find("name");
    const std::string name = stated != nullptr ? stated->value : claim(link_names_, "body");
    if (const std::optional<bool> is_input = settings_.flag({element, childclass}, "mocap"); is_input.value_or(false))
      robot_.findings.add("mocap=\"..\" of <body>", "the body is fixed", element.where);
    if (!settings_.number({element, childclass}, "gravcomp", Number()).is_zero())
      robot_.findings.add("gravcomp=\"..\" of <body>", "gravity is not compensated", element.where);
    std::vector<const Element*> joints;
    for (const Element& child : element.children)
      if (child.name == "joint" || child.name == "freejoint") joints.push_back(&child);
    const Pose pose = above.pose * settings_.pose({element, childclass});
    Place place{above.link, pose, childclass};
    if (joints.empty()) place = {add_fixed(name, element.where, above.link, pose), Pose{}, childclass};
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const bool is_last = i + 1 == joints.size();
      place = read_joint(*joints[i], is_last ? name : claim(link_names_, fmt::format("{}_{}", name, i + 1)), place,
                         {element.where, joints.size(), name});
    }
    // The origin of a link is at its last joint. That of the body is a point.
    if (!is_zero(place.pose.p)) add_fixed(claim(link_names_, name + "_frame"), element.where, place.link, place.pose);
    read_inertia(element, place);
    read_contents(element, place);
  }

  struct BodyOfJoint {
    SourceLocation where;
    std::size_t joints;
    std::string name;
  };

  /// Adds a joint and its link, and returns the place of the body in that link.
  Place read_joint(const Element& element, const std::string& link, const Place& place, const BodyOfJoint& body) {
    const MjcfElement at = settings_.with_defaults(element, place.childclass);
    Joint joint;
    joint.where = element.where;
    joint.type = read_type(at);
    const bool is_free = joint.type == JointType::floating;
    if (is_free && (body.joints > 1 || place.link != 0))
      fail(element.where, "a free joint is the only one of a body in the world", "move the body to <worldbody>");
    const Attribute* stated = element.find("name");
    joint.name = stated != nullptr ? stated->value : claim(joint_names_, body.name + (is_free ? "_free" : "_joint"));
    connect(joint, place.link, link);
    const Vector anchor = is_free ? Vector{} : settings_.vector(at, "pos", {});
    Pose to_anchor;
    to_anchor.p = anchor;
    joint.origin = place.pose * to_anchor;
    if (is_free) {
      joint.start = joint.origin.p;
      joint.moves_along_parent = true;
      joint.origin.p = {};
    }
    Number reference;
    if (joint.type != JointType::floating && joint.type != JointType::ball)
      reference = read_coordinate(at, joint);
    else
      read_several(at, joint);
    const std::size_t index = add(std::move(joint), {link, body.where, {}, {}});
    references_.back() = reference;
    Pose back;
    back.p = Vector{} - anchor;
    return {index, back, place.childclass};
  }

  JointType read_type(const MjcfElement& at) {
    if (at.element.name == "freejoint") return JointType::floating;
    const Attribute* type = settings_.find(at, "type");
    if (type == nullptr || type->value == "hinge") return JointType::continuous;
    if (type->value == "slide") return JointType::prismatic;
    if (type->value == "ball") return JointType::ball;
    if (type->value == "free") return JointType::floating;
    fail(type->where, fmt::format("there is no joint type {}", model::quote(type->value)),
         model::suggest_choice(type->value, {"hinge", "slide", "ball", "free"}));
  }

  /// Passive forces of a ball or free joint, which are the same along all of its axes.
  void read_several(const MjcfElement& at, Joint& joint) {
    for (const auto& [name, value] : {std::pair{"damping", &joint.damping}, std::pair{"armature", &joint.armature}})
      read_passive(at, name, *value, joint);
    for (const auto& [name, why] :
         {std::pair{"frictionloss", "Coulomb's law of each axis has no meaning for a rotation in space"},
          std::pair{"stiffness", "its moment has no formula that holds at the angle 0"}})
      if (const Attribute* found = settings_.find(at, name); found != nullptr && !numbers_of(*found, 1, 3)[0].is_zero())
        robot_.findings.add(fmt::format("{} of ball and free joints", name), why, found->where);
    if (const Attribute* range = settings_.find(at, "range"))
      robot_.findings.add("range of ball joints", "limits are those of joints with one coordinate", range->where);
  }

  void read_passive(const MjcfElement& at, const char* name, Number& value, const Joint& joint) {
    const Attribute* attribute = settings_.find(at, name);
    if (attribute == nullptr) return;
    value = numbers_of(*attribute, 1, 3)[0];
    if (value.value < 0)
      fail(attribute->where, fmt::format("the {} of the joint {} is negative", name, model::quote(joint.name)),
           "it is at least 0");
  }

  /// Axis, limits and passive forces. Returns the position in the pose of the file.
  Number read_coordinate(const MjcfElement& at, Joint& joint) {
    const bool is_angle = joint.type == JointType::continuous;
    const auto place_of = [&](const Number& number) { return is_angle ? settings_.radians(number) : number; };
    joint.axis = unit_axis(at);
    const Number reference = place_of(settings_.number(at, "ref", Number()));
    if (!reference.is_zero())
      robot_.findings.add("ref of joints", "coordinates count from the pose of the file", at.element.where);
    for (const auto& [name, value] : {std::pair{"damping", &joint.damping}, std::pair{"frictionloss", &joint.friction},
                                      std::pair{"armature", &joint.armature}, std::pair{"stiffness", &joint.stiffness}})
      read_passive(at, name, *value, joint);
    joint.spring_reference = place_of(settings_.number(at, "springref", Number())) - reference;
    if (settings_.find(at, "springdamper") != nullptr)
      robot_.findings.add("springdamper of joints", "state stiffness and damping", at.element.where);
    read_limits(at, joint, reference, place_of);
    return reference;
  }

  template <class PlaceOf>
  void read_limits(const MjcfElement& at, Joint& joint, const Number& reference, const PlaceOf& place_of) {
    const Attribute* range = settings_.find(at, "range");
    const bool is_limited = settings_.flag(at, "limited").value_or(settings_.has_automatic_limits());
    if (range == nullptr || !is_limited) return;
    const std::vector<Number> ends = numbers_of(*range, 2, 2);
    if (ends[0].value >= ends[1].value)
      fail(range->where, fmt::format("the range of the joint {} is empty", model::quote(joint.name)),
           "write the lower end first");
    joint.limits.lower = place_of(ends[0]) - reference;
    joint.limits.upper = place_of(ends[1]) - reference;
    joint.limits.where = range->where;
    if (joint.type == JointType::continuous) joint.type = JointType::revolute;
  }

  Vector unit_axis(const MjcfElement& at) {
    const Vector axis = settings_.vector(at, "axis", {Number(), Number(), Number(1, "1")});
    const long double length = std::hypot(axis[0].value, axis[1].value, axis[2].value);
    if (length == 0) fail(at.element.where, "the axis of the joint has no direction", "write axis=\"0 0 1\"");
    Vector result;
    for (std::size_t k = 0; k < 3; ++k) {
      const long double entry = axis[k].value / length;
      if (std::fabs(entry) == 1)
        result[k] = Number(entry, entry > 0 ? "1" : "-1");
      else if (entry != 0)
        result[k] = std::fabs(length - 1) < 1e-15L ? axis[k] : Number(entry);
    }
    return result;
  }

  void read_inertia(const Element& element, const Place& place) {
    const Element* inertial = only_child(element, "inertial");
    using FromGeoms = MjcfSettings::FromGeoms;
    const bool has_own = inertial != nullptr && settings_.inertia_from_geoms() != FromGeoms::always;
    const bool from_geoms = !has_own && settings_.inertia_from_geoms() != FromGeoms::never;
    Inertia sum;
    if (has_own) sum = read_inertial(*inertial);
    add_geoms(element, {place.link, Pose{}, place.childclass}, from_geoms ? &sum : nullptr, place.pose);
    Link& link = robot_.links[place.link];
    link.inertia = place.pose * sum;
  }

  /// Geoms of a body, also those in frames. `at`: the pose of the frame in the body; `body`: of the body in its link.
  void add_geoms(const Element& element, const Place& at, Inertia* sum, const Pose& body) {
    for (const Element& child : element.children) {
      if (child.name == "frame") {
        add_geoms(
            child,
            {at.link, at.pose * settings_.pose({child, at.childclass}), settings_.childclass_of(child, at.childclass)},
            sum, body);
      }
      if (child.name != "geom") continue;
      MjcfGeom geom = read_geom(settings_.with_defaults(child, at.childclass), settings_, robot_.findings);
      robot_.findings.add("contacts of <geom>", "contacts between bodies are not imported", child.where);
      if (sum != nullptr) *sum = *sum + at.pose * geom.inertia;
      keep_shape(std::move(geom), {at.link, body * at.pose, at.childclass});
    }
  }

  Inertia read_inertial(const Element& element) {
    report_unknown(element,
                   {"pos", "quat", "axisangle", "euler", "xyaxes", "zaxis", "mass", "diaginertia", "fullinertia"}, {},
                   robot_.findings);
    Inertia result;
    const Attribute& mass = require_attribute(element, "mass");
    result.mass = number_of(mass);
    if (result.mass.value < 0) fail(mass.where, "the mass is negative", "a mass is at least 0");
    const Attribute *diagonal = element.find("diaginertia"), *full = element.find("fullinertia");
    if ((diagonal == nullptr) == (full == nullptr))
      fail(element.where, "<inertial> has one of diaginertia and fullinertia", "write diaginertia=\"Ixx Iyy Izz\"");
    const Pose pose = settings_.pose({element, MjcfSettings::main_class});
    if (diagonal != nullptr) {
      const Vector moments = vector_of(*diagonal);
      for (std::size_t k = 0; k < 3; ++k) result.tensor[k][k] = moments[k];
    } else {
      const std::vector<Number> J = numbers_of(*full, 6, 6);  // xx, yy, zz, xy, xz, yz
      result.tensor = {{{J[0], J[3], J[4]}, {J[3], J[1], J[5]}, {J[4], J[5], J[2]}}};
      if (!is_identity(pose.R))
        fail(full->where, "fullinertia is along the axes of the body", "remove the orientation");
    }
    const Attribute& tensor = diagonal != nullptr ? *diagonal : *full;
    if (!is_positive_semidefinite(result.tensor))
      fail(tensor.where, "the inertia tensor is not positive definite", "it is about the centre of mass");
    if (!satisfies_triangle_inequality(result.tensor))
      robot_.findings.add("inertia tensors that no body has",
                          "one principal moment is larger than the other two together; the values are kept",
                          tensor.where);
    return pose * result;
  }

  Robot robot_;
  const Element& root_;
  MjcfSettings settings_;
  JointReferences references_;
  std::set<std::string> link_names_, joint_names_;
};

}  // namespace

Robot read_mjcf(const Element& root, const ImportOptions& options) { return MjcfReader(root, options).read(); }

}  // namespace eomgen::import
