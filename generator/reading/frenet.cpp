// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/frenet.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "reading/lagrangian.hpp"
#include "reading/no_value.hpp"
#include "reading/scalar_product.hpp"
#include "reading/small_matrix.hpp"
#include "reading/trig.hpp"
#include "reading/zero_test.hpp"

namespace eomgen::reading {
namespace {

constexpr std::size_t readable_curve_terms = 60;  // of |r' x r''|^2: more would fill pages

Components cross(const Components& a, const Components& b) {
  Components c;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    c[k] = simplify(a[i] * b[j] - a[j] * b[i]);
  }
  return c;
}

Components over(const Components& a, const Sum& length) {
  Components result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = a[k].is_zero() ? Sum() : simplify(a[k] * power(length, -1));
  return result;
}

bool vanishes(const Components& a) { return is_zero(a[0]) && is_zero(a[1]) && is_zero(a[2]); }

/// d/dp along the curve, with dq_i = direction_i dp for any parameter p.
class Along {
 public:
  Along(GinacBridge& bridge, const std::vector<std::uint32_t>& coordinates, std::vector<Sum> direction)
      : bridge_(bridge), coordinates_(coordinates), direction_(std::move(direction)) {}

  Components operator()(const Components& v) {
    Components result;
    for (std::size_t c = 0; c < 3; ++c) {
      Sum sum;
      for (std::size_t i = 0; i < coordinates_.size(); ++i) {
        if (!direction_[i].is_zero())
          sum += direction_[i] * bridge_.derivative(v[c], coordinate_symbol(coordinates_[i], 0));
      }
      result[c] = simplify(sum);
    }
    return result;
  }

 private:
  GinacBridge& bridge_;
  const std::vector<std::uint32_t>& coordinates_;
  std::vector<Sum> direction_;
};

// The null vector of the active constraints' gradients, by cofactors: (-1)^i det(A without column i).
std::vector<Sum> direction(const Mechanics& m, GinacBridge& bridge) {
  const std::size_t n = m.free.size();
  std::vector<Sum> A;
  for (const std::uint32_t k : m.active) {
    const Sum psi = bridge.sum(m.constraints[k].psi);
    for (const std::uint32_t i : m.free) A.push_back(bridge.derivative(psi, coordinate_symbol(i, 0)));
  }
  std::vector<Sum> result;
  for (std::size_t skipped = 0; skipped < n; ++skipped) {
    std::vector<Sum> minor;
    for (std::size_t row = 0; row + 1 < n; ++row) {
      for (std::size_t column = 0; column < n; ++column) {
        if (column != skipped) minor.push_back(A[row * n + column]);
      }
    }
    const Sum value = n == 1 ? Sum(1) : determinant(minor, n - 1);
    result.push_back(skipped % 2 == 0 ? value : -value);
  }
  return result;
}

// The chart's e_q on the curve; empty if they are not three orthonormal ones.
std::vector<Components> unit_vectors(Mechanics& m, GinacBridge& bridge, Frenet& f) {
  const auto& chart = m.model->places[m.masses[0].place].chart;
  std::vector<Components> result;
  if (!chart) return result;
  for (std::size_t k = 0; k < 3; ++k) {
    if (chart->unit_basis[k] == model::no_node || chart->entries[k] == model::no_node) break;
    const model::Node& entry = m.model->arena[chart->entries[k]];
    if (entry.op != model::Op::coordinate || entry.order != 0) break;
    const mechanics::Vec3 e = mechanics::lower_vector(m, chart->unit_basis[k]);
    Components unit;
    for (std::size_t c = 0; c < 3; ++c) unit[c] = bridge.sum(e[c]);
    result.push_back(unit);
    f.unit_names.push_back(entry.index);
  }
  bool orthonormal = result.size() == 3;
  for (std::size_t i = 0; orthonormal && i < 3; ++i) {
    for (std::size_t k = i; k < 3; ++k)
      orthonormal = orthonormal && is_zero(dot(result[i], result[k]) - Sum(i == k ? 1 : 0));
  }
  if (!orthonormal) result.clear();
  return result;
}

}  // namespace

std::string curve_obstacle(const Mechanics& m) {
  if (!m.body_rotations.empty()) return "the model has bodies, and a curve is of one particle";
  if (m.masses.size() != 1) return fmt::format("the model has {} particles, and a curve is of one", m.masses.size());
  for (const std::uint32_t k : m.active) {
    if (!m.constraints[k].holonomic())
      return fmt::format("'{}' is a constraint on velocities, which leaves no curve", m.constraints[k].label);
  }
  const std::size_t freedom = m.free.size() - m.active.size();
  if (freedom != 1) return fmt::format("its constraints leave {} degrees of freedom, and a curve has one", freedom);
  return "";
}

Frenet frenet(const Mechanics& mechanics) try {
  if (const std::string why = curve_obstacle(mechanics); !why.empty()) {
    throw Error("derive", SourceLocation{mechanics.model->file, 0, 0, 1, ""},
                "there is no curve whose Frenet triad could be shown: " + why,
                "leave 'frenet' out of --show, or constrain one particle by two holonomic constraints");
  }
  const work::Budget budget(form_budget);
  Mechanics m = mechanics;  // shares the Dag; lowering unit vectors may add nodes to it
  GinacBridge bridge(m);
  Frenet f;
  f.name = m.masses[0].name;
  // Eliminated coordinates are functions of time, which is fixed. They stay symbols, whose signs are known, until the
  // end.
  Components r;
  for (std::size_t c = 0; c < 3; ++c) r[c] = bridge.sum(m.masses[0].position[c]);
  Along along(bridge, m.free, direction(m, bridge));
  const Components first = along(r), second = along(first), third = along(second);
  if (vanishes(first)) {
    throw Error("derive", SourceLocation{mechanics.model->file, 0, 0, 1, ""},
                "there is no curve whose Frenet triad could be shown: the particle stays at one point",
                "leave 'frenet' out of --show");
  }
  const std::map<Symbol, Sum> imposed = imposed_values(m, bridge);
  const auto on_curve = [&](const Sum& sum) { return bridge.substitute(sum, imposed); };
  const std::vector<Components> unit = unit_vectors(m, bridge, f);
  const auto vector = [&](const Components& v, const Sum& length) {
    FrenetVector result{over(v, length), std::nullopt};
    if (!unit.empty()) result.unit = over({dot(v, unit[0]), dot(v, unit[1]), dot(v, unit[2])}, length);
    for (Sum& component : result.fixed) component = on_curve(component);
    if (result.unit)
      for (Sum& component : *result.unit) component = on_curve(component);
    return result;
  };
  const Sum speed = power(dot(first, first), Rational(1) / 2);
  if (m.free.size() == 1) {
    f.along = m.free[0];
    f.speed = on_curve(speed);
  }
  f.tangent = vector(first, speed);
  const Components bend = cross(first, second);
  if (!vanishes(bend)) {
    const Sum square = dot(bend, bend), size = power(square, Rational(1) / 2);
    if (square.size() > readable_curve_terms) throw TermBudget();
    f.binormal = vector(bend, size);
    f.normal = vector(cross(bend, first), size * speed);
    f.curvature = on_curve(simplify(size * power(speed, -3)));
    f.torsion = on_curve(simplify(dot(bend, third) * power(square, -1)));
  }
  return f;
} catch (const std::domain_error&) {
  throw no_value_error(mechanics);
}

}  // namespace eomgen::reading
