// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/friction_law.hpp"

#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>

#include <stdexcept>

#include "oracle/linear_solve.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::verify {
namespace {

using symbolic::Ref;

class Law {
 public:
  Law(const system::EquationSystem& s, const Oracle& oracle, const State& state)
      : s_(s), oracle_(oracle), state_(state) {
    for (const system::Contact& contact : s.contacts) {
      for (const auto* list : {&contact.gram, &contact.slip, &contact.slip_rate}) {
        roots_.insert(roots_.end(), list->begin(), list->end());
      }
      const bool rough = !contact.slip.empty();
      roots_.push_back(contact.reactions.empty() ? contact.normal : s.dag->zero());
      roots_.push_back(rough ? contact.dynamic_coefficient : s.dag->zero());
      roots_.push_back(contact.width.value_or(s.dag->zero()));
      for (const std::uint32_t k : contact.reactions) roots_.push_back(s.reactions[k].value);
      for (const system::BlockedDirection& held : contact.blocked)
        roots_.insert(roots_.end(), held.along.begin(), held.along.end());
    }
  }

  /// The residual of the law for each tangent: it vanishes if `phi` obeys the law.
  std::vector<Real> residual(const std::vector<Real>& phi) const {
    State state = state_;
    state.phi = phi;
    SymbolValues lookup(oracle_, state);
    solve_accelerations(s_, lookup, oracle_.digits());
    const std::vector<Real> value = symbolic::evaluate(*s_.dag, roots_, lookup, oracle_.digits());
    auto next = value.begin();
    const auto take = [&](std::size_t count) {
      std::vector<Real> part(next, next + static_cast<std::ptrdiff_t>(count));
      next += static_cast<std::ptrdiff_t>(count);
      return part;
    };
    std::vector<Real> result;
    for (std::size_t j = 0; j < s_.contacts.size(); ++j) {
      const system::Contact& c = s_.contacts[j];
      const std::vector<Real> gram = take(c.gram.size()), slip = take(c.slip.size()), rate = take(c.slip.size());
      const Real given = take(1)[0], mu = take(1)[0], width = take(1)[0];
      const std::vector<Real> lambda = take(c.reactions.size());
      std::vector<std::vector<Real>> held;  // by closed contacts
      for (const system::BlockedDirection& direction : c.blocked) {
        std::vector<Real> along = take(direction.along.size());
        const bool is_closed = !s_.contacts[direction.by].unilateral || normal_sign(direction.by) >= 0;
        if (is_closed) held.push_back(std::move(along));
      }
      if (slip.empty()) continue;
      const bool is_open = c.unilateral && normal_sign(j) < 0;
      if (!held.empty() && !is_open && !c.width && slides(j) == 0) {
        add_held(held, &phi[c.first], rate, result);
        continue;
      }
      const Real normal = normal_force(j, gram, given, lambda);
      for (std::size_t a = 0; a < slip.size(); ++a) {
        if (is_open)
          result.push_back(phi[c.first + a]);
        else if (c.width)
          result.push_back(phi[c.first + a] + mu * normal * slip[a] / length(slip, width));
        else if (slides(j) == 0)
          result.push_back(rate[a]);
        else
          result.push_back(phi[c.first + a] + mu * normal * heading(j, slip, a));
      }
    }
    return result;
  }

 private:
  /// Sticking friction has no component along directions that other contacts constrain.
  static void add_held(const std::vector<std::vector<Real>>& held, const Real* phi, const std::vector<Real>& rate,
                       std::vector<Real>& result) {
    if (rate.size() == 2 && held.size() == 1) {
      const std::vector<Real>& h = held[0];
      result.push_back(h[0] * phi[0] + h[1] * phi[1]);
      result.push_back(h[0] * rate[1] - h[1] * rate[0]);
      return;
    }
    for (std::size_t a = 0; a < rate.size(); ++a) result.push_back(phi[a]);
  }
  int slides(std::size_t j) const { return eom::contact_sign(state_.mode, j, 0); }
  int normal_sign(std::size_t j) const { return eom::contact_sign(state_.mode, j, 1); }
  Real root(const Real& x) const { return cln::realpart(cln::sqrt(oracle_.precision().round(x))); }

  Real normal_force(std::size_t j, const std::vector<Real>& gram, const Real& given,
                    const std::vector<Real>& lambda) const {
    if (lambda.empty()) return cln::abs(given);
    if (lambda.size() == 1) return normal_sign(j) * root(gram[0]) * lambda[0];
    Real square = 0;
    for (std::size_t k = 0; k < 4; ++k) square = square + gram[k] * lambda[k / 2] * lambda[k % 2];
    return root(square);
  }
  Real heading(std::size_t j, const std::vector<Real>& slip, std::size_t a) const {
    if (slip.size() == 1) return slides(j);
    return slip[a] / length(slip, 0);
  }
  Real length(const std::vector<Real>& slip, const Real& more) const {
    Real square = more * more;
    for (const Real& w : slip) square = square + w * w;
    return root(square);
  }

  const system::EquationSystem& s_;
  const Oracle& oracle_;
  const State& state_;
  std::vector<Ref> roots_;
};

}  // namespace

void set_friction(const mechanics::Mechanics& m, const Oracle& oracle, State& state, std::vector<Real> phi) {
  state.phi = std::move(phi);
  state.friction.clear();
  const SymbolValues lookup(oracle, state);
  for (const mechanics::Contact& contact : m.contacts) {
    if (contact.dimensions() == 0) continue;
    FrictionForce friction{contact.place, contact.coordinate, {Real(0), Real(0), Real(0)}, contact.body_contact};
    if (contact.place == 0) friction.force[0] = state.phi[contact.first];
    for (std::size_t a = 0; a < contact.directions.size(); ++a) {
      const mechanics::Vec3& t = contact.directions[a];
      const std::vector<Real> direction = symbolic::evaluate(*m.dag, {t[0], t[1], t[2]}, lookup, oracle.digits());
      for (std::size_t k = 0; k < 3; ++k)
        friction.force[k] = friction.force[k] + state.phi[contact.first + a] * direction[k];
    }
    state.friction.push_back(friction);
  }
}

std::vector<Real> solve_friction_law(const system::EquationSystem& s, const Oracle& oracle, const State& state) {
  const Law law(s, oracle, state);
  std::size_t n = 0;
  for (const system::Contact& contact : s.contacts) n += contact.slip.size();
  std::vector<Real> phi(n, oracle.precision().round(Real(0)));
  const Real h = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(oracle.digits() / 2));
  const Real small = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(oracle.digits()));
  // Linear except for the magnitude of a normal force of two components: a few iterations suffice.
  for (int round = 0; round < 60; ++round) {
    const std::vector<Real> r = law.residual(phi);
    std::vector<Real> matrix(n * n), right;
    for (std::size_t b = 0; b < n; ++b) {
      std::vector<Real> shifted = phi;
      shifted[b] = shifted[b] + h;
      const std::vector<Real> moved = law.residual(shifted);
      for (std::size_t a = 0; a < n; ++a) matrix[a * n + b] = (moved[a] - r[a]) / h;
      right.push_back(-r[b]);
    }
    const Solution step = solve(std::move(matrix), std::move(right));
    if (!step.exists()) throw Singular("the friction law has no isolated solution");
    Real size = 0, change = 0;
    for (std::size_t b = 0; b < n; ++b) {
      phi[b] = phi[b] + step.x()[b];
      size = cln::max(size, cln::abs(phi[b]));
      change = cln::max(change, cln::abs(step.x()[b]));
    }
    if (change <= small * (1 + size)) return phi;
  }
  throw std::domain_error("the friction law was not solved");
}

}  // namespace eomgen::verify
