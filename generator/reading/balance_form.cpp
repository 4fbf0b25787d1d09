// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/balance_form.hpp"

#include <algorithm>
#include <stdexcept>

#include "lists.hpp"
#include "reading/lagrangian.hpp"
#include "reading/linear_system.hpp"
#include "reading/no_value.hpp"
#include "reading/rational_function.hpp"
#include "reading/small_matrix.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

constexpr std::uint8_t omega_order = 6, cosine_order = 8;  // of auxiliary symbols; lower ones belong to other forms

struct Unsuitable {
  std::string reason;
};

/// f . v + h . omega + b = 0 with the components of f and h along E1, E2, E3.
struct BalanceRow {
  std::uint32_t constraint = 0;
  Components f, h;
  Sum b;
};

class Balance {
 public:
  explicit Balance(const Mechanics& m) : m_(m), bridge_(m_) {}

  BalanceForm derive() {
    require_one_body();
    read_kinematics();
    read_inertia();
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
      if (m_.is_independent(k)) read_constraint(k);
    }
    write();
    return std::move(form_);
  }

 private:
  AtomTable& atoms() { return bridge_.atom_table(); }
  Sum omega(std::uint32_t k, std::uint8_t order = 0) { return atoms()(omega_symbol(k, order)); }
  Sum cosine(std::uint32_t i, std::uint32_t k) {
    form_.has_cosines = true;
    return atoms()(cosine_symbol(i, k));
  }
  Sum clean(const Sum& sum) { return simplify(cancel(simplify(sum))); }

  void require_one_body() {
    if (m_.model->bodies.size() != 1 || m_.masses.size() != 1 || !m_.dag->is_zero(m_.kinetic_given))
      throw Unsuitable{"the balance laws are shown for one rigid body alone"};
    const model::Body& body = m_.model->bodies[0];
    form_.frame = body.frame;
    const model::Frame& frame = m_.model->frames[body.frame];
    if (frame.parent != 0) throw Unsuitable{"the attitude of the body is relative to another frame"};
    const auto& chart = m_.model->places[body.place].chart;
    const auto coordinate_of = [&](model::NodeId id) -> std::optional<std::uint32_t> {
      if (id == model::no_node) return std::nullopt;
      const model::Node& node = m_.model->arena[id];
      if (node.op != model::Op::coordinate || node.order != 0) return std::nullopt;
      return node.index;
    };
    for (std::size_t k = 0; chart && chart->system == "cartesian" && k < 3; ++k) {
      if (const auto q = coordinate_of(chart->entries[k])) form_.position.push_back(*q);
    }
    for (const model::NodeId id : frame.entries) {
      if (const auto q = coordinate_of(id)) angles_.push_back(*q);
    }
    if (form_.position.size() != 3) throw Unsuitable{"the centre of mass needs three Cartesian coordinates"};
    if (angles_.size() != frame.entries.size() || angles_.size() < 3 ||
        angles_.size() + form_.position.size() != m_.q.size())
      throw Unsuitable{"the attitude of the body needs three angles or Euler parameters as its coordinates"};
  }

  // d nu_i/dt = sum_k S_ik omega_k with omega along the body's own axes.
  void read_kinematics() {
    const std::size_t n = angles_.size();
    std::vector<Sum> B(3 * n);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < n; ++i)
        B[k * n + i] = clean(
            bridge_.derivative(bridge_.sum(m_.angular_velocity[form_.frame][k]), coordinate_symbol(angles_[i], 1)));
    }
    S_.assign(3 * n, Sum());
    if (n == 3) {
      S_ = inverse_matrix(B, 3);
    } else {
      // Euler parameters: B B^T = 4/N 1 with N = e . e, so that S = N/4 B^T.
      Sum N;
      for (const std::uint32_t i : angles_) N += atoms()(coordinate_symbol(i, 0)) * atoms()(coordinate_symbol(i, 0));
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < 3; ++k) S_[i * 3 + k] = clean(Rational(1) / 4 * (N * B[k * n + i]));
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const mechanics::Vec3 e = mechanics::lower_vector(m_, m_.model->frames[form_.frame].stages.back().e[k]);
      for (std::size_t i = 0; i < 3; ++i) axes_[k][i] = clean(bridge_.sum(e[i]));
    }
  }

  void read_inertia() {
    const mechanics::BodyRotation& rotation = m_.body_rotations[0];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) J_[i][k] = bridge_.sum(rotation.J[i][k]);
    }
    form_.along_fixed =
        J_[0][1].is_zero() && J_[0][2].is_zero() && J_[1][2].is_zero() && J_[0][0] == J_[1][1] && J_[1][1] == J_[2][2];
    mass_ = bridge_.sum(m_.masses[0].mass);
  }

  /// A covector of the angles as a vector along E1, E2, E3: sum_i c_i S_ik e_k.
  Components along_fixed(const std::vector<Sum>& covector) {
    Components result;
    for (std::size_t k = 0; k < 3; ++k) {
      Sum own;
      for (std::size_t i = 0; i < angles_.size(); ++i) own += covector[i] * S_[i * 3 + k];
      own = clean(own);
      for (std::size_t c = 0; c < 3; ++c) result[c] += own * axes_[k][c];
    }
    for (Sum& component : result) component = clean(component);
    return result;
  }

  bool names_angles(const Sum& sum) const {
    return std::any_of(angles_.begin(), angles_.end(),
                       [&](std::uint32_t i) { return contains(sum, coordinate_symbol(i, 0)); });
  }

  void read_constraint(std::uint32_t k) {
    const mechanics::Constraint& c = m_.constraints[k];
    BalanceRow row;
    row.constraint = k;
    std::vector<Sum> covector;
    for (std::size_t j = 0; j < 3; ++j) row.f[j] = clean(bridge_.sum(c.gradient[form_.position[j]]));
    for (const std::uint32_t i : angles_) covector.push_back(bridge_.sum(c.gradient[i]));
    row.h = along_fixed(covector);
    row.b = clean(bridge_.sum(c.rate));
    const auto is_zero = [](const Sum& s) { return s.is_zero(); };
    if (std::all_of(row.f.begin(), row.f.end(), is_zero) && std::all_of(row.h.begin(), row.h.end(), is_zero))
      return;  // the unit length of Euler parameters
    for (const Components* vector : {&row.f, &row.h}) {
      for (const Sum& component : *vector) {
        if (names_angles(component))
          throw Unsuitable{
              "the constraint '" + c.label +
              "' depends on the attitude beyond omega: Lagrange's equations show it, derive --show solved"};
      }
    }
    if (names_angles(row.b)) throw Unsuitable{"the constraint '" + c.label + "' depends on the attitude beyond omega"};
    rows_.push_back(std::move(row));
  }

  /// vector . (omega, or its rate).
  Sum with_omega(const Components& vector, std::uint8_t order) {
    Sum result;
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (vector[i].is_zero()) continue;
      if (form_.along_fixed) {
        result += vector[i] * omega(i, order);
        continue;
      }
      for (std::uint32_t k = 0; k < 3; ++k) result += vector[i] * cosine(i, k) * omega(k, order);
    }
    return result;
  }
  Sum velocity(std::size_t j) { return atoms()(coordinate_symbol(form_.position[j], 1)); }
  Sum acceleration(std::size_t j) { return atoms()(coordinate_symbol(form_.position[j], 2)); }

  // sum_i (E_i . e_j) (E_i . e_k) is 1 if j = k, else 0: the products of E1 follow from the others.
  Sum orthonormal(const Sum& sum) {
    if (form_.along_fixed) return sum;
    Sum result;
    for (const auto& [monomial, coefficient] : sum.terms()) {
      Monomial rest;
      std::vector<std::uint32_t> first;  // k of E1 . e_k
      for (const Factor& factor : monomial) {
        const Atom& atom = *factor.atom;
        const bool is_first = atom.op == Op::symbol && atom.symbol.kind == SymbolKind::auxiliary &&
                              atom.symbol.order == cosine_order && atom.symbol.index < 3;
        if (!is_first || !is_integer(factor.exponent) || !cln::plusp(factor.exponent)) {
          rest.push_back(factor);
          continue;
        }
        for (long times = 0; times < to_long(factor.exponent); ++times) first.push_back(atom.symbol.index);
      }
      Sum term(rest, coefficient);
      for (std::size_t n = 0; n + 1 < first.size(); n += 2) {
        Sum pair(first[n] == first[n + 1] ? 1 : 0);
        for (const std::uint32_t i : {1u, 2u}) pair -= cosine(i, first[n]) * cosine(i, first[n + 1]);
        term = term * pair;
      }
      if (first.size() % 2 == 1) term = term * cosine(0, first.back());
      result += term;
    }
    return simplify(result);
  }

  void write() {
    std::vector<Sum> rates;  // of the constraints
    for (const BalanceRow& row : rows_) {
      Sum speed = with_omega(row.h, 0) + row.b, rate = with_omega(row.h, 1);
      Sum slopes = bridge_.total_derivative(row.b);
      for (std::size_t j = 0; j < 3; ++j) {
        speed += row.f[j] * velocity(j);
        rate += row.f[j] * acceleration(j);
        slopes += bridge_.total_derivative(row.f[j]) * velocity(j);
      }
      Components turning;
      for (std::size_t j = 0; j < 3; ++j) turning[j] = bridge_.total_derivative(row.h[j]);
      form_.constraints.push_back(simplify(speed));
      rates.push_back(simplify(rate + slopes + with_omega(turning, 0)));
    }
    const Sum U = bridge_.sum(m_.potential);
    const auto force = [&](std::uint32_t i) {
      return clean(generalized_force(m_, bridge_, i) - bridge_.derivative(U, coordinate_symbol(i, 0)));
    };
    Components F, M;
    for (std::size_t j = 0; j < 3; ++j) F[j] = force(form_.position[j]);
    std::vector<Sum> covector = mapped(angles_, [&](std::uint32_t i) { return force(i); });
    M = along_fixed(covector);
    for (const Components* vector : {&F, &M}) {
      for (const Sum& component : *vector) {
        if (names_angles(component))
          throw Unsuitable{"the applied forces depend on the attitude beyond omega: derive --show solved"};
      }
    }
    // F = m dv/dt, with the multipliers; then dH/dt = M.
    std::vector<Sum> linear;
    for (std::size_t j = 0; j < 3; ++j) {
      Sum left = mass_ * acceleration(j) - F[j];
      for (const BalanceRow& row : rows_) left -= multiplier(row) * row.f[j];
      linear.push_back(std::move(left));
    }
    std::vector<Sum> angular = moment_equations(M);
    std::vector<Symbol> unknowns = mapped(form_.position, [&](std::uint32_t j) { return coordinate_symbol(j, 2); });
    for (const BalanceRow& row : rows_) unknowns.push_back({SymbolKind::multiplier, row.constraint, 0});
    std::vector<Sum> known = linear;
    known.insert(known.end(), rates.begin(), rates.end());
    const std::vector<std::optional<Sum>> solution = solve_linear(known, unknowns);
    std::map<Symbol, Sum> values;
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      if (!solution[j])
        throw Unsuitable{"the constraints do not give the constraint forces by the balance of linear momentum alone"};
      values[unknowns[j]] = orthonormal(*solution[j]);
    }
    if (!rows_.empty()) {
      Components N;
      for (std::size_t j = 0; j < 3; ++j)
        N[j] = simplify(mass_ * values.at(coordinate_symbol(form_.position[j], 2)) - F[j]);
      form_.constraint_force = std::move(N);
    }
    std::vector<Symbol> omega_rates;
    for (std::uint32_t k = 0; k < 3; ++k) omega_rates.push_back(omega_symbol(k, 1));
    for (const Sum& equation : angular)
      form_.moments.push_back(clean(orthonormal(clean(bridge_.substitute(equation, values)))));
    try {
      form_.rates = solve_linear(form_.moments, omega_rates);
    } catch (const work::BudgetExceeded&) {
      form_.rates.assign(3, std::nullopt);  // the equations above determine them
    }
    std::map<Symbol, Sum> solved;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (form_.rates[k]) solved[omega_rates[k]] = *form_.rates[k];
    }
    for (const std::uint32_t j : form_.position) {
      const Sum value = values.at(coordinate_symbol(j, 2));
      if (solved.size() == 3)
        form_.accelerations.push_back(clean(bridge_.substitute(value, solved)));
      else
        form_.accelerations.push_back(std::nullopt);
    }
  }

  Sum multiplier(const BalanceRow& row) { return atoms()({SymbolKind::multiplier, row.constraint, 0}); }

  // J omega_dot + omega x J omega - M - sum lambda h, along the axes of the form.
  std::vector<Sum> moment_equations(const Components& M) {
    std::vector<Sum> result;
    std::array<Sum, 3> H;
    for (std::uint32_t k = 0; k < 3; ++k) {
      for (std::uint32_t l = 0; l < 3; ++l) H[k] += J_[k][l] * omega(l);
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t i = (k + 1) % 3, j = (k + 2) % 3;
      Sum left;
      for (std::uint32_t l = 0; l < 3; ++l) left += J_[k][l] * omega(l, 1);
      if (!form_.along_fixed) left += omega(i) * H[j] - omega(j) * H[i];
      left -= component(M, k);
      for (const BalanceRow& row : rows_) left -= multiplier(row) * component(row.h, k);
      result.push_back(simplify(left));
    }
    return result;
  }
  Sum component(const Components& vector, std::uint32_t k) {
    if (form_.along_fixed) return vector[k];
    Sum result;
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (!vector[i].is_zero()) result += vector[i] * cosine(i, k);
    }
    return result;
  }

  Mechanics m_;  // shares the Dag; lowering adds nodes to it
  GinacBridge bridge_;
  BalanceForm form_;
  std::vector<std::uint32_t> angles_;
  std::vector<Sum> S_;  // n x 3
  std::array<Components, 3> axes_;
  std::array<Components, 3> J_;
  Sum mass_;
  std::vector<BalanceRow> rows_;
};

}  // namespace

Symbol omega_symbol(std::uint32_t k, std::uint8_t order) {
  return {SymbolKind::auxiliary, k, static_cast<std::uint8_t>(omega_order + order)};
}
Symbol cosine_symbol(std::uint32_t i, std::uint32_t k) { return {SymbolKind::auxiliary, 3 * i + k, cosine_order}; }

BalanceForm balance_form(const Mechanics& mechanics) try {
  BalanceForm form;
  try {
    const work::Budget budget(form_budget);
    return Balance(mechanics).derive();
  } catch (const Unsuitable& unsuitable) {
    form.skip_reason = unsuitable.reason;
  } catch (const work::BudgetExceeded& over) {
    form.skip_reason = over.what();
  }
  return form;
} catch (const std::domain_error&) {
  throw no_value_error(mechanics);
}

}  // namespace eomgen::reading
