// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/mjcf_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lists.hpp"
#include "model/names.hpp"

namespace eomgen::import {
namespace {

/// Entries of a rotation from decimals: 0 and +-1 beyond the digits of the file are exact.
Matrix snapped(const std::array<std::array<long double, 3>, 3>& entries) {
  constexpr long double digits = 1e-15L;
  Matrix result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const long double v = entries[i][k];
      if (std::fabs(v) < digits) continue;
      result[i][k] = std::fabs(std::fabs(v) - 1) < digits ? Number(v > 0 ? 1 : -1, v > 0 ? "1" : "-1") : Number(v);
    }
  return result;
}

Matrix from_quaternion(long double w, long double x, long double y, long double z) {
  return snapped({{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                   {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                   {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}});
}

std::vector<long double> values_of(const Attribute& attribute, std::size_t count) {
  return mapped(numbers_of(attribute, count, count), &Number::value);
}

[[noreturn]] void fail_direction(const Attribute& attribute) {
  fail(attribute.where, fmt::format("'{}' has no direction", attribute.name), "write numbers that are not all 0");
}

/// Elements of actuators have their defaults in common.
std::string kind_of(const std::string& element) {
  for (const char* actuator : {"motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle",
                               "adhesion", "plugin", "general"})
    if (element == actuator) return "general";
  return element;
}

}  // namespace

Matrix from_z_axis(const std::array<long double, 3>& d) {
  const long double length = std::hypot(d[0], d[1], d[2]), across = std::hypot(d[0], d[1]) / length;
  // Opposite to the z axis: half a turn about x.
  if (across < 1e-10L) return d[2] > 0 ? identity() : from_quaternion(0, 1, 0, 0);
  const long double half = std::atan2(across, d[2] / length) / 2, s = std::sin(half) / (across * length);
  return from_quaternion(std::cos(half), -d[1] * s, d[0] * s, 0);
}

MjcfSettings::MjcfSettings(const Element& root, const ImportOptions& options, Findings& findings)
    : exact_angles_(options.exact_angles), classes_(1) {
  names_.emplace("main", main_class);
  for (const Element& child : root.children) {
    if (child.name == "compiler") read_compiler(child, findings);
    if (child.name == "default") read_defaults(child, std::nullopt);
  }
  for (const Element& child : root.children)
    if (child.name == "asset") read_meshes(child);
}

void MjcfSettings::read_meshes(const Element& assets) {
  for (const Element& child : assets.children) {
    const Attribute *file = child.find("file"), *name = child.find("name");
    if (child.name != "mesh" || file == nullptr) continue;
    const std::size_t slash = file->value.find_last_of("/\\"), start = slash == std::string::npos ? 0 : slash + 1;
    const std::string stem = file->value.substr(start, file->value.rfind('.') - start);
    const Number one(1, "1");
    meshes_.emplace(
        name != nullptr ? name->value : stem,
        MeshAsset{mesh_folder_ + file->value, vector(with_defaults(child, main_class), "scale", {one, one, one})});
  }
}

const MjcfSettings::MeshAsset* MjcfSettings::mesh(const std::string& name) const {
  const auto found = meshes_.find(name);
  return found == meshes_.end() ? nullptr : &found->second;
}

void MjcfSettings::read_compiler(const Element& element, Findings& findings) {
  const auto choice = [&](const char* name, const std::vector<std::string>& known) -> std::string {
    const Attribute* found = element.find(name);
    if (found == nullptr) return "";
    if (std::find(known.begin(), known.end(), found->value) != known.end()) return found->value;
    fail(found->where, fmt::format("'{}' is {}", name, model::quote(found->value)),
         model::suggest_choice(found->value, known));
  };
  if (const std::string unit = choice("angle", {"degree", "radian"}); !unit.empty()) in_degrees_ = unit == "degree";
  if (const std::string limits = choice("autolimits", {"true", "false"}); !limits.empty())
    automatic_limits_ = limits == "true";
  if (const std::string geoms = choice("inertiafromgeom", {"auto", "true", "false"}); !geoms.empty())
    from_geoms_ = geoms == "auto" ? FromGeoms::when_missing : geoms == "true" ? FromGeoms::always : FromGeoms::never;
  if (const Attribute* sequence = element.find("eulerseq")) {
    const bool is_valid =
        sequence->value.size() == 3 && sequence->value.find_first_not_of("xyzXYZ") == std::string::npos;
    if (!is_valid)
      fail(sequence->where, fmt::format("'eulerseq' is {}", model::quote(sequence->value)),
           "write three of x, y, z for moving axes, or of X, Y, Z for fixed ones");
    sequence_ = sequence->value;
  }
  for (const char* folder : {"assetdir", "meshdir"})
    if (const Attribute* found = element.find(folder)) mesh_folder_ = found->value + "/";
  if (choice("coordinate", {"local", "global"}) == "global")
    fail(element.where, "the file has global coordinates", "load it with MuJoCo 2.3.2 or older and save it again");
  for (const Attribute& attribute : element.attributes) {
    for (const char* name : {"settotalmass", "balanceinertia", "boundmass", "boundinertia", "inertiagrouprange"})
      if (attribute.name == name)
        findings.add(fmt::format("{}=\"..\" of <compiler>", name), "masses and inertias are those of the elements",
                     attribute.where);
  }
}

void MjcfSettings::read_defaults(const Element& element, std::optional<std::size_t> parent) {
  std::size_t own = main_class;
  if (parent) {
    const Attribute& name = require_attribute(element, "class");
    own = classes_.size();
    if (!names_.emplace(name.value, own).second)
      fail(name.where, fmt::format("there are two classes {}", model::quote(name.value)), "give each its own name");
    classes_.push_back({parent, {}});
  } else if (const Attribute* name = element.find("class")) {
    names_.emplace(name->value, main_class);
  }
  for (const Element& child : element.children) {
    if (child.name == "default") continue;
    for (const Attribute& attribute : child.attributes)
      classes_[own].values[{kind_of(child.name), attribute.name}] = &attribute;
  }
  for (const Element& child : element.children)
    if (child.name == "default") read_defaults(child, own);
}

std::size_t MjcfSettings::class_named(const Attribute& name) const {
  const auto found = names_.find(name.value);
  if (found != names_.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [candidate, index] : names_) known.push_back(candidate);
  const std::string hint = model::did_you_mean(name.value, known);
  fail(name.where, fmt::format("there is no class {}", model::quote(name.value)),
       hint.empty() ? "add <default class=\"..\"> with this name" : hint);
}

MjcfElement MjcfSettings::with_defaults(const Element& element, std::size_t childclass) const {
  const Attribute* name = element.find("class");
  return {element, name == nullptr ? childclass : class_named(*name)};
}

std::size_t MjcfSettings::childclass_of(const Element& element, std::size_t current) const {
  const Attribute* name = element.find("childclass");
  return name == nullptr ? current : class_named(*name);
}

const Attribute* MjcfSettings::find(const MjcfElement& at, std::string_view attribute) const {
  if (const Attribute* own = at.element.find(attribute)) return own;
  const std::pair<std::string, std::string> key{kind_of(at.element.name), std::string(attribute)};
  for (std::optional<std::size_t> c = at.defaults; c; c = classes_[*c].parent)
    if (const auto found = classes_[*c].values.find(key); found != classes_[*c].values.end()) return found->second;
  return nullptr;
}

Number MjcfSettings::number(const MjcfElement& at, std::string_view attribute, const Number& otherwise) const {
  const Attribute* found = find(at, attribute);
  return found == nullptr ? otherwise : number_of(*found);
}

Vector MjcfSettings::vector(const MjcfElement& at, std::string_view attribute, const Vector& otherwise) const {
  const Attribute* found = find(at, attribute);
  return found == nullptr ? otherwise : vector_of(*found);
}

std::optional<bool> MjcfSettings::flag(const MjcfElement& at, std::string_view attribute) const {
  const Attribute* found = find(at, attribute);
  if (found == nullptr || found->value == "auto") return std::nullopt;
  if (found->value == "true" || found->value == "false") return found->value == "true";
  fail(found->where, fmt::format("'{}' is {}", attribute, model::quote(found->value)), "write true, false or auto");
}

long double MjcfSettings::angle(const Number& number) const {
  if (in_degrees_) return number.value / 180 * std::numbers::pi_v<long double>;
  if (!exact_angles_)
    if (const std::optional<Number> multiple = multiple_of_pi(number)) return multiple->value;
  return number.value;
}

Number MjcfSettings::radians(const Number& number) const { return in_degrees_ ? Number(angle(number)) : number; }

Matrix MjcfSettings::by_euler(const Vector& angles) const {
  Matrix result = identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const char axis = sequence_[i];
    const bool is_fixed = axis < 'a';
    Vector rpy;
    rpy[static_cast<std::size_t>(is_fixed ? axis - 'X' : axis - 'x')] = Number(angle(angles[i]));
    const Matrix turn = import::rotation(rpy);
    result = is_fixed ? turn * result : result * turn;
  }
  return result;
}

const Attribute* MjcfSettings::orientation_of(const MjcfElement& at) const {
  constexpr std::array names{"quat", "axisangle", "euler", "xyaxes", "zaxis"};
  const Attribute* found = nullptr;
  for (const char* name : names) {
    const Attribute* own = at.element.find(name);
    if (own != nullptr && found != nullptr)
      fail(own->where, fmt::format("'{}' and '{}' both state the orientation", found->name, name),
           "remove one of them");
    if (own != nullptr) found = own;
  }
  for (const char* name : names)
    if (found == nullptr) found = find(at, name);
  return found;
}

std::optional<Matrix> MjcfSettings::rotation(const MjcfElement& at) const {
  const Attribute* found = orientation_of(at);
  if (found == nullptr) return std::nullopt;
  if (found->name == "euler") return by_euler(vector_of(*found));
  const std::vector<long double> v = values_of(*found, found->name == "zaxis" ? 3 : found->name == "xyaxes" ? 6 : 4);
  const long double first_three = std::hypot(v[0], v[1], v[2]);
  if (found->name == "quat") {
    const long double length = std::hypot(first_three, v[3]);
    if (length == 0) fail_direction(*found);
    return from_quaternion(v[0] / length, v[1] / length, v[2] / length, v[3] / length);
  }
  if (first_three == 0) fail_direction(*found);
  if (found->name == "zaxis") return from_z_axis({v[0], v[1], v[2]});
  if (found->name == "axisangle") {
    const long double half = angle(numbers_of(*found, 4, 4)[3]) / 2, s = std::sin(half) / first_three;
    return from_quaternion(std::cos(half), v[0] * s, v[1] * s, v[2] * s);
  }
  const std::array<long double, 3> x{v[0] / first_three, v[1] / first_three, v[2] / first_three};
  const long double along = x[0] * v[3] + x[1] * v[4] + x[2] * v[5];
  std::array<long double, 3> y{v[3] - along * x[0], v[4] - along * x[1], v[5] - along * x[2]};
  const long double y_length = std::hypot(y[0], y[1], y[2]);
  if (y_length < 1e-15L) fail_direction(*found);
  for (long double& entry : y) entry /= y_length;
  const std::array<long double, 3> z{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  return snapped({{{x[0], y[0], z[0]}, {x[1], y[1], z[1]}, {x[2], y[2], z[2]}}});
}

Pose MjcfSettings::pose(const MjcfElement& at) const {
  Pose result;
  result.p = vector(at, "pos", {});
  if (const std::optional<Matrix> R = rotation(at); R && !is_identity(*R)) {
    result.R = *R;
    result.rpy.reset();
  }
  return result;
}

}  // namespace eomgen::import
