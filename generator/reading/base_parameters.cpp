// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/base_parameters.hpp"

#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>

#include "mechanics/imposition.hpp"
#include "mechanics/mechanics.hpp"
#include "mechanics/place_decomposition.hpp"
#include "reading/atom_table.hpp"
#include "reading/column_relations.hpp"
#include "reading/ginac_bridge.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::reading {

using cln::cl_R;
using mechanics::Mechanics;
using symbolic::Vec3;

namespace {

// Inertial parameters that act like others of the body that carries theirs. In: Mechanics and a particle or body that
// is joined to another body, or to the ground. Out: the columns of its parameters as combinations of those of the
// carrier and of its own, for every motion of the carrier: twist and gravity along its axes are symbols of their own.
//
// The Lagrangian of a body is linear in its parameters (Siciliano et al., Robotics, 2009, section 7.2.2):
//   L = m v.v/2 + v.(w x m c) + w.Iw/2 + m g.r + m c.g.

/// Inertia 11, 12, 13, 22, 23, 33, moments, mass.
constexpr std::size_t body_parameters = 10;

struct CarriedInertia {
  std::optional<std::uint32_t> carrier;  // index into Model::bodies; none: the ground
  /// Columns: those of the carrier, then the own ones (of a particle its mass alone).
  Echelon relations;
};

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

/// Of Model::bodies[body]; without `body` of the particle at `place`. Empty if its position or rotation is no function
/// of coordinates along the axes of bodies and frames.
std::optional<CarriedInertia> carried_inertia(Mechanics& m, std::uint32_t place, std::optional<std::uint32_t> body) {
  return CarriedInertiaReader(m)(place, body);
}

constexpr int rank_digits = 60;
// Random numbers of three digits, some hundred operations: what is not 0 is far above, and what is 0 far below.
constexpr int zero_digits = 25;

/// A number in (0.3, 1.3). Those of parameters are the same in every round.
cl_R random_number(const symbolic::Symbol& s, std::size_t round) {
  std::uint64_t key = 0x9e3779b97f4a7c15u * (static_cast<std::uint64_t>(s.kind) + 1);
  key ^= 0xbf58476d1ce4e5b9u * (s.index + 1u) + 0x94d049bb133111ebu * (s.order + 1u);
  if (s.kind != symbolic::SymbolKind::parameter) key += 0xd6e8feb86659fd93u * (round + 1);
  for (int k = 0; k < 3; ++k) key = (key ^ (key >> 29)) * 0xbf58476d1ce4e5b9u;
  return cln::cl_RA(static_cast<long>(key >> 40 & 0x3ff) + 307) / 1009;
}

class CarriedBase {
 public:
  CarriedBase(Mechanics& m, const std::vector<std::vector<Ref>>& columns, Regressor& found)
      : m_(m), columns_(columns), found_(found), terms_(columns.size()) {}

  void operator()() {
    read_blocks();
    for (std::size_t block = 0; block < blocks_.size(); ++block) relate(block);
    if (!find_rank()) return leave_out("the columns of Y have no values at random states");
    // The columns on which no others depend, that the rank needs not: near the ground, where motions are not general.
    for (const std::size_t column : order_) {
      if (!is_own(column) || pivots_.contains(column)) continue;
      if (!relate_near_ground(column))
        return leave_out(
            fmt::format("{} combinations are independent, but not all of them have short formulas", pivots_.size()));
    }
    if (!is_confirmed()) return leave_out(fmt::format("{} combinations are independent", pivots_.size()));
    write();
  }

 private:
  using Terms = std::map<std::size_t, Sum>;  // column to factor

  /// The parameters of one particle or body.
  struct Block {
    std::uint32_t place = 0;
    std::optional<std::uint32_t> body;
    std::size_t first = 0, count = 0;
  };

  void leave_out(const std::string& reason) { found_.base_left_out = reason; }

  void read_blocks() {
    for (std::size_t j = 0; j < found_.parameters.size(); ++j) {
      const std::uint32_t place = found_.parameters[j].place;
      if (!blocks_.empty() && blocks_.back().place == place) {
        ++blocks_.back().count;
        continue;
      }
      const std::vector<model::Body>& bodies = m_.model->bodies;
      const auto body =
          std::find_if(bodies.begin(), bodies.end(), [place](const model::Body& b) { return b.place == place; });
      blocks_.push_back({place, std::nullopt, j, 1});
      if (body != bodies.end()) blocks_.back().body = static_cast<std::uint32_t>(body - bodies.begin());
    }
  }
  std::size_t block_of(std::uint32_t body) const {
    const auto found = std::find_if(blocks_.begin(), blocks_.end(), [body](const Block& b) { return b.body == body; });
    return static_cast<std::size_t>(found - blocks_.begin());
  }

  /// Fills in the terms of the block's columns after those of its carrier.
  void relate(std::size_t index) {
    const Block& block = blocks_[index];
    if (!terms_[block.first].empty() || is_done_[index]) return;
    is_done_[index] = true;
    const std::optional<CarriedInertia> carried = carried_inertia(m_, block.place, block.body);
    std::vector<std::size_t> all;  // columns of the relations
    if (carried && carried->carrier) {
      const std::size_t carrier = block_of(*carried->carrier);
      relate(carrier);
      for (std::size_t k = 0; k < blocks_[carrier].count; ++k) all.push_back(blocks_[carrier].first + k);
    }
    for (std::size_t k = 0; k < block.count; ++k) {
      const std::size_t column = block.first + k, local = all.size();
      all.push_back(column);
      order_.push_back(column);
      if (!carried || carried->relations.contains(local)) {
        terms_[column][column] = Sum(1);
        continue;
      }
      for (const auto& [pivot, entries] : carried->relations)
        if (const auto factor = entries.find(local); factor != entries.end())
          add(terms_[column], factor->second, terms_[all[pivot]]);
    }
  }

  static void add(Terms& to, const Sum& factor, const Terms& terms) {
    for (const auto& [column, value] : terms) {
      Sum& sum = to[column];
      sum = cancel(simplify(sum + factor * value));
      if (sum.is_zero()) to.erase(column);
    }
  }

  bool is_own(std::size_t column) const { return terms_[column].contains(column); }

  /// The reduced row echelon form of Y at random states, with columns in the order of elimination.
  bool find_rank() {
    const std::size_t n = m_.free.size(), count = columns_.size();
    std::vector<Ref> roots;
    for (std::size_t i = 0; i < n; ++i)
      for (const std::vector<Ref>& column : columns_) roots.push_back(column[i]);
    std::vector<std::vector<cl_R>> rows;
    const std::size_t rounds = count / n + 6;
    for (std::size_t round = 0; round < 2 * rounds && rows.size() < rounds * n; ++round) {
      work::throw_if_stopped();
      try {
        const std::vector<cl_R> values = symbolic::evaluate(
            *m_.dag, roots, [round](const symbolic::Symbol& s) { return random_number(s, round); }, rank_digits);
        for (std::size_t i = 0; i < n; ++i) {
          const auto row = values.begin() + static_cast<std::ptrdiff_t>(i * count);
          rows.emplace_back(row, row + static_cast<std::ptrdiff_t>(count));
        }
      } catch (const std::domain_error&) {
      }
    }
    if (rows.size() < count) return false;
    std::size_t rank = 0;
    const cl_R least = cln::expt(cln::cl_RA(10), -zero_digits);
    for (const std::size_t column : order_) {
      std::size_t best = rank;
      for (std::size_t i = rank; i < rows.size(); ++i)
        if (cln::abs(rows[i][column]) > cln::abs(rows[best][column])) best = i;
      if (rank == rows.size() || cln::abs(rows[best][column]) < least) continue;
      std::swap(rows[rank], rows[best]);
      const cl_R lead = rows[rank][column];
      for (cl_R& entry : rows[rank]) entry = entry / lead;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const cl_R factor = rows[i][column];
        if (i == rank || cln::zerop(factor)) continue;
        for (std::size_t j = 0; j < count; ++j) rows[i][j] = rows[i][j] - factor * rows[rank][j];
      }
      pivots_.emplace(column, rank++);
    }
    for (auto& [column, row] : pivots_) {
      factors_[column] = rows[row];
      for (cl_R& factor : factors_[column])
        if (cln::abs(factor) < least) factor = 0;
    }
    return true;
  }

  /// Replaces a column that depends on others for the motions of this mechanism.
  bool relate_near_ground(std::size_t column) {
    std::vector<std::size_t> all;
    for (const std::size_t other : order_)
      if (pivots_.contains(other) && !cln::zerop(factors_.at(other)[column])) all.push_back(other);
    Terms terms;
    if (!all.empty()) {
      all.push_back(column);
      std::vector<std::vector<Sum>> written;
      for (const std::size_t other : all) {
        if (found_.columns[other].empty()) return false;
        written.push_back(found_.columns[other]);
      }
      const Echelon relations = relate_columns(written);
      for (const auto& [pivot, entries] : relations) {
        if (pivot + 1 == all.size()) return false;
        if (const auto factor = entries.find(all.size() - 1); factor != entries.end())
          terms[all[pivot]] = factor->second;
      }
    }
    for (Terms& others : terms_) {
      const auto here = others.find(column);
      if (here == others.end()) continue;
      const Sum factor = here->second;
      others.erase(here);
      add(others, factor, terms);
    }
    return true;
  }

  /// Whether the formulas have the values of the echelon form.
  bool is_confirmed() {
    const cl_R least = cln::expt(cln::cl_RA(10), -zero_digits);
    for (std::size_t j = 0; j < terms_.size(); ++j) {
      for (const auto& [pivot, row] : factors_) {
        cl_R value = 0;
        if (const auto found = terms_[j].find(pivot); found != terms_[j].end())
          value = symbolic::evaluate(
              *m_.dag, {to_dag(*m_.dag, found->second)}, [](const symbolic::Symbol& s) { return random_number(s, 0); },
              rank_digits)[0];
        if (cln::abs(value - row[j]) > least) return false;
      }
    }
    return true;
  }

  void write() {
    for (const std::size_t column : order_) {
      if (!pivots_.contains(column)) continue;
      found_.base.push_back({column, {}});
      for (std::size_t j = 0; j < terms_.size(); ++j)
        if (const auto factor = terms_[j].find(column); j != column && factor != terms_[j].end())
          found_.base.back().further.emplace_back(j, factor->second);
    }
    for (std::size_t j = 0; j < terms_.size(); ++j)
      if (terms_[j].empty()) found_.without_effect.push_back(j);
  }

  Mechanics& m_;
  const std::vector<std::vector<Ref>>& columns_;
  Regressor& found_;
  std::vector<Terms> terms_;  // each column by those that are kept
  std::vector<Block> blocks_;
  std::map<std::size_t, bool> is_done_;
  std::vector<std::size_t> order_;             // of elimination: carriers first
  std::map<std::size_t, std::size_t> pivots_;  // column to row
  std::map<std::size_t, std::vector<cl_R>> factors_;
};

}  // namespace

void find_carried_base(Mechanics& m, const std::vector<std::vector<Ref>>& columns, Regressor& found) {
  CarriedBase(m, columns, found)();
}

}  // namespace eomgen::reading
