// SPDX-License-Identifier: MIT
// The members of Transitions that decide the modes of contacts. In: the rows of the forces at a state, the contacts
// that touch. Out: the modes, from a complementarity problem on accelerations.
#pragma once

#include "eom/contacts/transitions.hpp"

namespace eom::contacts {

inline Transitions::Result Transitions::settle(double t, const double* x, double* u, const Hint& hint,
                                               std::vector<bool>& broken, bool& again) {
  std::vector<double> inputs(u, u + input_count_);
  double* const v = inputs.data();
  if (const int code = forces_.evaluate_free(t, x, v); code != 0) return {Outcome::no_value, code, none};
  forces_.observe_accelerations();
  ContactProblem rows(forces_, t, x, v);
  for (std::size_t j = 0; j < forces_.set().contacts.size(); ++j) {
    if (!forces_.is_closed(j)) continue;
    const Description& at = forces_.contact(j);
    Index normal = -1;
    if (at.has_constraint())
      normal = rows.add_row(j, at.normal, forces_.normal_pattern(j, true),
                            at.unilateral ? Kind::unilateral : Kind::bilateral);
    if (forces_.is_sticking(j))
      rows.add_friction(j, normal, forces_.value(broken[j] ? at.dynamic_coefficient : at.static_coefficient));
  }
  if (const int code = rows.complete(); code != 0) return {Outcome::no_value, code, none};
  FrictionProblem& problem = rows.problem();
  const Index count = rows.size();
  Vector size(count);
  for (Index i = 0; i < count; ++i) {
    problem.q(i) = forces_.acceleration(rows.row(i), forces_.free_accelerations());
    size(i) =
        std::abs(forces_.value(rows.row(i).bias())) + forces_.terms(rows.row(i), forces_.free_accelerations().data());
  }
  favour(rows, size, hint);
  const FrictionForces found = solve(problem);
  if (!found.found) return {Outcome::no_solution, 0, rows.fastest_contact()};
  const double largest = count > 0 ? size.maxCoeff() : 0, rounding = forces_.acceleration_rounding();
  const double least = std::max(negligible * largest, rounding), opening = std::max(opens * largest, rounding);
  for (Index i = 0; i < count; ++i) {
    const std::size_t j = rows.contact(i);
    // One of the two is 0, but for rounding.
    const bool separates = !(found.force(i) > 0) || found.velocity(i) > problem.G(i, i) * found.force(i);
    if (rows.kind(i) == Kind::unilateral && separates &&
        (found.velocity(i) > opening || (hint.parts && hint.contact == j)))
      forces_.states()[j].mode = Mode::open;
    if (rows.kind(i) == Kind::bilateral && found.force(i) != 0)
      forces_.states()[j].normal_sign = found.force(i) < 0 ? -1 : 1;
  }
  const std::vector<std::size_t>& law_of = rows.contact_of_law();
  for (std::size_t l = 0; l < law_of.size(); ++l) {
    const std::size_t j = law_of[l];
    if (!forces_.is_closed(j) || !(found.speed[l] > least)) continue;
    if (!broken[j] &&
        forces_.value(forces_.contact(j).static_coefficient) != forces_.value(forces_.contact(j).dynamic_coefficient))
      broken[j] = again = true;
  }
  if (again) {
    // Nothing is final: contacts that were opened here may be closed with the other coefficient.
    for (Index i = 0; i < count; ++i)
      if (forces_.states()[rows.contact(i)].mode == Mode::open) forces_.states()[rows.contact(i)].mode = Mode::closed;
    return {};
  }
  for (std::size_t l = 0; l < law_of.size(); ++l) {
    const std::size_t j = law_of[l];
    if (!forces_.is_closed(j) || !(found.speed[l] > least)) continue;
    ContactState& state = forces_.states()[j];
    const std::vector<Index>& tangents = problem.laws[l].tangents;
    state.mode = tangents.size() == 1 && found.velocity(tangents[0]) < 0 ? Mode::sliding_back : Mode::sliding;
    state.starts = tangents.size() == 2;
    for (std::size_t a = 0; a < tangents.size(); ++a) state.direction[a] = found.velocity(tangents[a]) / found.speed[l];
  }
  return {};
}

inline void Transitions::favour(ContactProblem& rows, const Vector& size, const Hint& hint) const {
  if (hint.contact == none || !favours_) return;
  Vector& q = rows.problem().q;
  const double largest = size.size() > 0 ? size.maxCoeff() : 0;
  std::size_t a = 0;
  for (Index i = 0; i < q.size(); ++i) {
    if (rows.contact(i) != hint.contact) continue;
    if (rows.kind(i) == Kind::friction) {
      const std::array<double, 2>& phi = friction_before_;
      const double length = std::hypot(phi[0], phi[1]);
      if (hint.slips && length > 0) q(i) -= announced * largest * phi[a] / length;
      ++a;
    } else if (hint.parts) {
      q(i) += announced * largest;
    }
  }
}

}  // namespace eom::contacts
