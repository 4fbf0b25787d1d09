// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files of robots: reading, reduction to few triangles, and their place in a model.
#include "import/mesh.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "import/import.hpp"
#include "model/model.hpp"

using namespace eomgen;
using import::Mesh;
using import::read_mesh;
using import::simplify;

namespace {

/// A cube with the side 1 around the origin: 8 points, 6 polygons.
const std::string cube_obj =
    "# a cube\nv -.5 -.5 -.5\nv .5 -.5 -.5\nv .5 .5 -.5\nv -.5 .5 -.5\nv -.5 -.5 .5\nv .5 -.5 .5\nv .5 .5 .5\n"
    "v -.5 .5 .5\nvn 0 0 1\nf 4 3 2 1\nf 5/1 6/2 7/3 8/4\nf 1//1 2//1 6//1 5//1\nf -7 -6 -2 -3\nf 3 4 8 7\r\nf 4 1 5 "
    "8\n";

/// A unit sphere of n x 2n quadrilaterals.
Mesh sphere(std::size_t n) {
  Mesh mesh;
  for (std::size_t i = 0; i <= n; ++i)
    for (std::size_t k = 0; k < 2 * n; ++k) {
      const double theta = std::numbers::pi * static_cast<double>(i) / static_cast<double>(n),
                   phi = std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
      mesh.points.push_back({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t k = 0; k < 2 * n; ++k) {
      const auto row = static_cast<std::uint32_t>(2 * n);
      const std::uint32_t a = i * row + k, b = i * row + (k + 1) % row;
      mesh.triangles.push_back({a, b, a + row});
      mesh.triangles.push_back({b, b + row, a + row});
    }
  return mesh;
}

std::string binary_stl(const Mesh& mesh) {
  std::string bytes(80, ' ');
  const auto add = [&](const void* from, std::size_t count) { bytes.append(static_cast<const char*>(from), count); };
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  add(&count, 4);
  for (const auto& triangle : mesh.triangles) {
    const float normal[3] = {0, 0, 0};
    add(normal, sizeof normal);
    for (const std::uint32_t i : triangle)
      for (const double x : mesh.points[i]) {
        const float value = static_cast<float>(x);
        add(&value, 4);
      }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string ascii_stl(const Mesh& mesh) {
  std::string text = "solid s\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const std::uint32_t i : triangle)
      text += fmt::format("  vertex {} {} {:e}\n", mesh.points[i][0], mesh.points[i][1], mesh.points[i][2]);
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid s\n";
}

Mesh read_valid(const std::string& name, const std::string& bytes) {
  std::string why;
  const std::optional<Mesh> mesh = read_mesh(name, bytes, why);
  CAPTURE(why);
  REQUIRE(mesh);
  return *mesh;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    sum +=
        (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) /
        6;
  }
  return sum;
}

}  // namespace

TEST_CASE("a cube keeps its corners and its volume, from OBJ and from both kinds of STL") {
  const Mesh cube = read_valid("cube.OBJ", cube_obj);
  CHECK(cube.triangles.size() == 12);
  for (const Mesh& read : {cube, read_valid("c.stl", ascii_stl(cube)), read_valid("c.STL", binary_stl(cube))}) {
    const Mesh simple = simplify(read, 100, 100);
    CHECK(simple.points.size() == 8);
    CHECK(simple.triangles.size() == 12);
    CHECK(std::abs(volume(simple)) == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("a sphere of 20 000 triangles keeps its shape within its budget, always the same") {
  const Mesh fine = read_valid("s.stl", binary_stl(sphere(71)));
  CHECK(fine.triangles.size() == 20164);
  for (const std::size_t budget : {24, 100, 240}) {
    CAPTURE(budget);
    const Mesh simple = simplify(fine, budget, 160), again = simplify(fine, budget, 160);
    CHECK(simple.triangles.size() <= budget);
    CHECK(2 * simple.triangles.size() > budget / 3);
    CHECK(simple.points == again.points);
    CHECK(simple.triangles == again.triangles);
    for (const auto& p : simple.points) {
      const double r = std::hypot(p[0], p[1], p[2]);
      CHECK(r < 1.01);
      CHECK(r > (budget == 24 ? 0.5 : 0.8));
    }
  }
}

TEST_CASE("wrong mesh files are no meshes") {
  const std::string cube = binary_stl(read_valid("cube.obj", cube_obj));
  const auto reason = [](const std::string& name, const std::string& bytes) {
    std::string why;
    CHECK_FALSE(read_mesh(name, bytes, why));
    return why;
  };
  CHECK(reason("cube.dae", "<COLLADA/>") == "STL and OBJ files are drawn");
  CHECK(reason("cube", "") == "STL and OBJ files are drawn");
  std::string nan = cube;
  std::memset(nan.data() + 84 + 12, 0xff, 4);
  for (const std::string& bytes :
       {std::string(), std::string("solid s\nvertex 0 0\n"), cube.substr(0, cube.size() - 1), nan})
    CHECK(reason("c.stl", bytes).find("no triangles") != std::string::npos);
  for (const char* text : {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "v 0 0 0\nf 1 1\n", "v 0 0 0\nf 0 1 1\n",
                           "v a 0 0\n", "v 0 0 0\nf -2 1 1\n"})
    CHECK(reason("c.obj", text).find("no triangles") != std::string::npos);
  // No area.
  CHECK(simplify(read_valid("c.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), 100, 100).triangles.empty());
}

TEST_CASE("mesh files in the folder of a robot are drawn, along the axes of their body, and no others are read") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("eomgen_mesh_{}", ::getpid());
  std::filesystem::create_directories(folder / "robot/meshes");
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  write("robot/meshes/cube.obj", cube_obj);
  write("robot/meshes/ball.stl", binary_stl(sphere(40)));
  write("outside.stl", binary_stl(sphere(4)));
  const auto visual = [](const std::string& file, const std::string& more = "") {
    return "<visual><origin xyz=\"0 0 1\" rpy=\"0 0 0.5\"/><geometry><mesh filename=\"" + file + "\"" + more +
           "/></geometry></visual>";
  };
  write("robot/arm.urdf",
        "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"><inertial><origin xyz=\"0 0 0.5\"/><mass "
        "value=\"1\"/><inertia "
        "ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>" +
            visual("package://arm/meshes/cube.obj", " scale=\"0.2 0.2 0.4\"") + visual("meshes/ball.stl") +
            visual("../outside.stl") + visual((folder / "outside.stl").string()) + visual("meshes/none.stl") +
            "</link><joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>");
  write(
      "robot/arm.xml",
      "<mujoco><compiler meshdir=\"meshes\"/><asset><mesh file=\"cube.obj\" scale=\"2 2 2\"/></asset><worldbody><body "
      "name=\"b\"><joint name=\"j\"/><inertial mass=\"1\" diaginertia=\"1 1 1\"/><geom type=\"mesh\" mesh=\"cube\" "
      "mass=\"0\"/></body></worldbody></mujoco>");
  const import::ImportedModel urdf = import::import_file((folder / "robot/arm.urdf").string(), {});
  const import::ImportedModel mjcf = import::import_file((folder / "robot/arm.xml").string(), {});
  std::filesystem::remove_all(folder);
  const model::Model model = model::read_model_text(urdf.text, "arm.toml");
  REQUIRE(model.drawn.size() == 2);
  CHECK(model.drawn[0].faces.size() == 12);
  CHECK(model.drawn[1].faces.size() <= 240);
  CHECK(model.drawn[1].faces.size() > 60);
  // The corner (0.1, 0.1, 0.2) of the cube, turned by 0.5 about z, above the centre of mass by 0.5.
  const double c = std::cos(0.5), s = std::sin(0.5);
  const std::string corner = fmt::format("[{:.5f}", 0.1 * (c - s)).substr(0, 7);
  CHECK(urdf.text.find(corner) != std::string::npos);
  CHECK(urdf.text.find("0.7]") != std::string::npos);
  std::size_t not_drawn = 0;
  for (const import::Finding& finding : urdf.findings.entries())
    if (finding.what == "meshes that are not drawn") not_drawn += finding.count;
  CHECK(not_drawn == 3);
  CHECK(model::read_model_text(mjcf.text, "arm.toml").drawn.at(0).faces.size() == 12);
  CHECK(mjcf.text.find("[-1, -1, -1]") != std::string::npos);
}
