// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/model_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "import/solid_mesh.hpp"
#include "import/xml.hpp"
#include "model/names.hpp"

namespace eomgen::import {
namespace {

// Leaves room for names made of this one ("u_NAME", "NAME_origin") and for a number.
constexpr std::size_t longest_name = 48;
// Outputs that coordinates and definitions may not be named as (docs/model-format.md).
constexpr std::array<std::string_view, 6> output_names{"energy", "kinetic", "potential", "power", "jacobi", "all"};

std::string legal(std::string_view wanted) {
  std::string name;
  for (const char c : wanted.substr(0, longest_name)) name += model::is_identifier(std::string{'x', c}) ? c : '_';
  if (name.empty() || !model::is_identifier(name)) name = "n" + name;
  return name;
}

}  // namespace

std::string Names::claim(std::string_view wanted, std::string_view suffix) {
  const std::string base = legal(wanted);
  const auto is_free = [&](const std::string& name) {
    return !model::name_error(name) && !taken_.contains(name) &&
           std::find(output_names.begin(), output_names.end(), name) == output_names.end();
  };
  std::string name = base;
  if (!is_free(name)) name += suffix;
  for (int number = 2; !is_free(name); ++number) name = base + std::string(suffix) + std::to_string(number);
  taken_.insert(name);
  return name;
}

namespace {

constexpr const char* base_prefix = "base";
// Of turned solids, some 300 kB of text.
constexpr std::size_t most_points_of_solids = 6000;

/// The index and sign of a coordinate axis; nothing for other vectors.
std::optional<std::pair<std::size_t, int>> coordinate_axis(const Vector& v) {
  for (std::size_t k = 0; k < 3; ++k)
    if (std::fabs(v[k].value) == 1) return std::pair(k, v[k].value > 0 ? 1 : -1);
  return std::nullopt;
}

std::string triple(const std::array<std::string, 3>& texts) {
  const auto quoted_value = [](const std::string& text) { return text == "0" ? text : "\"" + text + "\""; };
  return fmt::format("[{}, {}, {}]", quoted_value(texts[0]), quoted_value(texts[1]), quoted_value(texts[2]));
}

bool is_diagonal(const Matrix& a) { return a[0][1].is_zero() && a[0][2].is_zero() && a[1][2].is_zero(); }

/// Whether the reader takes three principal moments: none exceeds the sum of the other two, by more than rounding.
bool are_principal_moments(const Matrix& a) {
  const auto fits = [&](std::size_t i, std::size_t j, std::size_t k) {
    return a[i][i].value <= (a[j][j].value + a[k][k].value) * (1 - 1e-12L);
  };
  return is_diagonal(a) && fits(0, 1, 2) && fits(1, 2, 0) && fits(2, 0, 1);
}

}  // namespace

std::string quoted(const std::string& name) {
  std::string text = model::quote(name);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

std::string toml_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return "\"" + result + "\"";
}

ModelWriter::ModelWriter(const Robot& robot, const Tree& tree, const Assembly& assembly, const ImportOptions& options)
    : robot_(robot), tree_(tree), assembly_(assembly), options_(options), findings_(robot.findings) {
  for (const Link& link : robot.links)
    for (const Shape& shape : link.shapes) meshes_ += shape.kind == ShapeKind::mesh ? 1 : 0;
}

std::string ModelWriter::value(const Number& number, const std::string& unit, const std::string& name) {
  if (number.is_zero()) return "0";
  const std::string text = fmt::format("{} {}", to_text(number), unit);
  if (!options_.parameters) return text;
  const std::string claimed = names_.claim(name, "_value");
  parameters_ += fmt::format("{} = \"{}\"\n", claimed, text);
  return claimed;
}

std::string ModelWriter::factor(const Number& number, const std::string& unit, const std::string& name) {
  return options_.parameters && !number.is_zero() ? value(number, unit, name)
                                                  : fmt::format("{}[{}]", to_text(number), unit);
}

std::string ModelWriter::along(const Vector& v, const std::string& axes, const std::string& parameter) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    if (v[k].is_zero()) continue;
    const bool is_negative = v[k].value < 0 && (parameter.empty() || !options_.parameters);
    const Number shown = is_negative ? -v[k] : v[k];
    const std::string number = parameter.empty() ? fmt::format("{}[m]", to_text(shown))
                                                 : factor(shown, "m", fmt::format("{}_{}", parameter, "xyz"[k]));
    text += fmt::format(" {} {}*{}{}", is_negative ? '-' : '+', number, axes, k + 1);
  }
  return text;
}

bool ModelWriter::is_actuated(std::size_t joint) const {
  const JointType type = robot_.joints[joint].type;
  if (type == JointType::floating || type == JointType::planar || type == JointType::ball) return false;
  if (!robot_.joints[joint].drives.empty()) return options_.actuation != Actuation::none;
  if (tree_.master[joint] != no_index) return false;
  return options_.actuation == Actuation::all ||
         (options_.actuation == Actuation::transmissions && robot_.joints[joint].transmission);
}

std::vector<std::size_t> ModelWriter::moving_joints() const {
  std::vector<std::size_t> result;
  for (std::size_t j = 0; j < robot_.joints.size(); ++j)
    if (robot_.joints[j].type != JointType::fixed && !assembly_.is_held[j]) result.push_back(j);
  return result;
}

void ModelWriter::name_free_coordinates(const std::string& prefix, std::size_t joint, const std::string& comment) {
  std::string armature;
  const auto add = [&](const char* part, const char* unit, Number start) {
    coordinates_.push_back({names_.claim(prefix + "_" + part, "_q"), unit, comment, joint, start, armature});
  };
  const Vector start = joint == no_index ? Vector{} : robot_.joints[joint].start;
  const bool has_place = joint == no_index || robot_.joints[joint].type == JointType::floating;
  if (has_place && joint != no_index && !robot_.joints[joint].armature.is_zero())
    armature = value(robot_.joints[joint].armature, "kg", "a_along_" + prefix);
  for (std::size_t k = 0; has_place && k < 3; ++k) add(std::array{"x", "y", "z"}[k], "m", start[k]);
  armature = joint == no_index ? "" : armature_of_parameters(joint);
  if (options_.attitude == Attitude::euler)
    for (const char* part : {"yaw", "pitch", "roll"}) add(part, "rad", {});
  else
    for (const char* part : {"e0", "e1", "e2", "e3"}) add(part, "", Number(part[1] == '0' ? 1 : 0));
}

void ModelWriter::name_coordinates() {
  names_.claim("g", "");
  joint_names_.resize(robot_.joints.size());
  link_names_.resize(robot_.links.size());
  if (options_.floating) name_free_coordinates(base_prefix, no_index, "");
  for (const std::size_t j : moving_joints()) {
    const Joint& joint = robot_.joints[j];
    std::string comment = fmt::format("line {}, {}", joint.where.line, name_of(joint.type));
    const auto add = [&](const char* name, const std::optional<Number>& number) {
      if (number) comment += fmt::format(", {} {}", name, to_text(*number));
    };
    add("lower", joint.limits.lower);
    add("upper", joint.limits.upper);
    add("effort", joint.limits.effort);
    add("velocity", joint.limits.velocity);
    if (joint.type == JointType::floating || joint.type == JointType::ball) {
      joint_names_[j] = names_.claim(joint.name, "_joint");
      name_free_coordinates(joint_names_[j], j, comment);
      continue;
    }
    if (joint.type == JointType::planar) {
      joint_names_[j] = names_.claim(joint.name, "_joint");
      for (const auto& [part, unit] : {std::pair{"u", "m"}, std::pair{"v", "m"}, std::pair{"angle", "rad"}})
        coordinates_.push_back({names_.claim(joint_names_[j] + "_" + part, "_q"), unit, comment, j, {}, ""});
      continue;
    }
    joint_names_[j] = names_.claim(joint.name, "_joint");
    Number start;
    const Limits& limits = joint.limits;
    if (limits.lower && (limits.lower->value > 0 || limits.upper->value < 0))
      start = Number((limits.lower->value + limits.upper->value) / 2);
    const bool is_length = joint.type == JointType::prismatic;
    coordinates_.push_back({joint_names_[j], is_length ? "m" : "rad", comment, j, start, ""});
    if (!joint.armature.is_zero())
      coordinates_.back().armature = value(joint.armature, is_length ? "kg" : "kg*m^2", "a_" + joint_names_[j]);
    if (joint_names_[j] != joint.name) result_.renamings.push_back({"joint", joint.name, joint_names_[j]});
  }
  for (std::size_t i = 0; i < robot_.links.size(); ++i) {
    link_names_[i] = names_.claim(robot_.links[i].name, "_link");
    if (link_names_[i] != robot_.links[i].name)
      result_.renamings.push_back({"link", robot_.links[i].name, link_names_[i]});
  }
}

std::string ModelWriter::rotation_of(const std::string& prefix, bool free) const {
  std::vector<std::string> angles;
  for (const CoordinateText& coordinate : coordinates_)
    if (free && coordinate.unit != "m" && coordinate.name.starts_with(prefix + "_")) angles.push_back(coordinate.name);
  return options_.attitude == Attitude::euler
             ? fmt::format("{{ euler = \"321\", angles = [\"{}\"] }}", fmt::join(angles, "\", \""))
             : fmt::format("{{ euler_parameters = [\"{}\"] }}", fmt::join(angles, "\", \""));
}

std::string ModelWriter::place_name(std::size_t part) const { return origins_[part]; }

/// "B.e" or "E": followed by 1, 2, 3.
std::string ModelWriter::axes_name(std::size_t part) const {
  if (part == 0 && !options_.floating) return "E";
  return link_names_[assembly_.parts[part].link] + ".e";
}

void ModelWriter::write_root(const Part& part) {
  const Link& link = robot_.links[part.link];
  origins_.push_back("origin");
  if (!options_.floating) {
    body_ += fmt::format(
        "\n# Link {} (line {}) is fixed to the ground: its axes are E1, E2, E3, its origin is the origin.\n",
        quoted(link.name), link.where.line);
    for (const std::size_t fused : part.fused)
      body_ += fmt::format("# Fixed to it: link {} (line {}).\n", quoted(robot_.links[fused].name),
                           robot_.links[fused].where.line);
    write_fused(0);
    for (const Shape& shape : link.shapes)
      findings_.add("shapes of the ground", "a shape belongs to a body that moves", shape.where);
    return;
  }
  origins_[0] = names_.claim(link_names_[part.link] + "_origin", "_point");
  std::vector<std::string> position;
  for (std::size_t k = 0; k < 3; ++k) position.push_back(coordinates_[k].name);
  body_ += fmt::format("\n[[point]]\nname = \"{}\"\nposition = {{ cartesian = [\"{}\"] }}\n", origins_[0],
                       fmt::join(position, "\", \""));
  write_body(0, rotation_of(base_prefix, true), "");
}

void ModelWriter::write_body(std::size_t index, const std::string& rotation, const std::string& axes_of) {
  const Part& part = assembly_.parts[index];
  const std::string& name = link_names_[part.link];
  body_ +=
      fmt::format("\n# Link {} (line {})", quoted(robot_.links[part.link].name), robot_.links[part.link].where.line);
  const char* separator = ", with what is fixed to it: ";
  for (const std::size_t fused : part.fused) {
    body_ += fmt::format("{}{} (line {})", separator, quoted(robot_.links[fused].name), robot_.links[fused].where.line);
    separator = ", ";
  }
  if (contains_armature(part))
    body_ += fmt::format("\n# Its inertia contains the armature {} of {}.", to_text(robot_.joints[part.joint].armature),
                         quoted(robot_.joints[part.joint].name));
  const bool has_mass = !part.inertia.mass.is_zero();
  body_ += fmt::format("\n[[{}]]\nname = \"{}\"\n", has_mass ? "body" : "frame", name);
  if (has_mass) {
    ++result_.bodies;
    body_ += fmt::format("mass = \"{}\"\n", value(part.inertia.mass, "kg", "m_" + name));
    std::array<std::array<std::string, 3>, 3> J;
    Matrix tensor = part.inertia.tensor;
    for (std::size_t k = 0; k < 3 && contains_armature(part); ++k)
      tensor[k][k] = tensor[k][k] + robot_.joints[part.joint].armature;
    constexpr const char* letters = "xyz";
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        J[i][k] =
            k < i ? J[k][i] : value(tensor[i][k], "kg*m^2", fmt::format("I{}{}_{}", letters[i], letters[k], name));
    body_ += are_principal_moments(tensor)
                 ? fmt::format("inertia = {{ principal = {} }}\n", triple({J[0][0], J[1][1], J[2][2]}))
                 : fmt::format("inertia = [{}, {}, {}]\n", triple(J[0]), triple(J[1]), triple(J[2]));
    body_ +=
        fmt::format("position = \"{}{}\"\n", place_name(index), along(part.inertia.centre, name + ".e", "c_" + name));
  }
  if (!axes_of.empty()) body_ += fmt::format("relative_to = \"{}\"\n", axes_of);
  body_ += fmt::format("rotation = {}\n", rotation);
  write_fused(index);
  write_shapes(index);
}

void ModelWriter::write_fused(std::size_t index) {
  const Part& part = assembly_.parts[index];
  for (std::size_t i = 0; i < part.fused.size(); ++i)
    body_ += fmt::format("[[point]]\nname = \"{}\"\nposition = \"{}{}\"\n", link_names_[part.fused[i]],
                         place_name(index), along(part.poses[i].p, axes_name(index), ""));
}

void ModelWriter::write_joint(std::size_t index) {
  const Part& part = assembly_.parts[index];
  const Joint& joint = robot_.joints[part.joint];
  const std::string& stem = joint_names_[part.joint];
  const std::string link = link_names_[part.link];
  body_ += fmt::format("\n# Joint {} (line {}): {}, from {} to {}\n", quoted(joint.name), joint.where.line,
                       name_of(joint.type), quoted(joint.parent), quoted(joint.child));
  std::string axes = axes_name(part.parent);
  std::string frame = axes == "E" ? "" : link_names_[assembly_.parts[part.parent].link];
  const std::string parent_axes = axes;
  if (!is_identity(part.attachment.R)) {
    const Vector rpy = part.attachment.angles();
    const std::string fixed = names_.claim(stem + "_frame", "_axes");
    body_ += fmt::format("[[frame]]\nname = \"{}\"\n", fixed);
    if (!frame.empty()) body_ += fmt::format("relative_to = \"{}\"\n", frame);
    body_ += fmt::format("rotation = {{ euler = \"321\", angles = {} }}\n",
                         triple({to_text(rpy[2]), to_text(rpy[1]), to_text(rpy[0])}));
    frame = fixed;
    axes = fixed + ".e";
  }
  // The direction of the axis, along the axes before the joint.
  std::string direction;
  const auto unit = coordinate_axis(joint.axis);
  if (unit) direction = fmt::format("{}{}{}", unit->second < 0 ? "-" : "", axes, unit->first + 1);
  for (std::size_t k = 0; !unit && k < 3; ++k)
    if (!joint.axis[k].is_zero())
      direction += fmt::format("{}{}*{}{}", direction.empty() || joint.axis[k].value < 0 ? "" : "+",
                               to_text(joint.axis[k]), axes, k + 1);
  const std::string& place_axes = joint.moves_along_parent ? parent_axes : axes;
  const auto term = [&](const std::string& q, std::size_t k) {
    return fmt::format(" + {}*{}{}", q, place_axes, k + 1);
  };
  std::string motion, rotation = fmt::format("{{ axis = \"{}\", angle = \"{}\" }}", direction, stem);
  if (joint.type == JointType::prismatic) {
    motion = unit ? fmt::format(" {} {}*{}{}", unit->second < 0 ? "-" : "+", stem, axes, unit->first + 1)
                  : fmt::format(" + {}*({})", stem, direction);
    rotation = "{ fixed = true }";
  } else if (joint.type == JointType::planar) {
    if (!unit || unit->second < 0)
      fail(joint.where, fmt::format("the axis of the planar joint {} is not one of x, y, z", model::quote(joint.name)),
           "turn the axes of the joint by rpy of its <origin>, so that xyz=\"0 0 1\"");
    motion = term(stem + "_u", (unit->first + 1) % 3) + term(stem + "_v", (unit->first + 2) % 3);
    rotation = fmt::format("{{ axis = \"{}\", angle = \"{}_angle\" }}", direction, stem);
  } else if (joint.type == JointType::floating || joint.type == JointType::ball) {
    if (joint.type == JointType::floating) motion = term(stem + "_x", 0) + term(stem + "_y", 1) + term(stem + "_z", 2);
    rotation = rotation_of(stem, true);
  }
  origins_.push_back(place_name(part.parent));
  if (!is_zero(part.attachment.p) || !motion.empty()) {
    origins_.back() = names_.claim(link + "_origin", "_point");
    body_ += fmt::format("[[point]]\nname = \"{}\"\nposition = \"{}{}{}\"\n", origins_.back(), place_name(part.parent),
                         along(part.attachment.p, parent_axes, ""), motion);
  }
  write_body(index, rotation, frame);
}

void ModelWriter::write_parts() {
  write_root(assembly_.parts.front());
  for (std::size_t i = 1; i < assembly_.parts.size(); ++i) write_joint(i);
}

void ModelWriter::write_shapes(std::size_t index) {
  const Part& part = assembly_.parts[index];
  std::vector<std::string> texts;
  const bool has_mass = !part.inertia.mass.is_zero();
  const auto add = [&](const Link& link, const Pose& pose) {
    for (const Shape& shape : link.shapes) {
      if (has_mass)
        write_shape(shape, pose * shape.pose, part.inertia.centre, texts);
      else
        findings_.add("shapes of links without mass", "a shape belongs to a body", shape.where);
    }
  };
  add(robot_.links[part.link], Pose{});
  for (std::size_t i = 0; i < part.fused.size(); ++i) add(robot_.links[part.fused[i]], part.poses[i]);
  if (!texts.empty()) draw_ += fmt::format("{} = [{}]\n", link_names_[part.link], fmt::join(texts, ",\n  "));
}

void ModelWriter::write_shape(const Shape& shape, const Pose& pose, const Vector& centre,
                              std::vector<std::string>& texts) {
  if (shape.kind == ShapeKind::mesh) return write_mesh(shape, pose, centre, texts);
  const auto length = [](const Number& number) { return number.is_zero() ? std::string("0") : to_text(number) + " m"; };
  const Vector middle = pose.p - centre;
  std::string at = fmt::format(", at = {}", triple({length(middle[0]), length(middle[1]), length(middle[2])}));
  if (is_zero(middle)) at.clear();
  if (shape.kind == ShapeKind::sphere) {
    texts.push_back(fmt::format("{{ sphere = \"{}\"{} }}", length(shape.size[0]), at));
    return;
  }
  if (shape.kind == ShapeKind::capsule)
    for (const long double end : {-0.5L, 0.5L}) {
      const Vector ball = middle + pose.R * Vector{Number(), Number(), Number(end * shape.size[1].value)};
      texts.push_back(fmt::format("{{ sphere = \"{}\", at = {} }}", length(shape.size[0]),
                                  triple({length(ball[0]), length(ball[1]), length(ball[2])})));
    }
  // Shapes of the format lie along the axes of the body.
  const bool has_axis = shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::capsule;
  bool is_along = shape.kind != ShapeKind::ellipsoid;
  std::array<std::size_t, 3> axis{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = coordinate_axis({pose.R[0][k], pose.R[1][k], pose.R[2][k]});
    if (found) axis[k] = found->first;
    if (!found && (k == 2 || !has_axis)) is_along = false;
  }
  if (!is_along) return write_turned(shape, pose.R, middle, texts);
  if (has_axis) {
    texts.push_back(fmt::format("{{ cylinder = [\"{}\", \"{}\"], axis = \"e{}\"{} }}", length(shape.size[0]),
                                length(shape.size[1]), axis[2] + 1, at));
    return;
  }
  std::array<std::string, 3> sides;
  for (std::size_t k = 0; k < 3; ++k) sides[axis[k]] = length(shape.size[k]);
  texts.push_back(fmt::format("{{ box = {}{} }}", triple(sides), at));
}

/// As a mesh.
void ModelWriter::write_turned(const Shape& shape, const Matrix& R, const Vector& middle,
                               std::vector<std::string>& texts) {
  PolygonMesh mesh = mesh_of_solid(shape.kind, shape.size);
  points_of_solids_ += mesh.points.size();
  if (points_of_solids_ > most_points_of_solids)
    return findings_.add("turned shapes", "only the first of them are drawn, with 6000 points", shape.where);
  double size = 0;
  for (std::array<double, 3>& p : mesh.points) {
    const Vector at = R * Vector{Number(p[0]), Number(p[1]), Number(p[2])} + middle;
    for (std::size_t k = 0; k < 3; ++k) p[k] = static_cast<double>(at[k].value);
    size = std::max({size, std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
  }
  for (std::array<double, 3>& p : mesh.points)
    for (double& x : p)
      if (std::fabs(x) < 1e-15 * size) x = 0;  // roundings
  texts.push_back(drawn_mesh(mesh));
}

}  // namespace eomgen::import
