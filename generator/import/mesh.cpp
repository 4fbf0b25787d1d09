// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/mesh.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <eom/output/decimal.hpp>
#include <map>
#include <set>
#include <string_view>

namespace eomgen::import {
namespace {

using Corner = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

constexpr std::size_t stl_head = 84, stl_triangle = 50;

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t k = 0; k < 4; ++k) word |= std::uint32_t{static_cast<unsigned char>(bytes[at + k])} << (8 * k);
  return word;
}

bool is_finite(const Corner& p) {
  return std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x) && std::abs(x) < 1e9; });
}

/// Words of a text, line by line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  std::string_view next() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t' || rest_.front() == '\r'))
      rest_.remove_prefix(1);
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r"));
    rest_.remove_prefix(word.size());
    return word;
  }
  std::optional<double> number() {
    std::string_view word = next();
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = eom::decimals::read_decimal(word, value);
    if (problem != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
  }
  std::optional<Corner> corner() {
    const std::optional<double> x = number(), y = number(), z = number();
    if (!x || !y || !z || !is_finite({*x, *y, *z})) return std::nullopt;
    return Corner{*x, *y, *z};
  }

 private:
  std::string_view rest_;
};

/// Calls `visit` for each line; stops where it returns false.
template <class Visit>
bool for_each_line(std::string_view text, const Visit& visit) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (!visit(text.substr(0, end))) return false;
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return true;
}

bool add_triangle(Mesh& mesh) {
  const auto last = static_cast<std::uint32_t>(mesh.points.size());
  mesh.triangles.push_back({last - 3, last - 2, last - 1});
  return mesh.triangles.size() <= max_mesh_triangles;
}

bool read_binary_stl(const std::string& bytes, Mesh& mesh) {
  for (std::size_t at = stl_head; at + stl_triangle <= bytes.size(); at += stl_triangle) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Corner p{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t word = word_at(bytes, at + 12 + 12 * corner + 4 * k);  // after the normal
        float value = 0;
        std::memcpy(&value, &word, sizeof value);
        p[k] = value;
      }
      if (!is_finite(p)) return false;
      mesh.points.push_back(p);
    }
    if (!add_triangle(mesh)) return false;
  }
  return true;
}

bool read_ascii_stl(const std::string& bytes, Mesh& mesh) {
  return for_each_line(bytes, [&](std::string_view line) {
    Words words(line);
    if (words.next() != "vertex") return true;
    const std::optional<Corner> p = words.corner();
    if (!p) return false;
    mesh.points.push_back(*p);
    return mesh.points.size() % 3 != 0 || add_triangle(mesh);
  });
}

/// The point of "7/1/2" or "-1": numbers count from 1, negative ones from the last point.
std::optional<std::uint32_t> point_of(std::string_view word, std::size_t points) {
  long number = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (problem != std::errc() || (end != word.data() + word.size() && *end != '/')) return std::nullopt;
  const long index = number < 0 ? static_cast<long>(points) + number : number - 1;
  if (number == 0 || index < 0 || index >= static_cast<long>(points)) return std::nullopt;
  return static_cast<std::uint32_t>(index);
}

bool read_obj(const std::string& bytes, Mesh& mesh) {
  return for_each_line(bytes, [&](std::string_view line) {
    Words words(line);
    const std::string_view kind = words.next();
    if (kind == "v") {
      const std::optional<Corner> p = words.corner();
      if (p) mesh.points.push_back(*p);
      return p.has_value() && mesh.points.size() <= 3 * max_mesh_triangles;
    }
    if (kind != "f") return true;
    std::vector<std::uint32_t> face;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const std::optional<std::uint32_t> point = point_of(word, mesh.points.size());
      if (!point) return false;
      face.push_back(*point);
      if (face.size() < 3) continue;
      mesh.triangles.push_back({face[0], face[face.size() - 2], face.back()});
      if (mesh.triangles.size() > max_mesh_triangles) return false;
    }
    return face.size() >= 3;
  });
}

double distance(const Corner& a, const Corner& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// Whether a triangle has an area that counts.
bool has_area(const Corner& a, const Corner& b, const Corner& c, double size) {
  const Corner u{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const double area = std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
  const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
  return area > 1e-6 * size * longest;
}

struct Bounds {
  Corner low{}, high{};
  double size() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
};

Bounds bounds_of(const Mesh& mesh) {
  Bounds bounds;
  bool any = false;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle)
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = mesh.points[i][k];
        bounds.low[k] = any ? std::min(bounds.low[k], x) : x;
        bounds.high[k] = any ? std::max(bounds.high[k], x) : x;
        if (k == 2) any = true;
      }
  return bounds;
}

/// Triangles between means of cells; `cells` along the longest side.
Mesh clustered(const Mesh& mesh, const Bounds& bounds, double cells) {
  const double size = bounds.size(), width = size / cells, digit = std::pow(10, std::floor(std::log10(size)) - 4);
  using Cell = std::array<long, 3>;
  const auto cell_of = [&](const Corner& p) {
    Cell cell{};
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = std::min(static_cast<long>((p[k] - bounds.low[k]) / width), static_cast<long>(cells) - 1);
    return cell;
  };
  struct Sum {
    Corner total{};
    double count = 0;
  };
  std::map<Cell, Sum> sums;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle) {
      Sum& sum = sums[cell_of(mesh.points[i])];
      for (std::size_t k = 0; k < 3; ++k) sum.total[k] += mesh.points[i][k];
      ++sum.count;
    }
  Mesh result;
  std::map<Cell, std::uint32_t> point_of_digits, point_of_cell;  // means that agree in their digits are one point
  for (const auto& [cell, sum] : sums) {
    Cell digits{};
    for (std::size_t k = 0; k < 3; ++k) digits[k] = std::lround(sum.total[k] / sum.count / digit);
    const auto [found, is_new] = point_of_digits.emplace(digits, static_cast<std::uint32_t>(result.points.size()));
    if (is_new)
      result.points.push_back({static_cast<double>(digits[0]) * digit, static_cast<double>(digits[1]) * digit,
                               static_cast<double>(digits[2]) * digit});
    point_of_cell.emplace(cell, found->second);
  }
  std::set<Triangle> known;
  for (const Triangle& triangle : mesh.triangles) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = point_of_cell.at(cell_of(mesh.points[triangle[k]]));
    Triangle sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    if (sorted[0] == sorted[1] || sorted[1] == sorted[2] || !known.insert(sorted).second) continue;
    if (has_area(result.points[corners[0]], result.points[corners[1]], result.points[corners[2]], size))
      result.triangles.push_back(corners);
  }
  return result;
}

/// Without points that no triangle has.
Mesh with_used_points(const Mesh& mesh) {
  Mesh result;
  std::map<std::uint32_t, std::uint32_t> place;
  for (const Triangle& triangle : mesh.triangles) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [found, is_new] = place.emplace(triangle[k], static_cast<std::uint32_t>(result.points.size()));
      if (is_new) result.points.push_back(mesh.points[triangle[k]]);
      corners[k] = found->second;
    }
    result.triangles.push_back(corners);
  }
  return result;
}

}  // namespace

std::optional<Mesh> read_mesh(const std::string& name, const std::string& bytes, std::string& why) {
  std::string ending = name.substr(std::min(name.size(), name.rfind('.')));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return c < 128 ? std::tolower(c) : c; });
  if (ending != ".stl" && ending != ".obj") {
    why = "STL and OBJ files are drawn";
    return std::nullopt;
  }
  const bool is_binary = bytes.size() >= stl_head && (bytes.size() - stl_head) / stl_triangle == word_at(bytes, 80) &&
                         (bytes.size() - stl_head) % stl_triangle == 0;
  Mesh mesh;
  const bool is_valid = ending == ".obj" ? read_obj(bytes, mesh)
                        : is_binary      ? read_binary_stl(bytes, mesh)
                                         : read_ascii_stl(bytes, mesh);
  if (is_valid && !mesh.triangles.empty()) return mesh;
  why = "the file has no triangles, wrong numbers, or more than a million triangles";
  return std::nullopt;
}

Mesh simplify(const Mesh& mesh, std::size_t most_triangles, std::size_t most_points) {
  const Bounds bounds = bounds_of(mesh);
  if (!(bounds.size() > 0)) return {};
  constexpr double finest = 64;  // cells along the longest side
  const auto fits = [&](const Mesh& m) {
    return m.triangles.size() <= most_triangles && m.points.size() <= most_points;
  };
  const Mesh fine = with_used_points(clustered(mesh, bounds, finest));
  if (fits(fine)) return fine;
  for (double cells = finest; cells >= 2; cells = std::floor(cells * 0.85)) {
    Mesh result = with_used_points(clustered(fine, bounds, cells));
    if (fits(result)) return result;
  }
  return {};
}

}  // namespace eomgen::import
