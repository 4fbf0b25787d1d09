// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of robot files for drawing: STL (binary, ASCII) and OBJ, reduced to few triangles. The files are untrusted:
// bytes and triangles are bounded.
// Method: vertex clustering (Rossignac and Borrel 1993): points in one cell of a grid become their mean.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace eomgen::import {

/// Largest mesh file in bytes, most triangles in it, most bytes of all meshes of a robot.
inline constexpr std::size_t max_mesh_bytes = std::size_t{1} << 26;
inline constexpr std::size_t max_mesh_triangles = 1000000;
inline constexpr std::size_t max_bytes_of_meshes = std::size_t{1} << 28;

struct Mesh {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Reads a mesh, by its name and contents. Returns none and the reason if it is not one.
std::optional<Mesh> read_mesh(const std::string& name, const std::string& bytes, std::string& why);

/// A mesh of at most so many triangles and points, with coordinates of four digits or more of its size. The same mesh
/// gives the same result. Empty if no triangle remains.
Mesh simplify(const Mesh& mesh, std::size_t most_triangles, std::size_t most_points);

}  // namespace eomgen::import
