// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/mjcf_drives.hpp"

#include <fmt/format.h>

#include "import/model_text.hpp"
#include "lists.hpp"
#include "model/names.hpp"

namespace eomgen::import {
namespace {

Joint& joint_named(const Attribute& name, Robot& robot) {
  auto* const found = find_named(robot.joints, name.value);
  if (found != nullptr) return *found;
  std::vector<std::string> known;
  for (const Joint& joint : robot.joints) known.push_back(joint.name);
  const std::string hint = model::did_you_mean(name.value, known);
  fail(name.where, fmt::format("there is no joint {}", model::quote(name.value)),
       hint.empty() ? "name a joint of this file" : hint);
}

bool has_one_coordinate(const Joint& joint) {
  return joint.type == JointType::revolute || joint.type == JointType::continuous || joint.type == JointType::prismatic;
}

class DriveReader {
 public:
  DriveReader(const MjcfElement& at, const MjcfSettings& settings) : at_(at), settings_(settings) {}

  /// Reads the law of the force. Returns what has no meaning here, or "".
  std::string read(Drive& drive) {
    const std::string& kind = at_.element.name;
    drive.gear = Number(1, "1");
    if (const Attribute* gear = settings_.find(at_, "gear")) drive.gear = numbers_of(*gear, 1, 6).front();
    drive.gain = Number(1, "1");
    if (kind == "motor") return "";
    if (kind == "position") {
      drive.input = Drive::Input::position;
      drive.gain = settings_.number(at_, "kp", drive.gain);
      drive.stiffness = -drive.gain;
      drive.damping = -settings_.number(at_, "kv", Number());
      const Number time = settings_.number(at_, "timeconst", Number());
      if (settings_.find(at_, "dampratio") != nullptr || !time.is_zero()) return "dampratio and timeconst";
      return "";
    }
    if (kind == "velocity") {
      drive.input = Drive::Input::velocity;
      drive.gain = settings_.number(at_, "kv", drive.gain);
      drive.damping = -drive.gain;
      return "";
    }
    return kind == "general" ? read_general(drive) : "this kind of actuator";
  }

 private:
  std::string read_general(Drive& drive) {
    const auto word = [&](const char* name, const char* otherwise) {
      const Attribute* found = settings_.find(at_, name);
      return found == nullptr ? std::string(otherwise) : found->value;
    };
    if (word("dyntype", "none") != "none") return "dyntype";
    if (word("gaintype", "fixed") != "fixed") return "gaintype";
    if (const Attribute* gain = settings_.find(at_, "gainprm")) drive.gain = numbers_of(*gain, 1, 10).front();
    const std::string bias = word("biastype", "none");
    if (bias != "none" && bias != "affine") return "biastype";
    if (const Attribute* terms = settings_.find(at_, "biasprm"); terms != nullptr && bias == "affine") {
      std::vector<Number> b = numbers_of(*terms, 1, 10);
      b.resize(3);
      drive.offset = b[0];
      drive.stiffness = b[1];
      drive.damping = b[2];
    }
    // The unit of u: a servo on positions or speeds pulls with its gain in the opposite direction.
    if (!drive.gain.is_zero() && drive.stiffness.value == -drive.gain.value)
      drive.input = Drive::Input::position;
    else if (!drive.gain.is_zero() && drive.stiffness.is_zero() && drive.damping.value == -drive.gain.value)
      drive.input = Drive::Input::velocity;
    return "";
  }

  const MjcfElement& at_;
  const MjcfSettings& settings_;
};

}  // namespace

void read_actuators(const Element& element, const MjcfSettings& settings, const JointReferences& references,
                    Robot& robot) {
  for (const Element& child : element.children) {
    const MjcfElement at = settings.with_defaults(child, MjcfSettings::main_class);
    const std::string what = fmt::format("<{}> of <actuator>", child.name);
    const Attribute* target = settings.find(at, "joint");
    if (target == nullptr) {
      robot.findings.add(what, "actuators act on joints here", child.where);
      continue;
    }
    Joint& joint = joint_named(*target, robot);
    Drive drive;
    const Attribute* name = child.find("name");
    drive.name = name != nullptr ? name->value : joint.name;
    drive.comment = fmt::format("line {}, {} of {}", child.where.line, quoted(child.name), quoted(joint.name));
    if (!has_one_coordinate(joint)) {
      robot.findings.add(what, "it acts on a joint with several coordinates", child.where);
      continue;
    }
    if (const std::string why = DriveReader(at, settings).read(drive); !why.empty()) {
      robot.findings.add(what, why + " has no meaning here; the actuator is left out", child.where);
      continue;
    }
    for (const char* range : {"ctrlrange", "forcerange"})
      if (const Attribute* found = settings.find(at, range)) {
        drive.comment += fmt::format(", {} {}", range, quoted(found->value));
        robot.findings.add(fmt::format("{} of actuators", range), "inputs and forces are not limited", found->where);
      }
    // Lengths of MuJoCo count from its zero, coordinates from the pose of the file.
    const Number& reference = references[static_cast<std::size_t>(&joint - robot.joints.data())];
    drive.offset = drive.offset + drive.stiffness * drive.gear * reference;
    joint.drives.push_back(std::move(drive));
  }
}

void read_equalities(const Element& element, const MjcfSettings& settings, Robot& robot) {
  for (const Element& child : element.children) {
    const std::string what = fmt::format("<{}> of <equality>", child.name);
    const MjcfElement at = settings.with_defaults(child, MjcfSettings::main_class);
    const bool is_active = settings.flag(at, "active").value_or(true);
    if (child.name != "joint" || !is_active) {
      robot.findings.add(what, is_active ? "joints that follow joints are imported" : "it is not active", child.where);
      continue;
    }
    Joint& follower = joint_named(require_attribute(child, "joint1"), robot);
    const Attribute* master = child.find("joint2");
    std::vector<Number> a{Number(), Number(1, "1")};
    if (const Attribute* polynomial = settings.find(at, "polycoef")) a = numbers_of(*polynomial, 1, 5);
    a.resize(5);
    const bool is_straight = a[2].is_zero() && a[3].is_zero() && a[4].is_zero();
    if (master == nullptr || !is_straight || follower.mimic || !has_one_coordinate(follower)) {
      robot.findings.add(what, "one joint with one coordinate follows another along a straight line", child.where);
      continue;
    }
    joint_named(*master, robot);
    robot.findings.add("soft constraints", "an equality of joints holds exactly; that of MuJoCo is a stiff spring",
                       child.where);
    follower.mimic = Mimic{master->value, a[1], a[0], master->where};
  }
}

}  // namespace eomgen::import
