// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/mjcf_geoms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "model/names.hpp"

namespace eomgen::import {
namespace {

constexpr long double density_of_water = 1000;

/// A solid of mass 1 at its centre: volume, principal moments about it.
struct Solid {
  long double volume;
  std::array<long double, 3> moments;
};

/// s: the sizes of the file, half lengths in place of lengths.
std::optional<Solid> solid_of(const std::string& type, const std::array<long double, 3>& s) {
  constexpr long double pi = std::numbers::pi_v<long double>;
  const long double r = s[0], length = 2 * s[1];
  if (type == "sphere") {
    const long double I = 2 * r * r / 5;
    return Solid{4 * pi / 3 * r * r * r, {I, I, I}};
  }
  if (type == "box")
    return Solid{8 * s[0] * s[1] * s[2],
                 {(s[1] * s[1] + s[2] * s[2]) / 3, (s[0] * s[0] + s[2] * s[2]) / 3, (s[0] * s[0] + s[1] * s[1]) / 3}};
  if (type == "ellipsoid")
    return Solid{4 * pi / 3 * s[0] * s[1] * s[2],
                 {(s[1] * s[1] + s[2] * s[2]) / 5, (s[0] * s[0] + s[2] * s[2]) / 5, (s[0] * s[0] + s[1] * s[1]) / 5}};
  if (type == "cylinder") {
    const long double across = (3 * r * r + length * length) / 12;
    return Solid{pi * r * r * length, {across, across, r * r / 2}};
  }
  if (type == "capsule") {
    const long double ball = 4 * r / (4 * r + 3 * length), tube = 1 - ball;  // shares of the mass
    const long double across =
        tube * (3 * r * r + length * length) / 12 + ball * (2 * r * r / 5 + length * length / 4 + 3 * r * length / 8);
    return Solid{pi * r * r * length + 4 * pi / 3 * r * r * r,
                 {across, across, tube * r * r / 2 + ball * 2 * r * r / 5}};
  }
  return std::nullopt;
}

std::size_t size_count(const std::string& type) {
  return type == "sphere" ? 1 : type == "cylinder" || type == "capsule" ? 2 : 3;
}

/// Sizes and the pose along the body's axes. fromto gives the axis, its middle and its half length.
struct Extent {
  std::array<Number, 3> size;
  Pose pose;
};

Extent extent_of(const MjcfElement& at, const MjcfSettings& settings, const std::string& type) {
  Extent extent{{}, settings.pose(at)};
  const std::size_t count = size_count(type);
  const Attribute* ends = type == "sphere" ? nullptr : settings.find(at, "fromto");
  const Attribute* size = settings.find(at, "size");
  if (size == nullptr) fail(at.element.where, fmt::format("the {} has no size", type), "add size=\"..\"");
  const std::vector<Number> sizes = numbers_of(*size, ends != nullptr ? 1 : count, 3);
  for (std::size_t k = 0; k < sizes.size(); ++k) extent.size[k] = sizes[k];
  if (ends != nullptr) {
    const std::vector<Number> v = numbers_of(*ends, 6, 6);
    std::array<long double, 3> d{};
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = v[k].value - v[k + 3].value;
      extent.pose.p[k] = Number((v[k].value + v[k + 3].value) / 2);
    }
    const long double length = std::hypot(d[0], d[1], d[2]);
    if (length == 0) fail(ends->where, "both ends of 'fromto' are equal", "write two points");
    if (count == 3) extent.size[1] = extent.size[0];  // boxes and ellipsoids are as thick as wide
    extent.size[count - 1] = Number(length / 2);
    extent.pose.R = from_z_axis(d);
    extent.pose.rpy.reset();
    if (is_identity(extent.pose.R)) extent.pose.rpy = Vector{};
  }
  for (std::size_t k = 0; k < count; ++k)
    if (!(extent.size[k].value > 0))
      fail(size->where, fmt::format("the {} has a size that is not above 0", type), "write lengths above 0");
  return extent;
}

Shape shape_of(const std::string& type, const Extent& extent, const SourceLocation& where) {
  const Number two(2);
  const auto& s = extent.size;
  if (type == "box") return Shape{ShapeKind::box, {two * s[0], two * s[1], two * s[2]}, extent.pose, where};
  if (type == "sphere") return Shape{ShapeKind::sphere, {s[0], {}, {}}, extent.pose, where};
  if (type == "cylinder") return Shape{ShapeKind::cylinder, {s[0], two * s[1], {}}, extent.pose, where};
  if (type == "capsule") return Shape{ShapeKind::capsule, {s[0], two * s[1], {}}, extent.pose, where};
  return Shape{ShapeKind::ellipsoid, {s[0], s[1], s[2]}, extent.pose, where};
}

}  // namespace

MjcfGeom read_geom(const MjcfElement& at, const MjcfSettings& settings, Findings& findings) {
  constexpr long double first_hidden_group = 3;  // MuJoCo shows groups 0 to 2
  const Attribute* stated = settings.find(at, "type");
  std::string type = stated != nullptr ? stated->value : "sphere";
  // A mesh alone, or a solid that MuJoCo fits to it.
  const bool is_solid = settings.find(at, "size") != nullptr || settings.find(at, "fromto") != nullptr;
  if (settings.find(at, "mesh") != nullptr && !is_solid) type = "mesh";
  const Attribute* mass = settings.find(at, "mass");
  MjcfGeom geom;
  constexpr const char* drawn_kinds = "boxes, capsules, cylinders, ellipsoids, spheres and mesh files are drawn";
  const bool is_hidden = settings.number(at, "group", Number()).value >= first_hidden_group;
  if (is_hidden) findings.add("geoms of groups 3 to 5", "MuJoCo hides them; they are not drawn", at.element.where);
  if (type == "plane" || type == "hfield" || type == "mesh" || type == "sdf") {
    const Attribute* name = settings.find(at, "mesh");
    const MjcfSettings::MeshAsset* file = type == "mesh" && name != nullptr ? settings.mesh(name->value) : nullptr;
    if (file != nullptr && !is_hidden)
      geom.shape = Shape{ShapeKind::mesh, file->scale, settings.pose(at), at.element.where, file->file};
    if (file == nullptr) findings.add(fmt::format("{} of <geom>", type), drawn_kinds, at.element.where);
    if (type == "mesh" && (mass == nullptr || !number_of(*mass).is_zero()))
      findings.add("masses of meshes", "a mesh has no mass here; state it with <inertial>", at.element.where);
    return geom;
  }
  const std::vector<std::string> known{"box",  "capsule", "cylinder", "ellipsoid", "hfield",
                                       "mesh", "plane",   "sdf",      "sphere"};
  if (std::find(known.begin(), known.end(), type) == known.end())
    fail(stated->where, fmt::format("there is no geom type {}", model::quote(type)),
         model::suggest_choice(type, known));
  const Extent extent = extent_of(at, settings, type);
  const std::optional<Solid> solid = solid_of(type, {extent.size[0].value, extent.size[1].value, extent.size[2].value});
  if (mass != nullptr) {
    geom.inertia.mass = number_of(*mass);
  } else {
    const Number density = settings.number(at, "density", Number(density_of_water));
    geom.inertia.mass = Number(density.value * solid->volume);
  }
  if (geom.inertia.mass.value < 0)
    fail(mass != nullptr ? mass->where : at.element.where, "the mass of the geom is negative", "a mass is at least 0");
  for (std::size_t k = 0; k < 3; ++k) geom.inertia.tensor[k][k] = Number(geom.inertia.mass.value * solid->moments[k]);
  geom.inertia = extent.pose * geom.inertia;
  if (is_hidden) return geom;
  geom.shape = shape_of(type, extent, at.element.where);
  return geom;
}

}  // namespace eomgen::import
