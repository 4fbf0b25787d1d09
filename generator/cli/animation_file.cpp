// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/animation_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>

#include "analysis/drawing/animation.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

using analysis::AnimatedKind;
using analysis::AnimatedNode;
using analysis::Animation;
using analysis::Point;

namespace {

// Encoder of glTF 2.0 in one binary file (Khronos, glTF 2.0 Specification, section 4): meshes with keyframes, which
// studios such as Blender and browsers show.

// Numbers of the specification.
constexpr int float_type = 5126, unsigned_type = 5125, vertex_buffer = 34962, index_buffer = 34963;
constexpr std::uint32_t magic = 0x46546C67, version = 2, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

static_assert(std::endian::native == std::endian::little, "glTF stores little-endian numbers");

struct Material {
  const char* name;
  double red, green, blue;
};
/// Per AnimatedKind.
constexpr std::array<Material, analysis::animated_kinds> materials{{{"body", 0.10, 0.28, 0.55},
                                                                    {"particle", 0.70, 0.16, 0.10},
                                                                    {"point", 0.35, 0.35, 0.35},
                                                                    {"rod", 0.45, 0.45, 0.48},
                                                                    {"spring", 0.12, 0.45, 0.20},
                                                                    {"damper", 0.55, 0.40, 0.10}}};

template <class T>
void append_bytes(std::string& bytes, T value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof value);
  bytes.append(raw.data(), raw.size());
}

class Document {
 public:
  Document(const Animation& animation, const std::string& title) {
    for (const Material& c : materials) {
      materials_.push_back(
          {{"name", c.name},
           {"doubleSided", true},
           {"pbrMetallicRoughness",
            {{"baseColorFactor", {c.red, c.green, c.blue, 1.0}}, {"metallicFactor", 0.1}, {"roughnessFactor", 0.6}}}});
    }
    select_keyframes(animation.t);
    const std::size_t times = floats(times_, 1, true, 0);
    for (const AnimatedNode& node : animation.nodes) add(node, times);
    // The root, which turns the others upright, is the last node.
    Json children = Json::array();
    for (std::size_t i = 0; i < animation.nodes.size(); ++i) children.push_back(i);
    nodes_.push_back({{"name", title}, {"rotation", quaternion(animation.upright)}, {"children", children}});
    json_ = {{"asset", {{"version", "2.0"}, {"generator", "eomgen"}}},
             {"scene", 0},
             {"scenes", Json::array({{{"name", title}, {"nodes", Json::array({animation.nodes.size()})}}})},
             {"nodes", nodes_},
             {"meshes", meshes_},
             {"materials", materials_},
             {"accessors", accessors_},
             {"bufferViews", views_},
             {"buffers", Json::array({{{"byteLength", bytes_.size()}}})},
             {"animations", Json::array({{{"name", "run"}, {"channels", channels_}, {"samplers", samplers_}}})}};
  }

  std::string file() const {
    std::string text = serialised(json_);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string result;
    append_bytes(result, magic);
    append_bytes(result, version);
    append_bytes(result, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes_.size()));
    append_bytes(result, static_cast<std::uint32_t>(text.size()));
    append_bytes(result, json_chunk);
    result += text;
    append_bytes(result, static_cast<std::uint32_t>(bytes_.size()));
    append_bytes(result, binary_chunk);
    return result + bytes_;
  }

 private:
  static Json quaternion(const Eigen::Quaterniond& q) { return Json::array({q.x(), q.y(), q.z(), q.w()}); }

  /// Keyframes whose times differ in single precision.
  void select_keyframes(const std::vector<double>& t) {
    for (std::size_t k = 0; k < t.size(); ++k) {
      const auto at = static_cast<float>(t[k] - t.front());
      if (!times_.empty() && at <= times_.back())
        keyframes_.back() = k;
      else
        times_.push_back(at), keyframes_.push_back(k);
    }
  }

  std::size_t view(std::size_t begin, int target) {
    Json entry{{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes_.size() - begin}};
    if (target != 0) entry["target"] = target;
    views_.push_back(std::move(entry));
    return views_.size() - 1;
  }

  /// An accessor of tuples of `width` floats.
  std::size_t floats(const std::vector<float>& values, std::size_t width, bool bounds, int target) {
    const std::size_t begin = bytes_.size();
    for (const float x : values) append_bytes(bytes_, x);
    static constexpr std::array<const char*, 5> types{"", "SCALAR", "", "VEC3", "VEC4"};
    Json entry{{"bufferView", view(begin, target)},
               {"componentType", float_type},
               {"count", values.size() / width},
               {"type", types[width]}};
    if (bounds) {
      std::vector<float> low(width, std::numeric_limits<float>::max()),
          high(width, std::numeric_limits<float>::lowest());
      for (std::size_t i = 0; i < values.size(); ++i) {
        low[i % width] = std::min(low[i % width], values[i]);
        high[i % width] = std::max(high[i % width], values[i]);
      }
      entry["min"] = Json(low);
      entry["max"] = Json(high);
    }
    accessors_.push_back(std::move(entry));
    return accessors_.size() - 1;
  }

  static std::vector<float> flattened(const std::vector<Point>& points) {
    std::vector<float> result;
    for (const Point& p : points) {
      for (int k = 0; k < 3; ++k) result.push_back(static_cast<float>(p[k]));
    }
    return result;
  }

  std::size_t indices(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const std::size_t begin = bytes_.size();
    for (const auto& triangle : triangles) {
      for (const std::uint32_t i : triangle) append_bytes(bytes_, i);
    }
    accessors_.push_back({{"bufferView", view(begin, index_buffer)},
                          {"componentType", unsigned_type},
                          {"count", 3 * triangles.size()},
                          {"type", "SCALAR"}});
    return accessors_.size() - 1;
  }

  void add(const AnimatedNode& node, std::size_t times) {
    const std::size_t points = floats(flattened(node.mesh.points), 3, true, vertex_buffer),
                      normals = floats(flattened(node.mesh.normals), 3, false, vertex_buffer);
    const Json primitive{{"attributes", {{"POSITION", points}, {"NORMAL", normals}}},
                         {"indices", indices(node.mesh.triangles)},
                         {"material", static_cast<std::size_t>(node.kind)}};
    meshes_.push_back({{"name", node.name}, {"primitives", Json::array({primitive})}});
    const std::size_t index = nodes_.size();
    nodes_.push_back({{"name", node.name}, {"mesh", meshes_.size() - 1}});
    const auto channel = [&](const char* path, std::size_t width, bool exists,
                             const std::function<std::array<double, 4>(std::size_t)>& at) {
      if (!exists) return;
      std::vector<float> values;
      for (const std::size_t k : keyframes_) {
        const std::array<double, 4> value = at(k);
        for (std::size_t i = 0; i < width; ++i) values.push_back(static_cast<float>(value[i]));
      }
      channels_.push_back({{"sampler", samplers_.size()}, {"target", {{"node", index}, {"path", path}}}});
      samplers_.push_back({{"input", times}, {"interpolation", "LINEAR"}, {"output", floats(values, width, false, 0)}});
    };
    channel("translation", 3, !node.translation.empty(), [&](std::size_t k) -> std::array<double, 4> {
      const Point& p = node.translation[k];
      return {p.x(), p.y(), p.z(), 0};
    });
    channel("rotation", 4, !node.rotation.empty(), [&](std::size_t k) -> std::array<double, 4> {
      const Eigen::Quaterniond& q = node.rotation[k];
      return {q.x(), q.y(), q.z(), q.w()};
    });
    channel("scale", 3, !node.length.empty(), [&](std::size_t k) -> std::array<double, 4> {
      return {1, 1, node.length[k], 0};
    });
  }

  Json json_;
  Json nodes_ = Json::array(), meshes_ = Json::array(), materials_ = Json::array(), accessors_ = Json::array(),
       views_ = Json::array(), channels_ = Json::array(), samplers_ = Json::array();
  std::string bytes_;
  std::vector<float> times_;
  std::vector<std::size_t> keyframes_;
};

/// Returns the bytes of the file. Times are relative to the first keyframe, in single precision as all numbers of the
/// file; of keyframes that fall together the last one counts. At least one node and one keyframe.
std::string encode_glb(const Animation& animation, const std::string& title) {
  return Document(animation, title).file();
}

constexpr double most_keyframes = 2e4;

}  // namespace

std::vector<std::string> AnimationFile::prepare(pipeline::DerivedModel& derived) {
  drawing_.emplace(derived.mechanics);
  if (drawing_->parts().places.empty())
    throw Error("run", {}, "the model has no position of a particle or body, so that there is nothing to animate",
                "give positions, or leave --animation out");
  for (system::EquationSystem& candidate : derived.candidates) drawing_->add_outputs(candidate);
  return drawing_->outputs();
}

void AnimationFile::begin(const std::vector<std::string>& names, double expected_rows) {
  for (const std::string& name : drawing_->outputs())
    index_.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
  stride_ = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(expected_rows / most_keyframes)));
}

void AnimationFile::row(double t, std::span<const double> values) {
  if (count_++ % stride_ != 0) return;
  t_.push_back(t);
  std::vector<double>& row = rows_.emplace_back();
  for (const std::size_t i : index_) row.push_back(values[i]);
}

std::uint64_t AnimationFile::write(const pipeline::Simulation& simulation, const std::string& title) const {
  mechanics::Mechanics& m = simulation.derived->mechanics;
  const analysis::Animation motion =
      analysis::animation(drawing_->parts(), analysis::primitives(*drawing_, *m.dag, simulation.scene, rows_), t_,
                          rows_, analysis::gravity_direction(m, simulation.scene.parameters));
  if (motion.nodes.empty())
    throw Error("run", {}, "no part has a finite position at every keyframe, so that there is nothing to animate",
                "end the run before the motion diverges: --t-end", ErrorKind::numerical);
  if (!motion.left_out.empty())
    print_message(fmt::format("note: not in the animation, without a finite position at every keyframe: {}\n",
                              fmt::join(motion.left_out, ", ")));
  return write_text(path_, encode_glb(motion, title));
}

}  // namespace eomgen::cli
