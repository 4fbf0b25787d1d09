// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/regressor.hpp"

#include <algorithm>

#include "mechanics/imposition.hpp"
#include "reading/base_parameters.hpp"
#include "reading/column_relations.hpp"
#include "reading/ginac_bridge.hpp"
#include "reading/trig.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::reading {
namespace {

using symbolic::Vec3;

/// Of the written columns of Y, and of relations between them.
constexpr std::size_t writing_budget = form_budget / 2;

/// T and U of one parameter of size 1.
struct Energies {
  Ref kinetic, potential;
};

class RegressorReader {
 public:
  explicit RegressorReader(const Mechanics& mechanics)
      : m_(mechanics),
        dag_(*m_.dag),
        bridge_(m_),
        ddt_(symbolic::total_time_derivative(dag_, m_.q.size(), m_.model->functions.size())),
        imposed_(mechanics::constraint_substitution(m_)),
        gravity_(symbolic::zero_vector(dag_)) {
    for (const std::uint32_t i : m_.free) {
      by_q_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0}));
      by_rate_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 1}));
    }
    for (const model::Force& force : m_.model->forces)
      if (force.acceleration() != model::no_node)
        gravity_ = symbolic::add(dag_, gravity_, mechanics::lower_vector(m_, force.acceleration()));
  }

  Regressor operator()() {
    for (const mechanics::PointMass& mass : m_.masses) {
      const auto body = std::find_if(m_.model->bodies.begin(), m_.model->bodies.end(),
                                     [&](const model::Body& b) { return b.place == mass.place; });
      if (body != m_.model->bodies.end()) add_body(*body, mass.velocity);
      add({InertialParameter::Kind::mass, mass.place, 0, 0, bridge_.sum(mass.mass)},
          {half(symbolic::dot(dag_, mass.velocity, mass.velocity)), weight(mass.position)});
    }
    if (write_columns() && find_base()) return std::move(result_);
    for (std::vector<Ref>& column : columns_)
      for (Ref& force : column) force = imposed_(force);
    find_carried_base(m_, columns_, result_);
    return std::move(result_);
  }

 private:
  Ref half(Ref r) { return dag_.div(r, dag_.integer(2)); }
  Ref weight(const Vec3& arm) { return dag_.neg(symbolic::dot(dag_, gravity_, arm)); }

  // T = m v.v/2 + v.(w x m c) + w.Jw/2 for a body whose centre of mass is at c from its place. The mass comes last: it
  // acts like a moment and an inertia, and is then the one that joins them in the base parameters.
  void add_body(const model::Body& body, const Vec3& velocity) {
    const std::array<Ref, 3>& w = m_.angular_velocity[body.frame];
    std::array<Vec3, 3> e;
    std::array<Ref, 3> v;
    for (std::size_t k = 0; k < 3; ++k) {
      e[k] = mechanics::lower_vector(m_, m_.model->frames[body.frame].stages.back().e[k]);
      v[k] = symbolic::dot(dag_, velocity, e[k]);
    }
    for (std::uint32_t i = 0; i < 3; ++i) {
      for (std::uint32_t k = i; k < 3; ++k) {
        const Ref product = dag_.mul(w[i], w[k]);
        add({InertialParameter::Kind::inertia, body.place, i, k,
             bridge_.sum(mechanics::lower_scalar(m_, body.inertia[i][k]))},
            {i == k ? half(product) : product, dag_.zero()});
      }
    }
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      add({InertialParameter::Kind::moment, body.place, i, 0, Sum()},
          {dag_.sub(dag_.mul(v[j], w[k]), dag_.mul(v[k], w[j])), weight(e[i])});
    }
  }

  /// d/dt(dT/dqdot) - dT/dq + dU/dq of every free coordinate.
  void add(InertialParameter parameter, const Energies& of) {
    std::vector<Ref> column;
    for (std::size_t i = 0; i < m_.free.size(); ++i) {
      symbolic::Derivation &by_q = by_q_[i], &by_rate = by_rate_[i];
      column.push_back(dag_.add(dag_.sub(ddt_(by_rate(of.kinetic)), by_q(of.kinetic)), by_q(of.potential)));
    }
    result_.parameters.push_back(std::move(parameter));
    columns_.push_back(std::move(column));
  }

  /// Writes columns until one is too long. Those with at least as many coordinates are not tried then.
  bool write_columns() {
    const work::Budget budget(writing_budget);
    std::size_t longest = m_.free.size() + 1;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      std::vector<Sum>& column = result_.columns.emplace_back();
      const std::size_t coordinates = coordinates_in(columns_[j]);
      if (coordinates >= longest) continue;
      try {
        for (const Ref force : columns_[j]) column.push_back(simplify(bridge_.sum(imposed_(force))));
      } catch (const work::BudgetExceeded&) {
        column.clear();
        longest = std::max<std::size_t>(coordinates, 1);
      }
    }
    return longest > m_.free.size();
  }
  std::size_t coordinates_in(const std::vector<Ref>& column) const {
    const std::vector<Symbol> symbols = dag_.symbols(column);
    return static_cast<std::size_t>(std::count_if(symbols.begin(), symbols.end(), [](const Symbol& s) {
      return s.kind == SymbolKind::coordinate && s.order == 0;
    }));
  }

  bool find_base() {
    try {
      const work::Budget budget(writing_budget);
      const Echelon pivots = relate_columns(result_.columns);
      std::vector<bool> has_effect(result_.columns.size(), false);
      for (const auto& [column, row] : pivots) {
        result_.base.push_back({column, {}});
        for (const auto& [j, factor] : row) {
          has_effect[j] = true;
          if (j != column) result_.base.back().further.emplace_back(j, factor);
        }
      }
      for (std::size_t j = 0; j < has_effect.size(); ++j)
        if (!has_effect[j]) result_.without_effect.push_back(j);
      return true;
    } catch (const work::BudgetExceeded&) {
      return false;
    }
  }

  Mechanics m_;  // shares the Dag; lowering adds nodes to it
  symbolic::Dag& dag_;
  GinacBridge bridge_;
  symbolic::Derivation ddt_;
  std::vector<symbolic::Derivation> by_q_, by_rate_;  // per free coordinate
  symbolic::Substitution imposed_;
  Vec3 gravity_;
  std::vector<std::vector<Ref>> columns_;
  Regressor result_;
};

}  // namespace

Regressor regressor(const Mechanics& m) { return RegressorReader(m)(); }

}  // namespace eomgen::reading
