// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/frames.hpp"

#include <algorithm>

#include "derive/imposition.hpp"
#include "mechanics/place_decomposition.hpp"

namespace eomgen::derive {
namespace {

using mechanics::decompose_place;
using mechanics::PlaceDecomposition;

/// A vector with its first and second time derivatives. With the coordinates they contain qdot and qddot.
struct Motion {
  Vec3 value, rate, second;
};

/// The angular velocity and acceleration of axes.
struct Spin {
  Vec3 w, alpha;
};

class FrameReader {
 public:
  explicit FrameReader(Mechanics& m)
      : m_(m),
        model_(*m.model),
        dag_(*m.dag),
        lower_(m),
        ddt_(symbolic::total_time_derivative(dag_, m.q.size(), model_.functions.size())) {
    const Vec3 none = symbolic::zero_vector(dag_);
    spins_.push_back({{none, none}});
    for (std::uint32_t f = 1; f < model_.frames.size(); ++f) read_spins(f);
    places_.push_back({none, none, none});
    decompositions_.emplace_back(PlaceDecomposition{});
    for (std::uint32_t p = 1; p < model_.places.size(); ++p) {
      decompositions_.push_back(decompose_place(m_, lower_, p));
      places_.push_back(motion_of_place(p));
    }
  }

  const Motion& place(std::uint32_t index) const { return places_[index]; }
  const Spin& spin(std::uint32_t frame) const { return spins_[frame].back(); }
  std::array<Vec3, 3> axes(std::uint32_t frame) {
    const std::size_t last = frame > 0 ? model_.frames[frame].stages.size() - 1 : 0;
    return {lower_.axis(frame, last, 0), lower_.axis(frame, last, 1), lower_.axis(frame, last, 2)};
  }

  /// The frame with which a place rotates; 0: the fixed axes.
  std::uint32_t axes_of(std::uint32_t place) const {
    const auto is_here = [place](const auto& element) { return element.place == place; };
    const auto body = std::find_if(model_.bodies.begin(), model_.bodies.end(), is_here);
    if (body != model_.bodies.end()) return body->frame;
    if (std::any_of(model_.particles.begin(), model_.particles.end(), is_here)) return 0;
    const std::optional<PlaceDecomposition>& position = decompositions_[place];
    if (!position) return 0;
    // The last body whose axes the position names, or that of the place from which it is measured.
    for (auto named = position->components.rbegin(); named != position->components.rend(); ++named) {
      for (const model::Body& one : model_.bodies)
        if (named->first > 0 && one.frame == named->first && is_fixed_in(one, place)) return one.frame;
    }
    return position->components.empty() && position->from ? axes_of(*position->from) : 0;
  }

 private:
  Vec3 add(const Vec3& a, const Vec3& b) { return symbolic::add(dag_, a, b); }
  Vec3 scale(Ref factor, const Vec3& a) { return symbolic::scale(dag_, factor, a); }
  Vec3 cross(const Vec3& a, const Vec3& b) { return symbolic::cross(dag_, a, b); }
  Vec3 rate(const Vec3& a) { return {ddt_(a[0]), ddt_(a[1]), ddt_(a[2])}; }

  // w = w_before + sum_k w_k e_k, and its derivative: the sum of w_k (w x e_k) is w_before x sum_k w_k e_k.
  void read_spins(std::uint32_t f) {
    const model::Frame& frame = model_.frames[f];
    std::vector<Spin> spins;
    for (std::size_t stage = 0; stage < frame.stages.size(); ++stage) {
      const Spin before = stage > 0 ? spins.back() : spin(frame.parent);
      Vec3 own = symbolic::zero_vector(dag_), own_rate = own;
      for (std::size_t k = 0; k < 3; ++k) {
        const Ref w = lower_.scalar(frame.stages[stage].w[k]);
        const Vec3 e = lower_.axis(f, stage, k);
        own = add(own, scale(w, e));
        own_rate = add(own_rate, scale(ddt_(w), e));
      }
      spins.push_back({add(before.w, own), add(before.alpha, add(own_rate, cross(before.w, own)))});
    }
    if (spins.empty()) spins.push_back(spin(frame.parent));
    spins_.push_back(std::move(spins));
  }

  Motion turned(const Vec3& vector, const Spin& spin) {
    const Vec3 rate = cross(spin.w, vector);
    return {vector, rate, add(cross(spin.alpha, vector), cross(spin.w, rate))};
  }

  // An axis of a frame. About its own axes it turns into these: e_1 x e_2 = e_3.
  Motion axis(std::uint32_t f, std::size_t k) {
    const std::array<Vec3, 3> e = axes(f);
    if (f == 0) return {e[k], symbolic::zero_vector(dag_), symbolic::zero_vector(dag_)};
    const model::Frame& frame = model_.frames[f];
    const std::size_t last = frame.stages.size() - 1;
    const Spin& before = last > 0 ? spins_[f][last - 1] : spin(frame.parent);
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    Vec3 rate = cross(before.w, e[k]);
    rate = add(rate, scale(lower_.scalar(frame.stages[last].w[j]), e[i]));
    rate = add(rate, scale(dag_.neg(lower_.scalar(frame.stages[last].w[i])), e[j]));
    return {e[k], rate, add(cross(spin(f).alpha, e[k]), cross(spin(f).w, rate))};
  }

  Motion times(Ref factor, const Motion& a) {
    const Ref once = ddt_(factor), twice = ddt_(once);
    return {scale(factor, a.value), add(scale(factor, a.rate), scale(once, a.value)),
            add(add(scale(factor, a.second), scale(dag_.mul(dag_.integer(2), once), a.rate)), scale(twice, a.value))};
  }
  Motion sum(const Motion& a, const Motion& b) {
    return {add(a.value, b.value), add(a.rate, b.rate), add(a.second, b.second)};
  }

  bool is_constant(Ref r) const {
    const std::vector<Symbol> symbols = dag_.symbols({r});
    return std::all_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind == SymbolKind::parameter; });
  }

  /// Components along the axes of a frame: a vector fixed in the frame turns as a whole, if it has several of them.
  Motion along(std::uint32_t frame, const Vec3& components) {
    const auto given = std::count_if(components.begin(), components.end(), [&](Ref c) { return !dag_.is_zero(c); });
    Vec3 fixed = symbolic::zero_vector(dag_);
    Motion result{fixed, fixed, fixed};
    const std::array<Vec3, 3> e = axes(frame);
    for (std::size_t k = 0; k < 3; ++k) {
      if (given > 1 && is_constant(components[k]))
        fixed = add(fixed, scale(components[k], e[k]));
      else
        result = sum(result, times(components[k], axis(frame, k)));
    }
    return given > 1 ? sum(turned(fixed, spin(frame)), result) : result;
  }

  Motion motion_of_place(std::uint32_t p) {
    if (const std::optional<PlaceDecomposition>& position = decompositions_[p]) {
      Motion result = places_[position->from.value_or(0)];
      for (const auto& [frame, components] : position->components) result = sum(result, along(frame, components));
      result.value = *m_.place_position[p];
      return result;
    }
    const Vec3 r = *m_.place_position[p], v = rate(r);
    return {r, v, rate(v)};
  }

  /// The components of a place from the origin, by frame; false if a place on the way has no such form.
  bool add_components(std::uint32_t place, bool negative, std::map<std::uint32_t, Vec3>& sums) const {
    for (std::optional<std::uint32_t> p = place; p; p = decompositions_[*p]->from) {
      if (!decompositions_[*p]) return false;
      for (const auto& [frame, components] : decompositions_[*p]->components) {
        Vec3& sum = sums.try_emplace(frame, symbolic::zero_vector(dag_)).first->second;
        for (std::size_t k = 0; k < 3; ++k)
          sum[k] = negative ? dag_.sub(sum[k], components[k]) : dag_.add(sum[k], components[k]);
      }
    }
    return true;
  }

  /// Whether a place stands still as seen from a body.
  bool is_fixed_in(const model::Body& body, std::uint32_t place) const {
    std::map<std::uint32_t, Vec3> offset;
    if (!add_components(place, false, offset) || !add_components(body.place, true, offset)) return false;
    return std::all_of(offset.begin(), offset.end(), [&](const auto& part) {
      return symbolic::is_zero(dag_, part.second) ||
             (part.first == body.frame && std::all_of(part.second.begin(), part.second.end(),
                                                      [&](Ref component) { return is_constant(component); }));
    });
  }

  Mechanics& m_;
  const model::Model& model_;
  Dag& dag_;
  mechanics::Lowering lower_;
  symbolic::Derivation ddt_;
  std::vector<std::vector<Spin>> spins_;  // [frame][stage]
  std::vector<std::optional<PlaceDecomposition>> decompositions_;
  std::vector<Motion> places_;
};

}  // namespace

std::vector<system::Frame> frames(Mechanics& m) {
  FrameReader reader(m);
  symbolic::Substitution imposed = constraint_substitution(m), written = time_function_substitution(m);
  std::map<Symbol, Ref> none;
  for (const std::uint32_t i : m.free) none[{SymbolKind::coordinate, i, 2}] = m.dag->zero();
  symbolic::Substitution at_rest(*m.dag, std::move(none));
  const auto finish = [&](Ref r) { return written(imposed(at_rest(r))); };
  std::vector<system::Frame> result;
  for (std::uint32_t p = 1; p < m.model->places.size(); ++p) {
    system::Frame frame{reader.axes_of(p), {}, {}, {}, {}};
    const Motion& motion = reader.place(p);
    const Spin& spin = reader.spin(frame.axes);
    const std::array<Vec3, 3> e = reader.axes(frame.axes);
    for (std::size_t k = 0; k < 3; ++k) {
      frame.position[k] = finish(motion.value[k]);
      for (std::size_t c = 0; c < 3; ++c) frame.rotation[3 * k + c] = finish(e[k][c]);
      frame.velocity[k] = finish(motion.rate[k]);
      frame.velocity[3 + k] = finish(spin.w[k]);
      frame.bias[k] = finish(motion.second[k]);
      frame.bias[3 + k] = finish(spin.alpha[k]);
    }
    result.push_back(frame);
  }
  return result;
}

std::vector<std::string> frame_names(const model::Model& model) {
  std::vector<std::string> names;
  for (std::uint32_t p = 1; p < model.places.size(); ++p) names.push_back(model.places[p].name);
  return names;
}

}  // namespace eomgen::derive
