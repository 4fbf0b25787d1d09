// SPDX-License-Identifier: GPL-3.0-or-later
// [draw]: shapes of particles and bodies in a report. It does not affect the equations.
#include "model/read_draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "model/samples.hpp"

namespace eomgen::model {
namespace {

constexpr const char* drawing_form =
    "write { sphere = \"R\" }, { box = [\"a\", \"b\", \"c\"] }, { cylinder = [\"R\", \"L\"] }, { disk = \"R\" }, { rod "
    "= \"L\" }, { arrow = [\"x\", \"y\", \"z\"] } or { mesh = [[\"x\", \"y\", \"z\"], ..] }";
constexpr const char* points_form =
    "give its points as [[\"x\", \"y\", \"z\"], ..], from 4 to 60 of them, or to 200 with faces";
constexpr const char* faces_form =
    "give each face as the numbers of its points in their order, [1, 2, 3], counted from 1";
constexpr std::size_t fewest_points = 4, most_points = 60, most_points_with_faces = 200, most_faces = 400;

struct DrawnShape {
  std::string_view key;
  std::size_t lengths;
};
constexpr std::array<DrawnShape, 6> drawn_shapes{
    {{"sphere", 1}, {"box", 3}, {"cylinder", 2}, {"disk", 1}, {"rod", 1}, {"arrow", 3}}};

constexpr double same_point = 1e-9;  // of the largest distance between two points of a mesh

using Point = std::array<double, 3>;
Point between(const Point& a, const Point& b) { return {b[0] - a[0], b[1] - a[1], b[2] - a[2]}; }
double length(const Point& a) { return std::hypot(a[0], a[1], a[2]); }

/// Whether no three of the points span an area that counts in a mesh of this size.
bool lie_on_a_line(const std::vector<Point>& points, double size) {
  const auto farther = [&](const Point& a, const Point& b) {
    return length(between(points[0], a)) < length(between(points[0], b));
  };
  const Point along = between(points[0], *std::max_element(points.begin(), points.end(), farther));
  return std::all_of(points.begin(), points.end(), [&](const Point& p) {
    const Point r = between(points[0], p);
    const Point area{along[1] * r[2] - along[2] * r[1], along[2] * r[0] - along[0] * r[2],
                     along[0] * r[1] - along[1] * r[0]};
    return length(area) <= same_point * size * length(along);
  });
}

}  // namespace

void DrawReader::read() {
  if (const Value* table = section("draw")) read_table(*table);
  for (const ShapeSpec& shape : context_.contact_shapes) {
    const auto is_of_place = [&](const ShapeSpec& drawn) { return drawn.place == shape.place; };
    if (std::none_of(model_.drawn.begin(), model_.drawn.end(), is_of_place)) model_.drawn.push_back(shape);
  }
}

void DrawReader::read_table(const Value& table) {
  for (const Entry& entry : table.entries) {
    const auto place = std::find_if(model_.places.begin() + 1, model_.places.end(),
                                    [&](const Place& p) { return p.name == entry.key; });
    const auto index = static_cast<std::uint32_t>(place - model_.places.begin());
    const auto here = [index](const auto& heavy) { return heavy.place == index; };
    const bool massive = std::any_of(model_.particles.begin(), model_.particles.end(), here) ||
                         std::any_of(model_.bodies.begin(), model_.bodies.end(), here);
    if (place == model_.places.end() || !massive) {
      std::vector<std::string> known;
      for (const Particle& p : model_.particles) known.push_back(model_.places[p.place].name);
      for (const Body& b : model_.bodies) known.push_back(model_.places[b.place].name);
      const std::string hint = did_you_mean(entry.key, known);
      source_.fail(entry.span, fmt::format("[draw] names {}, which is no particle or body", quote(entry.key)),
                   !hint.empty()   ? hint
                   : known.empty() ? "leave it out: this model has neither"
                                   : fmt::format("particles and bodies are {}", fmt::join(known, ", ")));
    }
    if (entry.value.is(Value::Kind::array)) {
      for (const Value& shape : entry.value.items) model_.drawn.push_back(drawn_shape(index, shape));
    } else {
      model_.drawn.push_back(drawn_shape(index, entry.value));
    }
  }
}

ShapeSpec DrawReader::drawn_shape(std::uint32_t place, const Value& value) {
  const std::string what = fmt::format("the drawing of '{}'", model_.places[place].name);
  require_kind(Value::Kind::table, value, what, drawing_form);
  Keys keys{what, {}};
  for (const DrawnShape& shape : drawn_shapes) keys.known.push_back(shape.key);
  for (const char* key : {"mesh", "faces", "axis", "at"}) keys.known.emplace_back(key);
  check_keys(value, keys);
  ShapeSpec drawn;
  drawn.place = place;
  drawn.span = value.span;
  for (const DrawnShape& shape : drawn_shapes) {
    const Value* lengths = value.find(shape.key);
    if (lengths == nullptr) continue;
    if (!drawn.kind.empty())
      source_.fail(lengths->span, fmt::format("{} is both '{}' and '{}'", what, drawn.kind, shape.key),
                   "draw one of them, or give an array of tables");
    drawn.kind = shape.key;
    drawn.lengths = drawn_lengths(*lengths, shape.lengths, what, shape.key != "arrow");
  }
  const Value *mesh = value.find("mesh"), *faces = value.find("faces");
  if (mesh != nullptr && !drawn.kind.empty())
    source_.fail(mesh->span, fmt::format("{} is both '{}' and 'mesh'", what, drawn.kind),
                 "draw one of them, or give an array of tables");
  if (faces != nullptr && mesh == nullptr)
    source_.fail(faces->span, fmt::format("{} has faces, and no points for them", what), drawing_form);
  if (mesh != nullptr) read_mesh(drawn, *mesh, faces, what);
  if (drawn.kind.empty()) source_.fail(value.span, fmt::format("{} has no shape", what), drawing_form);
  if (const Value* axis = value.find("axis")) {
    const char* remedy = "write axis = \"e1\", \"e2\" or \"e3\": its own axis that a cylinder, disk or rod is about";
    const std::string& text = require_kind(Value::Kind::text, *axis, fmt::format("the axis in {}", what), remedy).text;
    if (text != "e1" && text != "e2" && text != "e3")
      source_.fail(axis->span, fmt::format("there is no own axis {}", quote(text)), remedy);
    drawn.axis = static_cast<std::uint32_t>(text[1] - '1');
  }
  if (const Value* at = value.find("at")) drawn.at = drawn_lengths(*at, 3, what, false);
  return drawn;
}

void DrawReader::read_mesh(ShapeSpec& drawn, const Value& points, const Value* faces, const std::string& what) {
  drawn.kind = "mesh";
  require_kind(Value::Kind::array, points, fmt::format("the mesh in {}", what), points_form);
  const std::size_t count = points.items.size();
  if (count < fewest_points || count > (faces == nullptr ? most_points : most_points_with_faces))
    source_.fail(points.span, fmt::format("{} has {} points", what, count), points_form);
  for (const Value& point : points.items) {
    const std::vector<NodeId> lengths = drawn_lengths(point, 3, what, false);
    drawn.lengths.insert(drawn.lengths.end(), lengths.begin(), lengths.end());
  }
  if (faces == nullptr) {
    require_extent(drawn, points, nullptr, what);
    return;
  }
  require_kind(Value::Kind::array, *faces, fmt::format("the faces in {}", what), faces_form);
  if (faces->items.empty() || faces->items.size() > most_faces)
    source_.fail(faces->span, fmt::format("{} has {} faces", what, faces->items.size()),
                 fmt::format("give 1 to {} of them, or none: then it is convex", most_faces));
  for (const Value& face : faces->items) {
    require_kind(Value::Kind::array, face, fmt::format("a face in {}", what), faces_form);
    if (face.items.size() < 3)
      source_.fail(face.span, fmt::format("a face in {} has {} points", what, face.items.size()), faces_form);
    drawn.faces.emplace_back();
    for (const Value& number : face.items) {
      require_kind(Value::Kind::integer, number, fmt::format("a point of a face in {}", what), faces_form);
      const long point = number.text.size() > 3 ? 0 : std::stol(number.text);
      if (point < 1 || point > static_cast<long>(count))
        source_.fail(number.span, fmt::format("{} has no point {}", what, number.text),
                     fmt::format("its points are 1 to {}", count));
      std::vector<std::uint32_t>& corners = drawn.faces.back();
      corners.push_back(static_cast<std::uint32_t>(point - 1));
      if (std::count(corners.begin(), corners.end(), corners.back()) > 1)
        source_.fail(number.span, fmt::format("a face in {} has point {} twice", what, point), faces_form);
    }
  }
  require_extent(drawn, points, faces, what);
}

/// Rejects equal points, and meshes or faces whose points lie on a line, with the default parameters.
void DrawReader::require_extent(const ShapeSpec& drawn, const Value& points, const Value* faces,
                                const std::string& what) {
  if (std::any_of(drawn.lengths.begin(), drawn.lengths.end(), [&](NodeId node) { return depends_on_start(node); }))
    return;
  Samples samples(model_);
  std::vector<Point> at;
  for (std::size_t k = 0; k < drawn.lengths.size(); k += 3)
    at.push_back(
        {samples.value(drawn.lengths[k]), samples.value(drawn.lengths[k + 1]), samples.value(drawn.lengths[k + 2])});
  double size = 0;
  for (const Point& p : at) size = std::max(size, length(between(at[0], p)));
  for (std::size_t j = 1; j < at.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      if (length(between(at[i], at[j])) <= same_point * size)
        source_.fail(points.items[j].span, fmt::format("points {} and {} in {} are equal", i + 1, j + 1, what),
                     "leave one of them out");
    }
  }
  if (faces == nullptr) {
    if (lie_on_a_line(at, size))
      source_.fail(points.span, fmt::format("the points in {} lie on a line", what),
                   "give points of a polygon or of a solid");
    return;
  }
  for (std::size_t k = 0; k < drawn.faces.size(); ++k) {
    std::vector<Point> corners;
    for (const std::uint32_t point : drawn.faces[k]) corners.push_back(at[point]);
    if (lie_on_a_line(corners, size))
      source_.fail(faces->items[k].span, fmt::format("the points of a face in {} lie on a line", what), faces_form);
  }
}

/// Whether an expression contains initial(q), whose value a run assigns.
bool DrawReader::depends_on_start(NodeId root) const {
  std::vector<NodeId> left{root};
  std::set<NodeId> seen;  // parameters that name each other twice have exponentially many paths
  while (!left.empty()) {
    const NodeId id = left.back();
    left.pop_back();
    if (id == no_node || !seen.insert(id).second) continue;
    const Node& node = model_.arena[id];
    if (node.op == Op::parameter) {
      if (model_.parameters[node.index].initial_value_of) return true;
      left.push_back(model_.parameters[node.index].value);
    } else {
      left.insert(left.end(), std::begin(node.args), std::end(node.args));
    }
  }
  return false;
}

std::vector<NodeId> DrawReader::drawn_lengths(const Value& value, std::size_t count, const std::string& what,
                                              bool positive) {
  const Context context{fmt::format("a length in {}", what), 0, Shape::scalar, dimension_of("m"),
                        "what is drawn is made of numbers and parameters"};
  const auto length = [&](const Value& item) {
    const TypedNode typed = resolver_.value(item, context);
    if (positive && typed.constant && !cln::plusp(*typed.constant))
      resolver_.refuse_value(typed, item.span, context.what, "is not greater than 0", "give a length");
    const double number = Samples(model_).value(typed.node);
    if (!std::isfinite(number) && !depends_on_start(typed.node))
      source_.fail(item.span, fmt::format("a length in {} has no value", what),
                   "check the numbers that it is computed from");
    return typed.node;
  };
  if (count == 1) return {length(value)};
  require_kind(Value::Kind::array, value, fmt::format("{}: its lengths", what), drawing_form);
  if (value.items.size() != count)
    source_.fail(value.span, fmt::format("{} has {} lengths here", what, value.items.size()),
                 fmt::format("give {} of them", count));
  std::vector<NodeId> lengths;
  for (const Value& item : value.items) lengths.push_back(length(item));
  return lengths;
}

}  // namespace eomgen::model
