// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/regressor.hpp"

#include <algorithm>
#include <map>

#include "mechanics/imposition.hpp"
#include "reading/ginac_bridge.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::reading {
namespace {

using mechanics::Mechanics;
using symbolic::Ref;
using symbolic::Vec3;

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
    find_base();
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
    std::vector<Sum> column;
    for (const std::uint32_t i : m_.free) {
      symbolic::Derivation by_q = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0}),
                           by_rate = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 1});
      const Ref force = dag_.add(dag_.sub(ddt_(by_rate(of.kinetic)), by_q(of.kinetic)), by_q(of.potential));
      column.push_back(simplify(bridge_.sum(imposed_(force))));
    }
    result_.parameters.push_back(std::move(parameter));
    result_.columns.push_back(std::move(column));
  }

  static bool is_constant(const Atom& atom) {
    bool constant = atom.op != Op::symbol || atom.symbol.kind == SymbolKind::parameter;
    for (const Sum& arg : atom.args)
      for_each_atom(arg, [&constant](const Atom& inner) {
        constant = constant && (inner.op != Op::symbol || inner.symbol.kind == SymbolKind::parameter);
      });
    return constant;
  }

  using Row = std::map<std::size_t, Sum>;  // column to entry, without zeros

  /// A row per coordinate and product of functions of the motion, which are independent: its factors in each column.
  std::vector<Row> rows() const {
    std::vector<std::map<Monomial, Row, MonomialLess>> by_coordinate(m_.free.size());
    for (std::size_t j = 0; j < result_.columns.size(); ++j) {
      for (std::size_t i = 0; i < m_.free.size(); ++i) {
        const Sum expanded = expand_angles(result_.columns[j][i]);
        for (const auto& [monomial, coefficient] : expanded.terms()) {
          Monomial motion, constant;
          for (const Factor& factor : monomial) (is_constant(*factor.atom) ? constant : motion).push_back(factor);
          by_coordinate[i][motion][j].add(constant, coefficient);
        }
      }
    }
    std::vector<Row> all;
    for (auto& of_coordinate : by_coordinate) {
      for (auto& [motion, row] : of_coordinate) {
        std::erase_if(row, [](const auto& entry) { return entry.second.is_zero(); });
        if (!row.empty()) all.push_back(std::move(row));
      }
    }
    // Short rows first: they keep the factors of the elimination simple.
    std::stable_sort(all.begin(), all.end(), [](const Row& a, const Row& b) { return a.size() < b.size(); });
    return all;
  }

  static void subtract(Row& from, const Sum& factor, const Row& row) {
    for (const auto& [j, entry] : row) {
      Sum& sum = from[j];
      sum = cancel(sum - factor * entry);
      if (sum.is_zero()) from.erase(j);
    }
  }

  /// The reduced row echelon form: column k is the sum of P_bk times column b over the pivots b.
  void find_base() {
    std::map<std::size_t, Row> pivots;
    for (Row row : rows()) {
      for (const auto& [column, pivot] : pivots) {
        const auto here = row.find(column);
        if (here == row.end()) continue;
        const Sum factor = here->second;
        subtract(row, factor, pivot);
      }
      if (row.empty()) continue;
      const std::size_t column = row.begin()->first;
      const Sum lead = row.begin()->second;
      for (auto& [j, entry] : row) entry = quotient(entry, lead);
      for (auto& [other, pivot] : pivots) {
        const auto here = pivot.find(column);
        if (here == pivot.end()) continue;
        const Sum factor = here->second;
        subtract(pivot, factor, row);
      }
      pivots.emplace(column, std::move(row));
    }
    std::vector<bool> has_effect(result_.columns.size(), false);
    for (auto& [column, row] : pivots) {
      result_.base.push_back({column, {}});
      for (auto& [j, factor] : row) {
        has_effect[j] = true;
        if (j != column) result_.base.back().further.emplace_back(j, std::move(factor));
      }
    }
    for (std::size_t j = 0; j < has_effect.size(); ++j)
      if (!has_effect[j]) result_.without_effect.push_back(j);
  }

  Mechanics m_;  // shares the Dag; lowering adds nodes to it
  symbolic::Dag& dag_;
  GinacBridge bridge_;
  symbolic::Derivation ddt_;
  symbolic::Substitution imposed_;
  Vec3 gravity_;
  Regressor result_;
};

}  // namespace

Regressor regressor(const Mechanics& m) {
  const work::Budget budget(form_budget);
  return RegressorReader(m)();
}

}  // namespace eomgen::reading
