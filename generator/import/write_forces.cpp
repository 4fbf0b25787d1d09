// SPDX-License-Identifier: GPL-3.0-or-later
// Forces, constraints, the scene and the head of an imported model.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "import/model_text.hpp"
#include "import/xml.hpp"
#include "model/names.hpp"

namespace eomgen::import {
namespace {

// The velocity below which the smooth law of friction is nearly linear.
constexpr const char* friction_width_angle = "0.01[rad/s]";
constexpr const char* friction_width_length = "0.001[m/s]";

}  // namespace

void ModelWriter::write_drives() {
  std::string entries;
  for (const std::size_t j : moving_joints()) {
    if (!is_actuated(j)) continue;
    const Joint& joint = robot_.joints[j];
    if (!joint.drives.empty()) {
      entries += fmt::format("{} = \"{}\"\n", joint_names_[j], drive_force(j));
      continue;
    }
    const std::string input = names_.claim("u_" + joint_names_[j], "_input");
    std::string comment = fmt::format("line {}", joint.where.line);
    if (joint.transmission) comment = fmt::format("transmission {}", quoted(*joint.transmission));
    if (joint.limits.effort) comment += fmt::format(", at most {}", to_text(*joint.limits.effort));
    inputs_ += fmt::format("{} = {{ unit = \"{}\" }}  # {}\n", input, joint.type == JointType::prismatic ? "N" : "N*m",
                           comment);
    entries += fmt::format("{} = \"{}\"\n", joint_names_[j], input);
    result_.inputs.push_back(input);
  }
  if (!entries.empty())
    body_ += fmt::format("\n# Drives: an input for each joint.\n[[force]]\nname = \"{}\"\n[force.generalized]\n{}",
                         names_.claim("drives", "_force"), entries);
}

std::string ModelWriter::drive_force(std::size_t j) {
  const Joint& joint = robot_.joints[j];
  const bool is_angle = joint.type != JointType::prismatic;
  std::string text;
  const auto add = [&](const Number& number, const char* unit, const std::string& rest) {
    if (number.is_zero()) return;
    const bool is_negative = number.value < 0;
    const std::string size = to_text(is_negative ? -number : number);
    const char* sign = text.empty() ? (is_negative ? "-" : "") : is_negative ? " - " : " + ";
    const bool is_one = size == "1" && unit[0] == '\0' && !rest.empty();
    text += fmt::format("{}{}{}{}", sign, is_one ? "" : size, unit, is_one || rest.empty() ? rest : "*" + rest);
  };
  for (const Drive& drive : joint.drives) {
    const std::string input = names_.claim("u_" + drive.name, "_input");
    const bool is_position = drive.input == Drive::Input::position, is_force = drive.input == Drive::Input::force;
    const char* const unit = is_force      ? (is_angle ? "N*m" : "N")
                             : is_position ? (is_angle ? "rad" : "m")
                                           : (is_angle ? "rad/s" : "m/s");
    inputs_ += fmt::format("{} = {{ unit = \"{}\" }}  # {}\n", input, unit, drive.comment);
    result_.inputs.push_back(input);
    const char *const per_place = is_angle ? "[N*m]" : "[N/m]", *const per_rate = is_angle ? "[N*m*s]" : "[N*s/m]";
    add(drive.gear * drive.gain, is_force ? "" : is_position ? per_place : per_rate, input);
    add(drive.gear * drive.offset, is_angle ? "[N*m]" : "[N]", "");
    add(drive.gear * drive.gear * drive.stiffness, per_place, joint_names_[j]);
    add(drive.gear * drive.gear * drive.damping, per_rate, joint_names_[j] + "_dot");
  }
  return text.empty() ? "0" : text;
}

void ModelWriter::write_springs() {
  std::string entries;
  for (const std::size_t j : moving_joints()) {
    const Joint& joint = robot_.joints[j];
    if (joint.stiffness.is_zero()) continue;
    const bool is_angle = joint.type != JointType::prismatic;
    const std::string& q = joint_names_[j];
    const Number& rest = joint.spring_reference;
    const std::string stretch = rest.is_zero()
                                    ? q
                                    : fmt::format("({} {} {}[{}])", q, rest.value < 0 ? '+' : '-',
                                                  to_text(rest.value < 0 ? -rest : rest), is_angle ? "rad" : "m");
    entries +=
        fmt::format("{} = \"-{}*{}\"\n", q, factor(joint.stiffness, is_angle ? "N*m" : "N/m", "k_" + q), stretch);
  }
  if (!entries.empty())
    body_ += fmt::format("\n# Springs of joints.\n[[force]]\nname = \"{}\"\n[force.generalized]\n{}",
                         names_.claim("springs", "_force"), entries);
}

void ModelWriter::write_dissipation() {
  std::string damping, smooth, friction;
  for (const std::size_t j : moving_joints()) {
    if (turns_freely(j)) continue;
    const Joint& joint = robot_.joints[j];
    const std::string& q = joint_names_[j];
    const bool is_angle = joint.type != JointType::prismatic;
    if (!joint.damping.is_zero())
      damping +=
          fmt::format("{} = \"-{}*{}_dot\"\n", q, factor(joint.damping, is_angle ? "N*m*s" : "N*s/m", "d_" + q), q);
    if (joint.friction.is_zero()) continue;
    if (options_.friction == FrictionLaw::none) {
      findings_.add("friction", "it is left out on request", joint.where);
      continue;
    }
    if (options_.friction == FrictionLaw::smooth) {
      findings_.add("friction", "it is written by a smooth law; --friction dry gives Coulomb's law", joint.where);
      smooth += fmt::format("{} = \"-{}*{}_dot/sqrt({}_dot^2 + {}^2)\"\n", q,
                            factor(joint.friction, is_angle ? "N*m" : "N", "f_" + q), q, q,
                            is_angle ? friction_width_angle : friction_width_length);
      continue;
    }
    friction += fmt::format(
        "\n[[force]]\nname = \"{}\"\ndry = {{ coordinate = \"{}\", normal = \"{}\", static = 1, dynamic = 1 }}\n",
        names_.claim("friction_" + q, "_force"), q, value(joint.friction, is_angle ? "N*m" : "N", "f_" + q));
  }
  if (!damping.empty())
    body_ +=
        fmt::format("\n[[force]]\nname = \"{}\"\n[force.generalized]\n{}", names_.claim("damping", "_force"), damping);
  if (!smooth.empty())
    body_ += fmt::format(
        "\n# Friction by a smooth law: it creeps below {} or {}.\n[[force]]\nname = \"{}\"\n[force.generalized]\n{}",
        friction_width_angle, friction_width_length, names_.claim("friction", "_force"), smooth);
  body_ += friction;
  write_free_damping();
}

/// Whether some joint lets a mass rise or fall, by the directions of the joints at zero.
bool ModelWriter::does_gravity_work() const {
  if (options_.floating) return true;
  constexpr long double parallel = 1e-15L;
  const Vector& g = robot_.gravity;
  const long double size = std::hypot(g[0].value, g[1].value, g[2].value);
  std::vector<Matrix> axes{identity()};
  for (std::size_t i = 1; i < assembly_.parts.size(); ++i) {
    const Part& part = assembly_.parts[i];
    const Joint& joint = robot_.joints[part.joint];
    axes.push_back(axes[part.parent] * part.attachment.R);
    if (joint.type == JointType::floating || joint.type == JointType::ball) return true;
    const Vector n = axes.back() * joint.axis;
    const long double along = (n[0].value * g[0].value + n[1].value * g[1].value + n[2].value * g[2].value) / size;
    const bool is_along = std::fabs(std::fabs(along) - 1) <= parallel, is_across = std::fabs(along) <= parallel;
    if (joint.type == JointType::prismatic ? !is_across : !is_along) return true;
  }
  return false;
}

bool ModelWriter::has_gravity_along_z() const {
  return robot_.gravity[0].is_zero() && robot_.gravity[1].is_zero() && robot_.gravity[2].value < 0;
}

std::string ModelWriter::gravity_text() const {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k)
    if (!robot_.gravity[k].is_zero())
      text += fmt::format("{}{}[m/s^2]*E{}", text.empty() || robot_.gravity[k].value < 0 ? "" : "+",
                          to_text(robot_.gravity[k]), k + 1);
  return text;
}

void ModelWriter::write_forces() {
  if (!gravity_works_)
    findings_.add("gravity", "joints turn about the vertical and slide along the horizontal, so that it does no work",
                  robot_.where);
  else if (has_gravity_along_z())
    body_ += "\n[[force]]\ngravity = \"-g*E3\"\n";
  else if (!is_zero(robot_.gravity))
    body_ += fmt::format("\n[[force]]\ngravity = \"{}\"\n", gravity_text());
  write_drives();
  write_springs();
  write_dissipation();
}

void ModelWriter::write_stops(std::size_t j) {
  const Joint& joint = robot_.joints[j];
  if (!joint.limits.lower)
    fail(joint.where, fmt::format("the joint {} has no limits", model::quote(joint.name)),
         "name joints with <limit lower=\"..\" upper=\"..\">");
  const std::string& q = joint_names_[j];
  const char* unit = joint.type == JointType::prismatic ? "m" : "rad";
  body_ += fmt::format(
      "\n# End stops of {} (line {})\n[[constraint]]\nname = \"{}\"\nholonomic = \"{} - ({}[{}])\"\nholds = "
      "\"unilateral\"\n"
      "[[constraint]]\nname = \"{}\"\nholonomic = \"{}[{}] - {}\"\nholds = \"unilateral\"\n",
      quoted(joint.name), joint.limits.where.line, names_.claim(q + "_lower", "_stop"), q, to_text(*joint.limits.lower),
      unit, names_.claim(q + "_upper", "_stop"), to_text(*joint.limits.upper), unit, q);
  result_.constraints += 2;
}

void ModelWriter::write_constraints() {
  for (const std::size_t j : moving_joints()) {
    if (tree_.master[j] == no_index) continue;
    const Joint& joint = robot_.joints[j];
    const Joint& master = robot_.joints[tree_.master[j]];
    const bool is_length = joint.type == JointType::prismatic, is_master_length = master.type == JointType::prismatic;
    const char* unit = is_length == is_master_length ? "" : is_length ? "[m]" : "[1/m]";
    const Number ratio = -joint.mimic->multiplier, offset = -joint.mimic->offset;
    std::string text = joint_names_[j];
    const auto add = [&](const Number& number, const std::string& rest) {
      if (number.is_zero()) return;
      const Number size = number.value < 0 ? -number : number;
      text += fmt::format(" {} {}{}", number.value < 0 ? '-' : '+', to_text(size), rest);
    };
    const bool is_copy = std::fabs(ratio.value) == 1 && unit[0] == '\0';
    const std::string& q = joint_names_[tree_.master[j]];
    if (is_copy)
      text += fmt::format(" {} {}", ratio.value < 0 ? '-' : '+', q);
    else
      add(ratio, fmt::format("{}*{}", unit, q));
    add(offset, is_length ? "[m]" : "[rad]");
    body_ += fmt::format("\n# Joint {} follows {} (line {}).\n[[constraint]]\nname = \"{}\"\nholonomic = \"{}\"\n",
                         quoted(joint.name), quoted(master.name), joint.mimic->where.line,
                         names_.claim(joint_names_[j] + "_mimic", "_constraint"), text);
    ++result_.constraints;
  }
  for (const std::string& name : options_.stops) {
    const auto found = std::find_if(robot_.joints.begin(), robot_.joints.end(),
                                    [&](const Joint& joint) { return joint.name == name; });
    const std::size_t j = static_cast<std::size_t>(found - robot_.joints.begin());
    std::vector<std::string> known;
    for (const std::size_t candidate : moving_joints()) known.push_back(robot_.joints[candidate].name);
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error("import", {}, fmt::format("there is no joint {} that moves", model::quote(name)),
                  model::suggest_choice(name, known));
    write_stops(j);
  }
}

void ModelWriter::write_scene() {
  std::string initial;
  for (const CoordinateText& coordinate : coordinates_) {
    if (coordinate.joint != no_index && tree_.master[coordinate.joint] != no_index) continue;
    initial += fmt::format("{} = {}\n", coordinate.name, to_text(coordinate.start));
  }
  body_ += "\n[scene.default]\nt = [0, 1]\noutputs = [\"energy\"]\n";
  if (!initial.empty()) body_ += "[scene.default.initial]\n" + initial;
}

std::string ModelWriter::header() const {
  const std::string file = std::filesystem::path(robot_.file).filename().string();
  std::string text = fmt::format("# Written by eomgen import from {}. Lines are those of that file.\n", quoted(file));
  for (const Finding& finding : findings_.entries())
    text += fmt::format("# Not as in the file: {} ({} times, first in line {}): {}.\n", quoted(finding.what),
                        finding.count, finding.first.line, finding.why);
  if (findings_.unlisted() > 0) text += fmt::format("# {} further places are not listed.\n", findings_.unlisted());
  for (const Renaming& renaming : result_.renamings)
    text += fmt::format("# The {} {} is {} here.\n", renaming.kind, quoted(renaming.from), renaming.to);
  text += fmt::format("format = 1\ntitle = {}\n", toml_text(robot_.name.substr(0, 200)));
  const std::string g = gravity_works_ && has_gravity_along_z()
                            ? fmt::format("g = \"{} m/s^2\"\n", to_text(-robot_.gravity[2]))
                            : std::string();
  if (!g.empty() || !parameters_.empty()) text += "\n[parameters]\n" + g + parameters_;
  if (!inputs_.empty()) text += "\n[inputs]\n" + inputs_;
  text += "\n[coordinates]\n";
  for (const CoordinateText& coordinate : coordinates_) {
    std::string entry = coordinate.unit.empty() ? "{}" : "\"" + coordinate.unit + "\"";
    const std::string unit = coordinate.unit.empty() ? "" : fmt::format("unit = \"{}\", ", coordinate.unit);
    if (!coordinate.armature.empty()) entry = fmt::format("{{ {}armature = \"{}\" }}", unit, coordinate.armature);
    text += fmt::format("{} = {}{}\n", coordinate.name, entry,
                        coordinate.comment.empty() ? "" : "  # " + coordinate.comment);
  }
  return text;
}

ImportedModel ModelWriter::write() {
  name_coordinates();
  gravity_works_ = is_zero(robot_.gravity) || does_gravity_work();
  if (coordinates_.empty())
    fail(robot_.where, "nothing moves: every joint is fixed", "give the robot a joint that moves, or use --floating");
  write_parts();
  write_forces();
  write_free_armature();
  write_constraints();
  if (!draw_.empty()) body_ += "\n[draw]\n" + draw_;
  write_scene();
  result_.robot = robot_.name;
  result_.links = robot_.links.size();
  result_.joints = robot_.joints.size();
  for (const CoordinateText& coordinate : coordinates_) result_.coordinates.push_back(coordinate.name);
  result_.text = header() + body_;
  result_.findings = findings_;
  return std::move(result_);
}

}  // namespace eomgen::import
