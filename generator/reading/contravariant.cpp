// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/contravariant.hpp"

#include <algorithm>
#include <stdexcept>

#include "reading/lagrangian.hpp"
#include "reading/no_value.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

constexpr std::size_t most_particles = 4;  // of a basis that is read

/// The coordinates of one particle, if they are all coordinates of the model.
std::optional<Geometry> of_one_particle(const Mechanics& m) {
  if (m.masses.size() != 1 || !m.body_rotations.empty()) return std::nullopt;
  std::vector<LeftOut> unseen;
  std::vector<Geometry> particles = geometry(m, &unseen);
  if (!unseen.empty()) throw work::BudgetExceeded(unseen.front().why);
  if (particles.size() != 1 || particles[0].coordinates.size() != m.q.size() || particles[0].second.empty())
    return std::nullopt;
  return std::move(particles[0]);
}

std::optional<Geometry> of_system(const Mechanics& m, ContravariantForm& form) {
  if (!m.fixed.empty()) {
    form.skip_reason = "constraints fix coordinates of a system: its metric has no contravariant form of all of them";
    return std::nullopt;
  }
  const DisplayForm two = derive_display_form(m, system::Approach::two);
  if (two.is_unexpanded) throw work::BudgetExceeded(two.unexpanded_reason);
  if (!two.by_degree || !(*two.by_degree)[1].is_zero() || !(*two.by_degree)[2].is_zero()) {
    form.skip_reason = "T is not a quadratic form of the rates: something moves by prescription";
    return std::nullopt;
  }
  std::vector<LeftOut> unseen;
  std::optional<Geometry> g = configuration_space(m, &unseen);
  if (!unseen.empty()) throw work::BudgetExceeded(unseen.front().why);
  if (g && g->second.empty())
    form.skip_reason =
        "the inverse of the metric is shown for at most three coordinates, and for particles that have all "
        "coordinates of their space";
  return form.skip_reason.empty() ? std::move(g) : std::nullopt;
}

void add_equations(const Mechanics& m, const Geometry& g, ContravariantForm& form) {
  GinacBridge bridge(m);
  const std::size_t n = g.coordinates.size();
  const Sum U = bridge.sum(m.potential);
  std::vector<Sum> Q;
  for (const std::uint32_t i : g.coordinates)
    Q.push_back(generalized_force(m, bridge, i) - bridge.derivative(U, coordinate_symbol(i, 0)));
  const auto raised = [&](const std::vector<Sum>& covariant, std::size_t k) {
    Sum result;
    for (std::size_t r = 0; r < n; ++r) result += g.inverse[k * n + r] * covariant[r];
    return simplify(result);
  };
  for (std::size_t k = 0; k < n; ++k) {
    ContravariantEquation equation;
    equation.coordinate = g.coordinates[k];
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j)
        equation.curvature += g.second[(i * n + j) * n + k] *
                              bridge.atom_table()(coordinate_symbol(g.coordinates[i], 1)) *
                              bridge.atom_table()(coordinate_symbol(g.coordinates[j], 1));
    }
    equation.curvature = simplify(equation.curvature);
    equation.force = raised(Q, k);
    for (std::uint32_t c = 0; c < m.constraints.size(); ++c) {
      if (!m.is_independent(c)) continue;
      std::vector<Sum> gradient;
      for (const std::uint32_t i : g.coordinates) gradient.push_back(bridge.sum(m.constraints[c].gradient[i]));
      Sum slope = raised(gradient, k);
      if (!slope.is_zero()) equation.multipliers.push_back({c, std::move(slope)});
    }
    form.equations.push_back(std::move(equation));
  }
}

}  // namespace

ContravariantForm contravariant_form(const Mechanics& m) try {
  ContravariantForm form;
  try {
    const work::Budget budget(form_budget);
    if (const std::optional<Geometry> particle = of_one_particle(m)) {
      GinacBridge bridge(m);
      form.mass = bridge.sum(m.masses[0].mass);
      // dm/dt would act along the velocity.
      if (!bridge.explicit_derivative(form.mass).is_zero())
        form.skip_reason = "the mass depends on time: d(mv)/dt has a term along the velocity beside this form";
      else
        add_equations(m, *particle, form);
    } else if (const std::optional<Geometry> system = of_system(m, form)) {
      add_equations(m, *system, form);
    }
  } catch (const work::BudgetExceeded& over) {
    form = {};
    form.skip_reason = over.what();
  }
  return form;
} catch (const std::domain_error&) {
  throw no_value_error(m);
}

std::optional<SystemBasis> system_basis(const Mechanics& m) try {
  const std::size_t N = m.masses.size();
  if (N < 2 || N > most_particles || !m.body_rotations.empty()) return std::nullopt;
  SystemBasis basis;
  for (const mechanics::PointMass& mass : m.masses) basis.particles.push_back(m.model->places[mass.place].name);
  for (std::uint32_t i = 0; i < m.q.size(); ++i) basis.coordinates.push_back(i);
  try {
    const work::Budget budget(form_budget);
    GinacBridge bridge(m);
    for (std::uint32_t i = 0; i < m.q.size(); ++i) {
      std::vector<Sum> a;
      for (const mechanics::PointMass& mass : m.masses) {
        for (const symbolic::Ref x : mass.position)
          a.push_back(simplify(bridge.derivative(bridge.sum(x), coordinate_symbol(i, 0))));
      }
      basis.covariant.push_back(std::move(a));
    }
    if (m.q.size() != 3 * N) return basis;
    // A coordinate of the chart of particle p from the place of particle f is a function of r_p - r_f.
    std::vector<LeftOut> unseen;
    std::vector<std::vector<Sum>> dual(m.q.size());
    for (const Geometry& g : geometry(m, &unseen)) {
      const auto p = std::find_if(m.masses.begin(), m.masses.end(), [&](const mechanics::PointMass& mass) {
        return m.model->places[mass.place].name == g.name;
      });
      if (p == m.masses.end() || g.contravariant.size() != 3) return basis;
      const std::uint32_t from = m.model->places[p->place].from;
      const auto f = std::find_if(m.masses.begin(), m.masses.end(),
                                  [from](const mechanics::PointMass& mass) { return mass.place == from; });
      if (from != 0 && f == m.masses.end()) return basis;
      for (std::size_t i = 0; i < 3; ++i) {
        std::vector<Sum> a(3 * N);
        for (std::size_t k = 0; k < 3; ++k) {
          a[3 * static_cast<std::size_t>(p - m.masses.begin()) + k] = g.contravariant[i][k];
          if (from != 0) a[3 * static_cast<std::size_t>(f - m.masses.begin()) + k] = -g.contravariant[i][k];
        }
        dual[g.coordinates[i]] = std::move(a);
      }
    }
    if (std::none_of(dual.begin(), dual.end(), [](const auto& a) { return a.empty(); })) basis.contravariant = dual;
  } catch (const work::BudgetExceeded&) {
    return std::nullopt;
  }
  return basis;
} catch (const std::domain_error&) {
  throw no_value_error(m);
}

}  // namespace eomgen::reading
