// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files of a robot as [draw] meshes of few triangles.

#include <algorithm>

#include "import/mesh.hpp"
#include "import/model_text.hpp"
#include "import/solid_mesh.hpp"
#include "model/data_file.hpp"

namespace eomgen::import {
namespace {

// Of one mesh, and of all meshes of a robot together.
constexpr std::size_t most_triangles = 240, most_points = 160, fewest_triangles = 24, triangles_of_robot = 4800;

/// A reason why a file is not drawn.
struct NotDrawn {
  std::string why;
};

/// Paths of a mesh in the robot's folder, most likely first. Packages of ROS have the robot file in a folder of their
/// own, so that names of packages and leading folders may be missing here.
std::vector<std::string> candidates(std::string name) {
  for (const char* scheme : {"package://", "model://", "file://"}) {
    if (!name.starts_with(scheme)) continue;
    name.erase(0, std::string_view(scheme).size());
  }
  std::vector<std::string> result;
  for (std::size_t at = 0; at != std::string::npos && result.size() < 10;) {
    while (at < name.size() && name[at] == '/') ++at;
    result.push_back(name.substr(at));
    const std::size_t slash = name.find('/', at);
    at = slash == std::string::npos ? slash : slash + 1;
  }
  return result;
}

std::string bytes_of(const std::string& folder, const std::string& name) {
  std::string why = "no file of this name is in the folder of the robot file";
  for (const std::string& path : candidates(name)) {
    try {
      return model::read_data_file(folder, path, max_mesh_bytes);
    } catch (const model::DataFileError& error) {
      if (error.problem() != model::DataFileProblem::missing) why = error.message();
    }
  }
  throw NotDrawn{why};
}

}  // namespace

void ModelWriter::write_mesh(const Shape& shape, const Pose& pose, const Vector& centre,
                             std::vector<std::string>& texts) {
  try {
    if (options_.folder.empty()) throw NotDrawn{"a robot that is given as text has no mesh files"};
    const std::string bytes = bytes_of(options_.folder, shape.file);
    mesh_bytes_ += bytes.size();
    if (mesh_bytes_ > max_bytes_of_meshes) throw NotDrawn{"the meshes of the robot have more than 256 MiB"};
    std::string why;
    std::optional<Mesh> mesh = read_mesh(shape.file, bytes, why);
    if (!mesh) throw NotDrawn{why};
    for (std::array<double, 3>& point : mesh->points) {
      Vector scaled;
      for (std::size_t k = 0; k < 3; ++k) scaled[k] = Number(point[k] * shape.size[k].value);
      const Vector at = pose.p + pose.R * scaled - centre;
      for (std::size_t k = 0; k < 3; ++k) point[k] = static_cast<double>(at[k].value);
    }
    const std::size_t share = std::max(fewest_triangles, triangles_of_robot / meshes_);
    const Mesh drawn = simplify(*mesh, std::min(most_triangles, share), most_points);
    if (drawn.triangles.empty()) throw NotDrawn{"the mesh has no extent"};
    PolygonMesh polygons{drawn.points, {}};
    for (const std::array<std::uint32_t, 3>& t : drawn.triangles) polygons.faces.emplace_back(t.begin(), t.end());
    texts.push_back(drawn_mesh(polygons));
    if (drawn.triangles.size() < mesh->triangles.size())
      findings_.add("triangles of meshes", "meshes are drawn with fewer triangles", shape.where);
  } catch (const NotDrawn& reason) {
    findings_.add("meshes that are not drawn", reason.why, shape.where);
  }
}

}  // namespace eomgen::import
