// SPDX-License-Identifier: GPL-3.0-or-later
// Bases (1.20), (1.22), metric (1.31), Christoffel symbols (2.184), (2.185) of one particle's coordinates, and of the
// whole system's configuration manifold.
#include <stdexcept>
#include <string>

#include "reading/contravariant.hpp"
#include "reading/lagrangian.hpp"
#include "reading/no_value.hpp"
#include "reading/rational_function.hpp"
#include "reading/scalar_product.hpp"
#include "reading/small_matrix.hpp"
#include "reading/trig.hpp"
#include "reading/zero_test.hpp"

namespace eomgen::reading {
namespace {

constexpr std::size_t largest_manifold = 6;

// [ij,k] = 1/2 (da_kj/dq_i + da_ik/dq_j - da_ij/dq_k), Gamma^k_ij = a^kr [ij,r]
void add_christoffel(GinacBridge& bridge, Geometry& g) {
  const std::size_t n = g.coordinates.size();
  std::vector<Sum> slope(n * n * n);  // da_ij/dq_k at (i n + j) n + k
  for (std::size_t i = 0; i < n * n; ++i) {
    for (std::size_t k = 0; k < n; ++k)
      slope[i * n + k] = bridge.derivative(g.metric[i], coordinate_symbol(g.coordinates[k], 0));
  }
  const auto d = [&](std::size_t i, std::size_t j, std::size_t k) -> const Sum& { return slope[(i * n + j) * n + k]; };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        g.first.push_back(simplify(Rational(1) / 2 * (d(k, j, i) + d(i, k, j) - d(i, j, k))));
      }
    }
  }
  if (g.inverse.empty()) return;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        Sum symbol;
        for (std::size_t r = 0; r < n; ++r) symbol += g.inverse[k * n + r] * g.first[(i * n + j) * n + r];
        g.second.push_back(simplify(symbol));
      }
    }
  }
}

Sum quadratic_form(GinacBridge& bridge, const Geometry& g) {
  const std::size_t n = g.coordinates.size();
  Sum result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      result += g.metric[i * n + k] * bridge.atom_table()(coordinate_symbol(g.coordinates[i], 1)) *
                bridge.atom_table()(coordinate_symbol(g.coordinates[k], 1));
    }
  }
  return result;
}

Components along(const Components& vector, const std::vector<Components>& unit) {
  return {dot(vector, unit[0]), dot(vector, unit[1]), dot(vector, unit[2])};
}

// The chart's unit vectors e_q, if it defines three orthonormal ones.
void add_unit_vectors(GinacBridge& bridge, mechanics::Mechanics& m, const model::Chart& chart, Geometry& g) {
  std::vector<Components> unit;
  for (std::size_t k = 0; k < 3; ++k) {
    if (chart.unit_basis[k] == model::no_node) return;
    const mechanics::Vec3 e = mechanics::lower_vector(m, chart.unit_basis[k]);
    unit.push_back({bridge.sum(e[0]), bridge.sum(e[1]), bridge.sum(e[2])});
    std::optional<std::uint32_t> name;
    if (chart.entries[k] != model::no_node) {
      const model::Node& entry = m.model->arena[chart.entries[k]];
      if (entry.op == model::Op::coordinate && entry.order == 0) name = entry.index;
    }
    g.unit_names.push_back(name);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = i; k < 3; ++k) {
      if (!is_zero(dot(unit[i], unit[k]) - Sum(i == k ? 1 : 0))) return;
    }
  }
  const auto nameable = [&](const std::vector<Components>& vectors) {
    for (const Components& v : vectors) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (!g.unit_names[k] && !v[k].is_zero()) return false;
      }
    }
    return true;
  };
  std::vector<Components> covariant, contravariant;
  for (const Components& a : g.covariant) covariant.push_back(along(a, unit));
  for (const Components& a : g.contravariant) contravariant.push_back(along(a, unit));
  if (!nameable(covariant) || !nameable(contravariant)) return;
  g.covariant_unit = std::move(covariant);
  g.contravariant_unit = std::move(contravariant);
}

void add_bases(GinacBridge& bridge, const Components& position, Geometry& g) {
  const std::size_t n = g.coordinates.size();
  for (const std::uint32_t i : g.coordinates) {
    Components a;
    for (std::size_t c = 0; c < 3; ++c) a[c] = bridge.derivative(position[c], coordinate_symbol(i, 0));
    g.covariant.push_back(std::move(a));
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) g.metric.push_back(dot(g.covariant[i], g.covariant[k]));
  }
  g.determinant = determinant(g.metric, n);
  if (g.determinant.is_zero()) return;
  g.inverse = inverse_matrix(g.metric, n);
  for (std::size_t i = 0; i < n; ++i) {
    Components a;
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t c = 0; c < 3; ++c) a[c] += g.inverse[i * n + k] * g.covariant[k][c];
    }
    for (Sum& component : a) component = simplify(component);
    g.contravariant.push_back(std::move(a));
  }
}

Geometry of_place(GinacBridge& bridge, Mechanics& m, std::uint32_t index, const mechanics::PointMass& mass) {
  const model::Place& place = m.model->places[index];
  Geometry g;
  g.name = place.name;
  for (const model::NodeId entry : place.chart->entries) {
    if (entry == model::no_node) continue;
    const model::Node& node = m.model->arena[entry];
    if (node.op == model::Op::coordinate && node.order == 0) g.coordinates.push_back(node.index);
  }
  Components position;
  const mechanics::Vec3 from = m.place_position[place.from].value();
  for (std::size_t c = 0; c < 3; ++c)
    position[c] = simplify(bridge.sum((*m.place_position[index])[c]) - bridge.sum(from[c]));
  add_bases(bridge, position, g);
  add_unit_vectors(bridge, m, *place.chart, g);
  add_christoffel(bridge, g);
  g.line_element = quadratic_form(bridge, g);
  g.kinetic = Rational(1) / 2 * bridge.sum(mass.mass) * g.line_element;
  return g;
}

/// With all coordinates of E^3N: M^ik = sum_p (a^i . a^k)_p / m_p by the dual basis of E^3N, (3.72), and det M =
/// prod_p m_p^3 det(a_ik)_p. Nothing for other systems.
void add_inverse_of_particles(const Mechanics& m, GinacBridge& bridge, Geometry& g) {
  const std::optional<SystemBasis> basis = m.fixed.empty() ? system_basis(m) : std::nullopt;
  if (!basis || basis->contravariant.empty()) return;
  const std::size_t n = g.coordinates.size();
  std::vector<Sum> reciprocal, inverse(n * n);
  Sum product(1);
  for (const mechanics::PointMass& mass : m.masses) {
    const Sum value = bridge.sum(mass.mass);
    reciprocal.push_back(quotient(Sum(1), value));
    product = product * value * value * value;
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i; k < n; ++k) {
      Sum entry;
      for (std::size_t c = 0; c < n; ++c)
        entry += basis->contravariant[i][c] * basis->contravariant[k][c] * reciprocal[c / 3];
      inverse[i * n + k] = inverse[k * n + i] = simplify(entry);
    }
  }
  for (const Geometry& particle : geometry(m)) product = simplify(product * particle.determinant);
  g.determinant = std::move(product);
  g.inverse = std::move(inverse);
}

}  // namespace

std::vector<Geometry> geometry(const Mechanics& mechanics, std::vector<LeftOut>* left_out) try {
  Mechanics m = mechanics;  // shares the Dag; lowering the unit vectors may add nodes to it
  GinacBridge bridge(m);
  std::vector<Geometry> result;
  for (std::size_t k = 0; k < m.masses.size(); ++k) {
    const std::uint32_t place = m.masses[k].place;
    if (!m.model->places[place].chart) continue;
    try {
      const work::Budget budget(item_budget);
      Geometry g = of_place(bridge, m, place, m.masses[k]);
      if (!g.coordinates.empty()) result.push_back(std::move(g));
    } catch (const work::BudgetExceeded& over) {
      if (left_out != nullptr) left_out->push_back({"geometry of " + m.model->places[place].name, over.what()});
    }
  }
  return result;
} catch (const std::domain_error&) {
  throw no_value_error(mechanics);
}

std::optional<Geometry> configuration_space(const Mechanics& m, std::vector<LeftOut>* left_out) try {
  const std::size_t n = m.free.size();
  if (n > largest_manifold) {
    if (left_out != nullptr)
      left_out->push_back(
          {"geometry of the configuration manifold", "more than " + std::to_string(largest_manifold) + " coordinates"});
    return std::nullopt;
  }
  GinacBridge bridge(m);
  Geometry g;
  g.coordinates = m.free;
  try {
    const work::Budget budget(form_budget);
    g.metric = mass_matrix(bridge, bridge.substitute(kinetic_energy(m, bridge), imposed_values(m, bridge)), m.free);
    if (n <= 3) {
      g.determinant = determinant(g.metric, n);
      if (!g.determinant.is_zero()) g.inverse = inverse_matrix(g.metric, n);
    } else {
      add_inverse_of_particles(m, bridge, g);
    }
    add_christoffel(bridge, g);
    g.line_element = quadratic_form(bridge, g);
    g.kinetic = Rational(1) / 2 * g.line_element;
  } catch (const work::BudgetExceeded& over) {
    if (left_out != nullptr) left_out->push_back({"geometry of the configuration manifold", over.what()});
    return std::nullopt;
  }
  return g;
} catch (const std::domain_error&) {
  throw no_value_error(m);
}

}  // namespace eomgen::reading
