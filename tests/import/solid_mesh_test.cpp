// SPDX-License-Identifier: GPL-3.0-or-later
// Solids of robot files that [draw] has no shape for: their meshes, and their place in a model.
#include "import/solid_mesh.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import/import.hpp"
#include "model/model.hpp"

using namespace eomgen;
using import::mesh_of_solid;
using import::PolygonMesh;
using import::ShapeKind;

namespace {

/// Positive if the faces are counterclockwise as seen from outside.
double enclosed_volume(const PolygonMesh& mesh) {
  double sum = 0;
  for (const std::vector<std::uint32_t>& face : mesh.faces)
    for (std::size_t k = 2; k < face.size(); ++k) {
      const auto &a = mesh.points[face[0]], &b = mesh.points[face[k - 1]], &c = mesh.points[face[k]];
      sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
              a[2] * (b[0] * c[1] - b[1] * c[0])) /
             6;
    }
  return sum;
}

std::string mujoco_with(const std::string& geoms) {
  return "<mujoco><compiler angle=\"radian\"/><worldbody><body name=\"b\"><joint axis=\"0 1 0\"/><inertial mass=\"1\" "
         "diaginertia=\"1 1 1\" pos=\"0 0 0.5\"/>" +
         geoms + "</body></worldbody></mujoco>";
}

}  // namespace

TEST_CASE("meshes of solids are closed, and have the volume of their polyhedron") {
  const PolygonMesh box = mesh_of_solid(ShapeKind::box, {1, 2, 3});
  CHECK(enclosed_volume(box) == doctest::Approx(6).epsilon(1e-14));
  const PolygonMesh cylinder = mesh_of_solid(ShapeKind::cylinder, {0.5, 2, {}});
  CHECK(enclosed_volume(cylinder) == doctest::Approx(6 * 0.25 * std::sin(std::numbers::pi / 6) * 2).epsilon(1e-14));
  const PolygonMesh ellipsoid = mesh_of_solid(ShapeKind::ellipsoid, {1, 2, 3});
  CHECK(ellipsoid.points.size() == 62);
  for (const auto& p : ellipsoid.points)
    CHECK(p[0] * p[0] + p[1] * p[1] / 4 + p[2] * p[2] / 9 == doctest::Approx(1).epsilon(1e-14));
  CHECK(enclosed_volume(ellipsoid) < 4 * std::numbers::pi / 3 * 6);
  CHECK(enclosed_volume(ellipsoid) > 0.85 * 4 * std::numbers::pi / 3 * 6);
  for (const PolygonMesh& mesh : {box, cylinder, ellipsoid}) {
    // Every edge belongs to two faces, in opposite directions.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& face : mesh.faces)
      for (std::size_t k = 0; k < face.size(); ++k) edges.emplace_back(face[k], face[(k + 1) % face.size()]);
    for (const auto& [from, to] : edges) {
      CHECK(std::count(edges.begin(), edges.end(), std::pair(from, to)) == 1);
      CHECK(std::count(edges.begin(), edges.end(), std::pair(to, from)) == 1);
    }
  }
}

TEST_CASE("turned boxes, cylinders and capsules, and ellipsoids are drawn as meshes at their place") {
  const import::ImportedModel imported = import::import_text(
      "m.xml",
      mujoco_with("<geom type=\"box\" size=\"0.1 0.1 0.2\" pos=\"0 0 1\" euler=\"0 0 0.5\" mass=\"0\"/>"
                  "<geom type=\"cylinder\" size=\"0.1 0.2\" euler=\"0.3 0 0\" mass=\"0\"/>"
                  "<geom type=\"capsule\" size=\"0.1\" fromto=\"0 0 0.5 0.3 0 0.9\" mass=\"0\"/>"
                  "<geom type=\"ellipsoid\" size=\"0.1 0.2 0.3\" mass=\"0\"/>"
                  "<geom type=\"capsule\" size=\"0.1 0.2\" mass=\"0\"/>"),
      {});
  for (const import::Finding& finding : imported.findings.entries()) CHECK(finding.what == "contacts of <geom>");
  const model::Model model = model::read_model_text(imported.text, "m.toml");
  std::vector<std::string> kinds;
  for (const model::ShapeSpec& shape : model.drawn) kinds.push_back(shape.kind);
  CHECK(kinds ==
        std::vector<std::string>{"mesh", "mesh", "sphere", "sphere", "mesh", "mesh", "sphere", "sphere", "cylinder"});
  CHECK(model.drawn[0].faces.size() == 6);
  CHECK(model.drawn[1].faces.size() == 14);
  CHECK(model.drawn[5].faces.size() == 72);
  // The corner (0.1, 0.1, 0.2) of the box, turned by 0.5 about z, above the centre of mass by 0.5.
  const double c = std::cos(0.5), s = std::sin(0.5);
  CHECK(imported.text.find(fmt::format("[{:.9g}, {:.9g}, 0.7]", 0.1 * (c - s), 0.1 * (c + s))) != std::string::npos);
  // The ends of the turned capsule, from the centre of mass.
  CHECK(imported.text.find("sphere = \"0.1 m\", at = [\"0.3 m\", 0, \"0.4 m\"]") != std::string::npos);
}

TEST_CASE("turned boxes and cylinders of a URDF file are drawn") {
  const import::ImportedModel imported = import::import_text(
      "r.urdf",
      "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" "
      "izz=\"1\"/></inertial><visual><origin rpy=\"0.2 0 0\"/><geometry><box size=\"1 2 3\"/></geometry></visual>"
      "<visual><origin rpy=\"0 0.3 0\"/><geometry><cylinder radius=\"1\" length=\"2\"/></geometry></visual></link>"
      "<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>",
      {});
  CHECK(imported.findings.entries().empty());
  CHECK(model::read_model_text(imported.text, "r.toml").drawn.size() == 2);
}

TEST_CASE("meshes of turned shapes stay within the size of a model file") {
  std::string geoms;
  for (int k = 0; k < 1000; ++k) geoms += "<geom type=\"ellipsoid\" size=\"0.1 0.2 0.3\" mass=\"0\"/>";
  const import::ImportedModel imported = import::import_text("m.xml", mujoco_with(geoms), {});
  CHECK(model::read_model_text(imported.text, "m.toml").drawn.size() == 96);
  std::size_t left_out = 0;
  for (const import::Finding& finding : imported.findings.entries())
    if (finding.what == "turned shapes") left_out += finding.count;
  CHECK(left_out == 904);
}
