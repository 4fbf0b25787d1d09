// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/lagrangian.hpp"

#include "reading/trig.hpp"

namespace eomgen::reading {

namespace {

// Terms of the kinetic energy: with more, no equation fits on a page.
constexpr std::size_t readable_terms = 800;

bool over_a_sum(const Sum& sum) {
  for (const auto& [monomial, coefficient] : sum.terms()) {
    for (const Factor& factor : monomial) {
      if (factor.atom->op == Op::add && cln::minusp(factor.exponent)) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<DisplayRotation> display_rotations(const Mechanics& m, GinacBridge& bridge) {
  std::vector<DisplayRotation> result;
  for (const mechanics::BodyRotation& spin : m.body_rotations) {
    DisplayRotation read;
    read.name = spin.name;
    read.frame = spin.frame;
    for (std::size_t i = 0; i < 3; ++i) {
      read.w[i] = simplify(bridge.sum(spin.w[i]));
      for (std::size_t k = 0; k < 3; ++k) read.J[i][k] = bridge.sum(spin.J[i][k]);
    }
    result.push_back(std::move(read));
  }
  return result;
}

Sum translational_energy(const Mechanics& m, GinacBridge& bridge) {
  Sum result = bridge.sum(m.kinetic_given);
  for (const mechanics::PointMass& mass : m.masses) {
    Sum square;
    for (const symbolic::Ref x : mass.position) {
      const Sum v = bridge.total_derivative(bridge.sum(x));
      square += v * v;
    }
    result += bridge.sum(mass.mass) * (Rational(1) / 2 * simplify(square));
    if (result.size() > readable_terms) throw TermBudget();
  }
  return simplify(result);
}

Sum kinetic_energy(const Sum& translation, const std::vector<DisplayRotation>& body_rotations) {
  Sum result = translation;
  for (const DisplayRotation& spin : body_rotations) {
    Sum twice;
    for (std::size_t i = 0; i < 3; ++i) {
      // Over a sum, as with Euler parameters, products of components are too long to display.
      if (over_a_sum(spin.w[i])) throw TermBudget();
      for (std::size_t k = 0; k < 3; ++k) {
        if (!spin.J[i][k].is_zero()) twice += spin.J[i][k] * simplify(spin.w[i] * spin.w[k]);
      }
    }
    result += Rational(1) / 2 * simplify(twice);
    if (result.size() > readable_terms) throw TermBudget();
  }
  return simplify(result);
}

Sum kinetic_energy(const Mechanics& m, GinacBridge& bridge) {
  const Sum translation = translational_energy(m, bridge);
  return kinetic_energy(translation, display_rotations(m, bridge));
}

Sum generalized_force(const Mechanics& m, GinacBridge& bridge, std::uint32_t i) {
  Sum result;
  for (const std::vector<symbolic::Ref>& Q : m.force_components) result += bridge.sum(Q[i]);
  for (const mechanics::Contact& contact : m.contacts) {
    for (std::uint32_t a = 0; a < contact.dimensions(); ++a) {
      result += bridge.sum(contact.tangents[a][i]) * bridge.atom_table()({SymbolKind::friction, contact.first + a, 0});
    }
  }
  return simplify(result);
}

std::map<Symbol, Sum> imposed_values(const Mechanics& m, GinacBridge& bridge) {
  std::map<Symbol, Sum> values;
  for (const mechanics::FixedCoordinate& fixed : m.fixed) {
    values[coordinate_symbol(fixed.coordinate, 0)] = bridge.sum(fixed.value);
    values[coordinate_symbol(fixed.coordinate, 1)] = bridge.sum(fixed.rate);
    values[coordinate_symbol(fixed.coordinate, 2)] = bridge.sum(fixed.acceleration);
  }
  return values;
}

std::optional<std::array<Sum, 3>> split_by_degree(const Sum& kinetic) {
  std::array<Sum, 3> parts;
  const auto is_rate = [](const Atom& atom) {
    return atom.op == Op::symbol && atom.symbol.kind == SymbolKind::coordinate && atom.symbol.order == 1;
  };
  for (const auto& [monomial, coefficient] : kinetic.terms()) {
    Rational degree = 0;
    bool inside = false;
    for (const Factor& factor : monomial) {
      if (is_rate(*factor.atom)) degree = degree + factor.exponent;
      for (const Sum& arg : factor.atom->args)
        for_each_atom(arg, [&](const Atom& atom) { inside = inside || is_rate(atom); });
    }
    if (inside || !is_integer(degree) || cln::minusp(degree) || degree > 2) return std::nullopt;
    parts[static_cast<std::size_t>(2 - to_long(degree))].add(monomial, coefficient);
  }
  return parts;
}

namespace {

/// e_i + sum_c e_c dq_c/dq_i over the eliminated coordinates q_c that depend on q_i, for components e along the
/// coordinates.
template <class Component>
Sum along_free(const Mechanics& m, GinacBridge& bridge, std::uint32_t i, const std::map<Symbol, Sum>& values,
               Component&& component) {
  Sum result = component(i);
  for (const mechanics::FixedCoordinate& fixed : m.fixed) {
    const Sum slope = bridge.derivative(values.at(coordinate_symbol(fixed.coordinate, 0)), coordinate_symbol(i, 0));
    if (fixed.coordinate != i && !slope.is_zero()) result += component(fixed.coordinate) * slope;
  }
  return result;
}

}  // namespace

Equation lagrange_equation(const Mechanics& m, GinacBridge& bridge, const Sum& lagrangian, std::uint32_t i,
                           const std::map<Symbol, Sum>& values) {
  Equation result;
  result.coordinate = i;
  result.of_motion = !m.is_eliminated(i);
  const Sum momentum = bridge.derivative(lagrangian, coordinate_symbol(i, 1));
  const Sum slope = bridge.derivative(lagrangian, coordinate_symbol(i, 0));
  result.expanded = bridge.substitute(bridge.total_derivative(momentum) - slope, values);
  result.expanded = simplify(result.expanded);
  result.momentum = bridge.substitute(momentum, values);
  result.slope = bridge.substitute(slope, values);
  const auto force = [&](std::uint32_t k) { return generalized_force(m, bridge, k); };
  result.force = simplify(bridge.substitute(along_free(m, bridge, i, values, force), values));
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    const mechanics::Constraint& c = m.constraints[k];
    if (!m.is_independent(k)) continue;
    const auto gradient = [&](std::uint32_t j) {
      return c.holonomic() ? bridge.derivative(bridge.sum(c.psi), coordinate_symbol(j, 0))
                           : simplify(bridge.sum(c.gradient[j]));
    };
    Sum imposed = bridge.substitute(along_free(m, bridge, i, values, gradient), values);
    if (!imposed.is_zero()) result.multipliers.push_back({k, std::move(imposed)});
  }
  return result;
}

}  // namespace eomgen::reading
