// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/place_decomposition.hpp"

namespace eomgen::mechanics {
namespace {

class PositionReader {
 public:
  PositionReader(const Mechanics& m, Lowering& lower) : m_(m), dag_(*m.dag), lower_(lower) {}

  /// Adds factor times the vector `id` to the result. False if its form is not supported.
  bool read(model::NodeId id, Ref factor) {
    using model::Op;
    const model::Node& node = m_.model->arena[id];
    switch (node.op) {
      case Op::zero_vector: return true;
      case Op::add: return read(node.args[0], factor) && read(node.args[1], factor);
      case Op::subtract: return read(node.args[0], factor) && read(node.args[1], dag_.neg(factor));
      case Op::negate: return read(node.args[0], dag_.neg(factor));
      case Op::multiply: {
        const std::size_t vector = m_.model->arena[node.args[0]].vector ? 0 : 1;
        return read(node.args[vector], dag_.mul(factor, lower_.scalar(node.args[1 - vector])));
      }
      case Op::divide: return read(node.args[0], dag_.div(factor, lower_.scalar(node.args[1])));
      case Op::definition: return read(m_.model->definitions[node.index].expression, factor);
      case Op::fixed_basis: add(0, node.index, factor); return true;
      case Op::array:
        for (std::size_t k = 0; k < 3; ++k) add(0, k, dag_.mul(factor, lower_.scalar(node.args[k])));
        return true;
      case Op::axis:
        if (node.order / 3u + 1 != m_.model->frames[node.index].stages.size()) return false;
        add(node.index, node.order % 3u, factor);
        return true;
      case Op::place: return read_place(node.index, factor);
      default: return false;
    }
  }
  const PlaceDecomposition& result() const { return result_; }

 private:
  bool read_place(std::uint32_t place, Ref factor) {
    if (place == 0) return true;
    if (dag_.is_one(factor) && !result_.from) {
      result_.from = place;
      return true;
    }
    return read(m_.model->places[place].position, factor);
  }
  void add(std::uint32_t frame, std::size_t k, Ref component) {
    const auto [entry, fresh] = result_.components.try_emplace(frame, symbolic::zero_vector(dag_));
    entry->second[k] = dag_.add(entry->second[k], component);
  }

  const Mechanics& m_;
  Dag& dag_;
  Lowering& lower_;
  PlaceDecomposition result_;
};

}  // namespace

std::optional<PlaceDecomposition> decompose_place(const Mechanics& m, Lowering& lower, std::uint32_t place) {
  PositionReader reading(m, lower);
  if (!reading.read(m.model->places[place].position, m.dag->one())) return std::nullopt;
  return reading.result();
}

}  // namespace eomgen::mechanics
