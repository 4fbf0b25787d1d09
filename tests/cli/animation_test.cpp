// SPDX-License-Identifier: GPL-3.0-or-later
// The file of `run --animation`, read by the rules of glTF 2.0 and compared with the table of the same run.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "program.hpp"

using namespace eomgen::test;

namespace {

constexpr double single = 1e-6;  // relative rounding of the numbers of the file, with a margin

using Tuples = std::vector<std::vector<double>>;

/// A file with its JSON and its numbers.
class Gltf {
 public:
  explicit Gltf(const std::string& bytes) {
    REQUIRE(bytes.size() > 28);
    REQUIRE(bytes.substr(0, 4) == "glTF");
    CHECK(integer(bytes, 4) == 2);
    CHECK(integer(bytes, 8) == bytes.size());
    const std::size_t length = integer(bytes, 12);
    CHECK(bytes.substr(16, 4) == "JSON");
    REQUIRE(20 + length + 8 <= bytes.size());
    json = Json::parse(bytes.substr(20, length));
    CHECK(integer(bytes, 20 + length) == bytes.size() - 28 - length);
    binary_ = bytes.substr(28 + length);
    CHECK(json["buffers"][0]["byteLength"] == binary_.size());
  }

  Tuples numbers(const Json& index) const {
    const Json& accessor = json["accessors"].at(index.get<std::size_t>());
    const Json& view = json["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
    const std::string type = accessor["type"];
    const std::size_t width = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
    const std::size_t begin = view["byteOffset"], count = accessor["count"];
    REQUIRE(view["byteLength"] == 4 * width * count);
    REQUIRE(begin + 4 * width * count <= binary_.size());
    Tuples result;
    for (std::size_t i = 0; i < count; ++i) {
      result.emplace_back();
      for (std::size_t k = 0; k < width; ++k) {
        const std::size_t at = begin + 4 * (i * width + k);
        float number = 0;
        std::memcpy(&number, binary_.data() + at, 4);
        result.back().push_back(accessor["componentType"] == 5126 ? number : static_cast<double>(integer(binary_, at)));
      }
    }
    return result;
  }

  std::size_t node(const std::string& name) const {
    for (std::size_t i = 0; i < json["nodes"].size(); ++i) {
      if (json["nodes"][i]["name"] == name) return i;
    }
    FAIL("no node " << name);
    return 0;
  }

  /// Keyframes of a node: times and values.
  std::pair<Tuples, Tuples> channel(const std::string& name, const std::string& path) const {
    for (const Json& channel : json["animations"][0]["channels"]) {
      if (channel["target"]["node"] != node(name) || channel["target"]["path"] != path) continue;
      const Json& sampler = json["animations"][0]["samplers"].at(channel["sampler"].get<std::size_t>());
      return {numbers(sampler["input"]), numbers(sampler["output"])};
    }
    FAIL("no channel " << path << " of " << name);
    return {};
  }

  Json json;

 private:
  static std::uint32_t integer(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  }
  std::string binary_;
};

std::array<double, 3> turned(const std::vector<double>& q, const std::array<double, 3>& v) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const std::array<double, 3> t{2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])};
  return {v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
          v[2] + w * t[2] + x * t[1] - y * t[0]};
}

constexpr const char* swing = R"toml(format = 1
title = "A <swing> & \"spring\""
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
L = "0.8 m"
k = "40 N/m"
[coordinates]
theta = "rad"
[[body]]
name = "bar"
mass = "m"
inertia = { principal = ["m*L^2/12", "m*L^2/1200", "m*L^2/12"] }
position = ["L/2*sin(theta)", 0, "-L/2*cos(theta)"]
rotation = { axis = "E2", angle = "-theta" }
[[particle]]
name = "bob"
mass = "m"
position = { cartesian = ["x", "y", "z"] }
[[force]]
gravity = "-g*E3"
[[point]]
name = "tip"
on = "bar"
at = [0, 0, "-L/2"]
[[force]]
spring = { between = ["tip", "bob"], stiffness = "k", length = "L/4" }
[scene.default]
t = [1, 4]
initial = { theta = 1, x = 0.3, z = -1.2 }
outputs = ["bob.position1", "bob.position2", "bob.position3", "bar.position1", "bar.position2", "bar.position3"]
)toml";

}  // namespace

TEST_CASE("animation: keyframes of a file are the rows of the run, upright, with sound meshes") {
  const Folder folder;
  folder.write("swing.toml", swing);
  const Json run = document(folder, {"run", "swing.toml", "--animation", "a.glb", "--out", "a.csv", "--every", "0.02"});
  CHECK(run["files"].size() == 2);
  const Table table = read_table(folder.read("a.csv"));
  const Gltf gltf(folder.read("a.glb"));
  CHECK(gltf.json["asset"]["version"] == "2.0");
  CHECK(gltf.json["scenes"][0]["name"] == "A <swing> & \"spring\"");
  for (const char* name : {"bar", "bob"}) {
    CAPTURE(std::string(name));
    const auto [t, r] = gltf.channel(name, "translation");
    REQUIRE(t.size() == table.rows.size());
    for (std::size_t k = 0; k < t.size(); ++k) {
      CHECK(t[k][0] == doctest::Approx(table.rows[k][0] - 1).epsilon(single));
      for (std::size_t i = 0; i < 3; ++i)
        CHECK(std::abs(r[k][i] - table.at(k, std::string(name) + ".position" + std::to_string(i + 1))) < 2 * single);
    }
  }
  // The third axis of the bar, by the rotation about -E2.
  const auto [t, q] = gltf.channel("bar", "rotation");
  for (std::size_t k = 0; k < t.size(); ++k) {
    const std::array<double, 3> e3 = turned(q[k], {0, 0, 1});
    const double theta = table.at(k, "theta");
    CHECK(std::abs(e3[0] + std::sin(theta)) < 2 * single);
    CHECK(std::abs(e3[1]) < single);
    CHECK(std::abs(e3[2] - std::cos(theta)) < 2 * single);
    if (k > 0) CHECK(q[k][0] * q[k - 1][0] + q[k][1] * q[k - 1][1] + q[k][2] * q[k - 1][2] + q[k][3] * q[k - 1][3] > 0);
  }
  // A spring of length 1 along its third axis, from the bar to the bob.
  const auto [times, length] = gltf.channel("spring", "scale");
  const auto turn = gltf.channel("spring", "rotation").second, foot = gltf.channel("spring", "translation").second;
  const auto bob = gltf.channel("bob", "translation").second;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::array<double, 3> along = turned(turn[k], {0, 0, length[k][2]});
    for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(foot[k][i] + along[i] - bob[k][i]) < 5 * single);
  }
  // Gravity acts along -E3, and the second axis of a file is up.
  const Json& root = gltf.json["nodes"].at(gltf.json["scenes"][0]["nodes"][0].get<std::size_t>());
  const std::array<double, 3> up = turned(root["rotation"].get<std::vector<double>>(), {0, 0, 1});
  CHECK(up[1] == doctest::Approx(1));
  CHECK(root["children"].size() == gltf.json["nodes"].size() - 1);
}

TEST_CASE("animation: triangles have their outside to the left, and bounds hold") {
  const Folder folder;
  for (const char* model : {"R10_lagrange_top", "S5_double_pendulum", "R16_sphere_on_sphere"}) {
    CAPTURE(std::string(model));
    expect(0, folder, {"run", model, "--animation", "a.glb", "--t-end", "0.2", "--no-error-estimate"});
    const Gltf gltf(folder.read("a.glb"));
    REQUIRE_FALSE(gltf.json["meshes"].empty());
    for (const Json& mesh : gltf.json["meshes"]) {
      const Json& primitive = mesh["primitives"][0];
      const Tuples points = gltf.numbers(primitive["attributes"]["POSITION"]);
      const Tuples normals = gltf.numbers(primitive["attributes"]["NORMAL"]);
      const Tuples corners = gltf.numbers(primitive["indices"]);
      REQUIRE(normals.size() == points.size());
      const Json& accessor = gltf.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
      for (const std::vector<double>& p : points) {
        for (std::size_t i = 0; i < 3; ++i) {
          CHECK(p[i] >= accessor["min"][i].get<double>());
          CHECK(p[i] <= accessor["max"][i].get<double>());
        }
      }
      for (std::size_t k = 0; k < corners.size(); k += 3) {
        std::array<std::vector<double>, 3> corner;
        std::vector<double> normal(3);
        for (std::size_t i = 0; i < 3; ++i) {
          const auto at = static_cast<std::size_t>(corners[k + i][0]);
          REQUIRE(at < points.size());
          corner[i] = points[at];
          for (std::size_t j = 0; j < 3; ++j) normal[j] += normals[at][j];
        }
        double triple = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          const std::size_t j = (i + 1) % 3, l = (i + 2) % 3;
          triple += normal[i] * ((corner[1][j] - corner[0][j]) * (corner[2][l] - corner[0][l]) -
                                 (corner[1][l] - corner[0][l]) * (corner[2][j] - corner[0][j]));
        }
        CHECK(triple > 0);
      }
    }
  }
}

TEST_CASE("animation: a model without positions, another ending, and a folder that does not exist are refused") {
  const Folder folder;
  folder.write("o.toml", oscillator_text());
  CHECK(contains(expect(2, folder, {"run", "o.toml", "--animation", "a.svg"}).err, ".glb"));
  CHECK(contains(expect(2, folder, {"run", "o.toml", "--animation", "none/a.glb"}).err, "none"));
  CHECK_FALSE(folder.has("a.glb"));
  folder.write("energies.toml",
               "format = 1\n[parameters]\nm = 1\n[coordinates]\nx = \"m\"\n[energy]\nkinetic = \"m/2*x_dot^2\"\n"
               "potential = \"m/2*x^2\"\n[scene.default]\nt = [0, 1]\ninitial = { x = 1 }\n");
  CHECK(contains(expect(2, folder, {"run", "energies.toml", "--animation", "a.glb"}).err, "nothing to animate"));
  CHECK_FALSE(folder.has("a.glb"));
}

TEST_CASE("animation: a part without a position in some row is left out and reported; keyframes are bounded") {
  const Folder folder;
  folder.write("turn.toml",
               "format = 1\n[parameters]\nm = \"1 kg\"\nL = \"1 m\"\n[coordinates]\nth = \"rad\"\n"
               "[[body]]\nname = \"B\"\nmass = \"m\"\ninertia = { principal = [\"m*L^2\", \"m*L^2\", \"m*L^2\"] }\n"
               "position = [0, 0, 0]\nrotation = { axis = \"E3\", angle = \"th\" }\n"
               "[[point]]\nname = \"Q\"\non = \"B\"\nat = [\"sqrt(0.5[m^2] - th*L^2)\", 0, 0]\n"
               "[scene.default]\nt = [0, 1]\ninitial = { th_dot = 1 }\n");
  const auto names = [&] {
    std::vector<std::string> result;
    const Gltf gltf(folder.read("a.glb"));
    for (const Json& node : gltf.json["nodes"]) result.push_back(node["name"]);
    return result;
  };
  CHECK(contains(expect(0, folder, {"run", "turn.toml", "--animation", "a.glb"}).err, "not in the animation"));
  CHECK(names() == std::vector<std::string>{"B", "turn"});
  CHECK_FALSE(
      contains(expect(0, folder, {"run", "turn.toml", "--animation", "a.glb", "--t-end", "0.4"}).err, "not in the"));
  const std::vector<std::string> all = names();
  CHECK(std::find(all.begin(), all.end(), "Q") != all.end());
  expect(0, folder, {"run", "turn.toml", "--animation", "a.glb", "--every", "0.00003", "--no-error-estimate"});
  const std::size_t keyframes = Gltf(folder.read("a.glb")).channel("B", "rotation").first.size();
  CHECK(keyframes <= 20000);
  CHECK(keyframes > 10000);
}
