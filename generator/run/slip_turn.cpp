// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/slip_turn.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "eom/contacts/slip_start.hpp"
#include "run/central_differences.hpp"
#include "run/contact_changes.hpp"

namespace eomgen::run {
namespace {

namespace contacts = eom::contacts;

bool slips_in_two_directions(const contacts::ContactForces& forces, std::size_t j) {
  const contacts::Description& at = forces.contact(j);
  return at.slip.size() == 2 && at.sticks && at.width == contacts::none && forces.has_friction(j);
}

/// The derivative of the angle of friction at slip w by a change of this slip.
double turn_of(const contacts::ContactForces& forces, std::size_t j, const std::array<double, 2>& w,
               const std::array<double, 2>& change) {
  const contacts::ContactState& state = forces.states()[j];
  const double least = forces.least_slip(), end = state.starts ? forces.start_slip() : least;
  return contacts::friction_angle_derivative(w, change, state.direction, least, end);
}

}  // namespace

SlipTurn::SlipTurn(VariationalEquations& own, double t, const double* x) : own_(own) {
  const contacts::ContactForces* const forces = own.context.model.contact_forces();
  if (forces == nullptr) return;
  bool any = false;
  for (std::size_t j = 0; j < forces->set().contacts.size(); ++j) any = any || slips_in_two_directions(*forces, j);
  if (!any || evaluate_contact_rows(own, t, x) != 0) return;
  for (std::size_t j = 0; j < forces->set().contacts.size(); ++j)
    if (slips_in_two_directions(*forces, j)) contacts_.push_back({j, slip_at_rows(*forces, j), forces->direction(j)});
  hold(own);
}

SlipTurn::~SlipTurn() {
  for (VariationalEquations* in : held_) {
    in->context.model.contact_forces()->prescribe_directions({});
    in->context.model.forget_contact_forces();
  }
}

void SlipTurn::hold(VariationalEquations& in) {
  if (contacts_.empty()) return;
  prescribe(in, std::vector<double>(contacts_.size(), 0.0));
  if (std::find(held_.begin(), held_.end(), &in) == held_.end()) held_.push_back(&in);
}

/// Turns the directions by these angles.
void SlipTurn::prescribe(VariationalEquations& in, const std::vector<double>& angles) const {
  contacts::ContactForces& forces = *in.context.model.contact_forces();
  std::vector<std::optional<std::array<double, 2>>> directions(forces.set().contacts.size());
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const double c = std::cos(angles[k]), s = std::sin(angles[k]);
    const std::array<double, 2>& n = contacts_[k].direction;
    directions[contacts_[k].place] = {c * n[0] - s * n[1], s * n[0] + c * n[1]};
  }
  forces.prescribe_directions(std::move(directions));
  in.context.model.forget_contact_forces();
}

int SlipTurn::add_slips(VariationalEquations& in, double t, const double* x, double weight, Slips& sum) const {
  if (contacts_.empty()) return 0;
  if (const int code = evaluate_contact_rows(in, t, x); code != 0) return code;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const std::array<double, 2> w = slip_at_rows(*in.context.model.contact_forces(), contacts_[k].place);
    for (std::size_t a = 0; a < 2; ++a) sum[k][a] += weight * w[a];
  }
  return 0;
}

int SlipTurn::add_turn(double t, const double* x, const Slips& rates, double* slope) {
  const contacts::ContactForces& forces = *own_.context.model.contact_forces();
  std::vector<double> turns(contacts_.size());  // d angle
  double fastest = 0;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    turns[k] = turn_of(forces, contacts_[k].place, contacts_[k].slip, rates[k]);
    fastest = std::max(fastest, std::abs(turns[k]));
  }
  if (!(fastest > 0)) return 0;
  constexpr double widest = 1e-3;  // angle
  const double h = widest / fastest;
  std::vector<double> angles(contacts_.size()), f(own_.problem.states());
  int code = 0;
  for (const auto& [offset, weight] : order_four) {
    for (std::size_t k = 0; k < contacts_.size(); ++k) angles[k] = offset * h * turns[k];
    prescribe(own_, angles);
    if (code = own_.context.rhs(t, x, f.data()); code != 0) break;
    for (std::size_t i = 0; i < f.size(); ++i) slope[i] += weight / h * f[i];
  }
  prescribe(own_, std::vector<double>(contacts_.size(), 0.0));
  return code;
}

}  // namespace eomgen::run
