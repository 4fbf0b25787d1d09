// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/carried_inertias.hpp"

#include <algorithm>
#include <map>

#include "mechanics/imposition.hpp"
#include "mechanics/place_decomposition.hpp"
#include "reading/ginac_bridge.hpp"

namespace eomgen::reading {
namespace {

using mechanics::Mechanics;
using symbolic::Vec3;

/// Indices of the symbols of the carrier's motion, which are vectors along its axes, and of its height.
enum CarrierSymbol : std::uint32_t { velocity = 0, spin = 3, weight = 6, height = 9 };

class CarriedInertiaReader {
 public:
  explicit CarriedInertiaReader(Mechanics& m)
      : m_(m),
        model_(*m.model),
        dag_(*m.dag),
        lower_(m),
        bridge_(m),
        ddt_(symbolic::total_time_derivative(dag_, m.q.size(), model_.functions.size())),
        imposed_(mechanics::constraint_substitution(m)) {}

  std::optional<CarriedInertia> operator()(std::uint32_t place, std::optional<std::uint32_t> body) {
    std::map<std::uint32_t, Vec3> arm;  // by frame
    if (!add_components(place, false, arm)) return std::nullopt;
    const std::uint32_t own = body ? model_.bodies[*body].frame : innermost(arm);
    CarriedInertia result{carrier_of(body ? model_.frames[own].parent : own), {}};
    const std::uint32_t axes = result.carrier ? model_.bodies[*result.carrier].frame : 0;
    if (result.carrier && !add_components(model_.bodies[*result.carrier].place, true, arm)) return std::nullopt;
    read_carrier(result.carrier.has_value());
    Vec3 r = symbolic::zero_vector(dag_);
    for (const auto& [frame, components] : arm) {
      if (symbolic::is_zero(dag_, components)) continue;
      if (!is_below(frame, axes)) return std::nullopt;
      r = symbolic::add(dag_, r, outwards(frame, axes, components));
    }
    const Vec3 v = symbolic::add(dag_, symbolic::add(dag_, V_, symbolic::cross(dag_, W_, r)),
                                 {ddt_(r[0]), ddt_(r[1]), ddt_(r[2])});
    std::vector<std::vector<Sum>> columns;
    const auto add = [&](Ref lagrangian) { columns.push_back({bridge_.sum(imposed_(lagrangian))}); };
    if (result.carrier) add_body(V_, W_, G_, height_, half_square(V_), add);
    const Ref mass = dag_.add(half_square(v), dag_.add(height_, symbolic::dot(dag_, G_, r)));
    if (!body) {
      add(mass);
    } else {
      add_body(inwards(axes, own, v), spin_of(axes, own), inwards(axes, own, G_), mass, dag_.zero(), add);
    }
    result.relations = relate_columns(columns, true);
    return result;
  }

 private:
  Ref half_square(const Vec3& v) { return dag_.div(symbolic::dot(dag_, v, v), dag_.integer(2)); }

  /// Lagrangians of the ten parameters; that of the mass is `potential` + `kinetic`.
  template <class Add>
  void add_body(const Vec3& v, const Vec3& w, const Vec3& g, Ref potential, Ref kinetic, const Add& add) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = i; k < 3; ++k) {
        const Ref product = dag_.mul(w[i], w[k]);
        add(i == k ? dag_.div(product, dag_.integer(2)) : product);
      }
    }
    const Vec3 turned = symbolic::cross(dag_, v, w);
    for (std::size_t i = 0; i < 3; ++i) add(dag_.add(turned[i], g[i]));
    add(dag_.add(potential, kinetic));
  }

  /// The motion of the carrier: symbols; at rest for the ground.
  void read_carrier(bool moves) {
    V_ = W_ = G_ = symbolic::zero_vector(dag_);
    height_ = dag_.zero();
    Vec3 g = symbolic::zero_vector(dag_);
    for (const model::Force& force : model_.forces)
      if (force.acceleration() != model::no_node) g = symbolic::add(dag_, g, lower_.vector(force.acceleration()));
    if (!moves) {
      G_ = g;
      return;
    }
    const auto symbol = [&](std::uint32_t index) { return dag_.symbol({SymbolKind::vector, index, 0}); };
    for (std::uint32_t k = 0; k < 3; ++k) {
      V_[k] = symbol(velocity + k);
      W_[k] = symbol(spin + k);
      if (!symbolic::is_zero(dag_, g)) G_[k] = symbol(weight + k);
    }
    if (!symbolic::is_zero(dag_, g)) height_ = symbol(height);
  }

  /// The components of a place from the origin, by frame.
  bool add_components(std::uint32_t place, bool negative, std::map<std::uint32_t, Vec3>& sums) {
    for (std::optional<std::uint32_t> p = place; p && *p != 0;) {
      const std::optional<mechanics::PlaceDecomposition> position = mechanics::decompose_place(m_, lower_, *p);
      if (!position) return false;
      for (const auto& [frame, components] : position->components) {
        Vec3& sum = sums.try_emplace(frame, symbolic::zero_vector(dag_)).first->second;
        sum = negative ? symbolic::subtract(dag_, sum, components) : symbolic::add(dag_, sum, components);
      }
      p = position->from;
    }
    return true;
  }

  std::size_t depth(std::uint32_t frame) const {
    std::size_t result = 0;
    for (; frame != 0; frame = model_.frames[frame].parent) ++result;
    return result;
  }
  std::uint32_t innermost(const std::map<std::uint32_t, Vec3>& arm) const {
    std::uint32_t result = 0;
    for (const auto& [frame, components] : arm)
      if (!symbolic::is_zero(dag_, components) && depth(frame) > depth(result)) result = frame;
    return result;
  }
  /// The body with these axes or the next ones outside of them.
  std::optional<std::uint32_t> carrier_of(std::uint32_t frame) const {
    for (; frame != 0; frame = model_.frames[frame].parent) {
      for (std::uint32_t b = 0; b < model_.bodies.size(); ++b)
        if (model_.bodies[b].frame == frame) return b;
    }
    return std::nullopt;
  }
  bool is_below(std::uint32_t frame, std::uint32_t axes) const {
    while (frame != axes && frame != 0) frame = model_.frames[frame].parent;
    return frame == axes;
  }

  /// From the axes of a frame to those of the frame `to` around it.
  Vec3 outwards(std::uint32_t frame, std::uint32_t to, Vec3 v) {
    for (; frame != to; frame = model_.frames[frame].parent) {
      const std::vector<model::RotationStage>& stages = model_.frames[frame].stages;
      for (auto stage = stages.rbegin(); stage != stages.rend(); ++stage) {
        Vec3 sum = symbolic::zero_vector(dag_);
        for (std::size_t k = 0; k < 3; ++k) sum = symbolic::add(dag_, sum, symbolic::scale(dag_, v[k], row(*stage, k)));
        v = sum;
      }
    }
    return v;
  }
  std::vector<std::uint32_t> chain(std::uint32_t from, std::uint32_t frame) const {
    std::vector<std::uint32_t> frames;
    for (; frame != from; frame = model_.frames[frame].parent) frames.push_back(frame);
    std::reverse(frames.begin(), frames.end());
    return frames;
  }
  Vec3 inwards(std::uint32_t from, std::uint32_t frame, Vec3 v) {
    for (const std::uint32_t f : chain(from, frame))
      for (const model::RotationStage& stage : model_.frames[f].stages) v = turned(stage, v);
    return v;
  }
  /// The angular velocity along the axes of `frame`.
  Vec3 spin_of(std::uint32_t from, std::uint32_t frame) {
    Vec3 w = W_;
    for (const std::uint32_t f : chain(from, frame)) {
      for (const model::RotationStage& stage : model_.frames[f].stages) {
        w = turned(stage, w);
        for (std::size_t k = 0; k < 3; ++k) w[k] = dag_.add(w[k], lower_.scalar(stage.w[k]));
      }
    }
    return w;
  }
  Vec3 row(const model::RotationStage& stage, std::size_t k) {
    return {lower_.scalar(stage.R[k][0]), lower_.scalar(stage.R[k][1]), lower_.scalar(stage.R[k][2])};
  }
  Vec3 turned(const model::RotationStage& stage, const Vec3& v) {
    return {symbolic::dot(dag_, row(stage, 0), v), symbolic::dot(dag_, row(stage, 1), v),
            symbolic::dot(dag_, row(stage, 2), v)};
  }

  Mechanics& m_;
  const model::Model& model_;
  symbolic::Dag& dag_;
  mechanics::Lowering lower_;
  GinacBridge bridge_;
  symbolic::Derivation ddt_;
  symbolic::Substitution imposed_;
  Vec3 V_, W_, G_;
  Ref height_;
};

}  // namespace

std::optional<CarriedInertia> carried_inertia(Mechanics& m, std::uint32_t place, std::optional<std::uint32_t> body) {
  return CarriedInertiaReader(m)(place, body);
}

}  // namespace eomgen::reading
