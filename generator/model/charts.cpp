// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/mentions.hpp"
#include "rotations/rotation.hpp"

namespace eomgen::model {
namespace {

/// The coordinates in these entries; empty if an entry is not a coordinate, or if one occurs twice.
std::vector<std::uint32_t> plain(const Model& model, const std::vector<NodeId>& entries) {
  std::vector<std::uint32_t> result;
  for (const NodeId entry : entries) {
    const Node& node = model.arena[entry];
    const bool twice = std::find(result.begin(), result.end(), node.index) != result.end();
    if (node.op != Op::coordinate || node.order != 0 || twice) return {};
    result.push_back(node.index);
  }
  return result;
}

/// The reason if the model has contacts: their modes refer to directions, whose transition is not implemented.
std::string contact_of(const Model& model) {
  for (const Constraint& constraint : model.constraints) {
    if (constraint.friction || constraint.unilateral)
      return fmt::format("constraint '{}' has friction or can be left", constraint.name);
  }
  for (const Force& force : model.forces) {
    if (force.dry) return fmt::format("'{}' is dry friction", force.name);
  }
  return "";
}

void refuse(const Model& model, ChartPair& chart, std::vector<NodeId> entries) {
  chart.angles = plain(model, entries);
  if (chart.angles.empty()) {
    chart.refusal = "an angle is an expression or the same as another: only coordinates can be exchanged";
    return;
  }
  const bool rotation = chart.kind == ChartPair::Kind::rotation;
  const std::string name = find_mention(model, [&](const Node& node, const ModelExpression& root) {
    const bool own = rotation ? root.frame == chart.index : root.place == chart.index;
    if (own) return std::string();
    if (node.op == Op::coordinate &&
        std::find(chart.angles.begin(), chart.angles.end(), node.index) != chart.angles.end())
      return fmt::format("the coordinate '{}'", model.coordinates[node.index].name);
    if (rotation && node.op == Op::axis && node.index == chart.index &&
        node.order / 3u + 1 < model.frames[chart.index].stages.size())
      return fmt::format("'{}.e{}{}', an intermediate axis of the rotation,", chart.of, node.order % 3 + 1,
                         node.order / 3 == 0 ? "'" : "''");
    return std::string();
  });
  chart.refusal = name.empty() ? contact_of(model) : name;
}

/// The node with x1, x2, x3 of a place: its position relative to the origin of the chart; no_node if it is along
/// rotating axes.
NodeId components_of(const Model& model, const Place& place) {
  NodeId id = place.position;
  if (place.from > 0 && model.arena[id].op == Op::add) id = model.arena[id].args[1];
  return model.arena[id].op == Op::array ? id : no_node;
}

class Builder {
 public:
  explicit Builder(Model& model) : nodes_(model.arena.nodes) {}

  NodeId make(Op op, bool vector, std::initializer_list<NodeId> arguments, Span span) {
    Node node;
    node.op = op;
    node.vector = vector;
    node.span = span;
    std::copy(arguments.begin(), arguments.end(), node.args.begin());
    nodes_.push_back(node);
    return static_cast<NodeId>(nodes_.size() - 1);
  }
  NodeId call(Fn fn, NodeId argument) {
    const NodeId id = make(Op::call, false, {argument}, nodes_[argument].span);
    nodes_[id].fn = fn;
    return id;
  }
  NodeId axis(std::uint32_t frame, std::size_t stage, std::size_t k, Span span) {
    const NodeId id = make(Op::axis, true, {}, span);
    nodes_[id].index = frame;
    nodes_[id].order = static_cast<std::uint8_t>(3 * stage + k);
    return id;
  }

 private:
  std::vector<Node>& nodes_;
};

/// Replaces the axis of the last step: the same entries in other rows.
void turn(Model& model, const ChartPair& chart) {
  Builder build(model);
  Frame& frame = model.frames[chart.index];
  const RotationStage own = frame.stages[2];
  RotationStage& stage = frame.stages[2];
  const std::size_t by = (3 + chart.second_axis - chart.axes[2]) % 3;
  for (std::size_t a = 0; a < 3; ++a) {
    stage.w[(a + by) % 3] = own.w[a];
    for (std::size_t b = 0; b < 3; ++b) stage.R[(a + by) % 3][(b + by) % 3] = own.R[a][b];
  }
  for (std::size_t a = 0; a < 3; ++a) {
    NodeId sum = no_node;
    for (std::size_t b = 0; b < 3; ++b) {
      if (stage.R[a][b] == no_node) continue;
      const NodeId axis = build.axis(chart.index, 1, b, frame.span);
      const NodeId term = build.make(Op::multiply, true, {stage.R[a][b], axis}, frame.span);
      sum = sum == no_node ? term : build.make(Op::add, true, {sum, term}, frame.span);
    }
    stage.e[a] = sum;
  }
  frame.rotation = chart.second;
  frame.singularity = build.call(chart.at_sine ? Fn::cos : Fn::sin, frame.entries[1]);
}

/// Moves the pole to E1: x2 = R sin(phi) cos(theta), x3 = R sin(phi) sin(theta), x1 = R cos(phi), a cyclic permutation
/// of the components.
void move_pole(Model& model, const ChartPair& chart) {
  Builder build(model);
  Place& place = model.places[chart.index];
  const auto shifted = [&](NodeId id) {
    if (id == no_node) return id;
    const Node old = model.arena[id];
    return build.make(Op::array, true, {old.args[2], old.args[0], old.args[1]}, old.span);
  };
  const NodeId position = shifted(components_of(model, place));
  const Node whole = model.arena[place.position];
  place.position = place.from > 0 ? build.make(Op::add, true, {whole.args[0], position}, whole.span) : position;
  for (NodeId& e : place.chart->unit_basis) e = shifted(e);
}

}  // namespace

std::string ChartPair::singularity(const Model& model) const {
  return fmt::format("{}({})", at_sine ? "sin" : "cos", model.coordinates[angles.at(guarded)].name);
}

std::vector<ChartPair> charts(const Model& model) {
  std::vector<ChartPair> result;
  for (std::uint32_t k = 1; k < model.frames.size(); ++k) {
    const Frame& frame = model.frames[k];
    const rotations::Rotation* rotation = rotations::find(frame.rotation);
    if (rotation == nullptr || rotation->family != "euler") continue;
    ChartPair chart;
    chart.of = frame.name;
    chart.index = k;
    chart.own = frame.rotation;
    for (std::size_t s = 0; s < 3; ++s) chart.axes[s] = static_cast<std::size_t>(frame.rotation[s] - '1');
    chart.second_axis = 3 - chart.axes[1] - chart.axes[2];
    chart.second = chart.own.substr(0, 2) + static_cast<char>('1' + chart.second_axis);
    chart.guarded = 1;
    chart.at_sine = chart.axes[0] == chart.axes[2];
    refuse(model, chart, frame.entries);
    result.push_back(std::move(chart));
  }
  for (std::uint32_t k = 1; k < model.places.size(); ++k) {
    const Place& place = model.places[k];
    if (!place.chart || place.chart->system != "spherical") continue;
    ChartPair chart;
    chart.kind = ChartPair::Kind::position;
    const bool body =
        std::any_of(model.bodies.begin(), model.bodies.end(), [k](const Body& b) { return b.place == k; });
    chart.of = body ? place.name + ".position" : place.name;
    chart.index = k;
    chart.own = "spherical about E3";
    chart.second = "spherical about E1";
    refuse(model, chart, {place.chart->entries[1], place.chart->entries[2]});
    if (components_of(model, place) == no_node) chart.refusal = "its axes turn";
    result.push_back(std::move(chart));
  }
  return result;
}

SingularChart find_singular_chart(const Model& model,
                                  const std::function<std::optional<double>(std::uint32_t coordinate)>& value_of,
                                  double distance) {
  for (const ChartPair& chart : charts(model)) {
    if (chart.guarded >= chart.angles.size()) continue;
    const std::uint32_t coordinate = chart.angles[chart.guarded];
    const std::optional<double> angle = value_of(coordinate);
    if (!angle || std::abs(chart.at_sine ? std::sin(*angle) : std::cos(*angle)) > distance) continue;
    const bool rotation = chart.kind == ChartPair::Kind::rotation;
    const std::string whose = rotation ? chart.of : chart.of.substr(0, chart.of.find('.'));
    const std::string at = fmt::format("{} = {:.6g}", model.coordinates[coordinate].name, *angle);
    if (!rotation)
      return {fmt::format("the {} coordinates of '{}' are singular at {}", chart.own, whose, at),
              fmt::format("give '{}' a position of another kind, such as cartesian", whose)};
    return {fmt::format("the angles {} of '{}' are singular at {}", chart.own, whose, at),
            fmt::format("give '{}' another rotation, such as euler = \"{}\" or euler_parameters", whose, chart.second)};
  }
  return {};
}

Model in_second_charts(const Model& model, const std::vector<ChartPair>& charts, unsigned mask) {
  Model result = model;
  for (std::size_t j = 0; j < charts.size(); ++j) {
    if ((mask >> j & 1) == 0) continue;
    if (charts[j].kind == ChartPair::Kind::rotation) {
      turn(result, charts[j]);
    } else {
      move_pole(result, charts[j]);
    }
  }
  return result;
}

}  // namespace eomgen::model
