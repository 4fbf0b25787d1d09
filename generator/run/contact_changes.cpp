// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/contact_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "run/derivative_run.hpp"

namespace eomgen::run {
namespace {

namespace contacts = eom::contacts;

/// The equations in their branches, for given forces of contacts.
class ContactSystem : public contacts::System {
 public:
  explicit ContactSystem(VariationalEquations& in) : in_(in), dx_(in.problem.states()) {}
  std::size_t coordinates() const override { return in_.problem.n(); }
  int accelerations(double t, const double* x, const double* u, double* qddot) override {
    const eom::hybrid::Model& model = in_.context.model;
    const int code = in_.problem.code->rhs(t, x, model.parameters(), u, model.mode().data(), dx_.data());
    std::copy_n(dx_.begin() + static_cast<std::ptrdiff_t>(coordinates()), coordinates(), qddot);
    return code;
  }
  int rows(double t, const double* x, const double* u, double* c) override {
    const eom::hybrid::Model& model = in_.context.model;
    return in_.problem.code->contact_rows(t, x, model.parameters(), u, model.mode().data(), c);
  }

 private:
  VariationalEquations& in_;
  std::vector<double> dx_;
};

bool begins_to_slip(const contacts::ContactState& before, const contacts::ContactState& after) {
  return before.mode == contacts::Mode::closed &&
         (after.mode == contacts::Mode::sliding || after.mode == contacts::Mode::sliding_back);
}

}  // namespace

double ImpendingMotion::acceleration(VariationalEquations& in, double t, const std::vector<double>& x) const {
  contacts::Set set = in.problem.code->contact_set;
  for (std::size_t j = 0; j < set.contacts.size(); ++j) {
    if (set.contacts[j].sticks && begins_to_slip(before.solved->states[j], after.solved->states[j]))
      set.contacts[j].dynamic_coefficient = set.contacts[j].static_coefficient;
  }
  ContactSystem system(in);
  contacts::ContactForces forces(set, system);
  forces.states() = after.solved->states;
  contacts::ContactForces::Vector qddot;
  if (forces.evaluate_accelerations(t, x.data(), in.context.model.inputs_without_contacts(t), qddot) != 0)
    return std::nan("");
  const contacts::Mode mode = after.solved->states[contact].mode;
  const contacts::Description& at = set.contacts[contact];
  if (mode == contacts::Mode::open) return scale + forces.acceleration(at.normal, qddot);
  return scale + static_cast<double>(mode) * forces.acceleration(at.slip.front(), qddot);
}

std::optional<ImpendingMotion> impending_motion(VariationalEquations& in, const eom::Crossing& crossing, double t,
                                                const std::vector<double>& x, const ContactSnapshot& before,
                                                const ContactSnapshot& after) {
  if (!in.context.solved_contacts) return std::nullopt;
  constexpr std::size_t values = eom::hybrid::SolvedContacts::values_per_contact;
  const std::size_t which = (crossing.function - in.context.events.first_solved_contact()) % values;
  const std::vector<contacts::ContactState>&from = before.solved->states, &to = after.solved->states;
  std::size_t j = 0;
  const auto begins = [&](std::size_t k) {
    if (which == 1) return in.problem.code->contact_set.contacts[k].sticks && begins_to_slip(from[k], to[k]);
    return which == 0 && from[k].mode != contacts::Mode::open && to[k].mode == contacts::Mode::open;
  };
  while (j < to.size() && !begins(j)) ++j;
  if (j == to.size()) return std::nullopt;
  ContactSystem system(in);
  contacts::ContactForces forces(in.problem.code->contact_set, system);
  forces.states() = from;
  if (forces.solve(t, x.data(), in.context.model.inputs_without_contacts(t)) != 0 || !forces.undetermined())
    return std::nullopt;
  constexpr double units = 1e13;  // of the rounding of accelerations
  return ImpendingMotion{j, before, after, units * forces.acceleration_rounding()};
}

bool ContactSnapshot::has_modes_of(const ContactSnapshot& other) const {
  if (modes && other.modes && modes->mode != other.modes->mode) return false;
  if (!solved || !other.solved) return true;
  const auto same = [](const eom::contacts::ContactState& a, const eom::contacts::ContactState& b) {
    return a.mode == b.mode;
  };
  return std::equal(solved->states.begin(), solved->states.end(), other.solved->states.begin(), same);
}

ContactSnapshot save_contacts(const VariationalEquations& in) {
  ContactSnapshot result{in.context.model.mode(), {}, {}};
  if (in.context.contacts) result.modes = in.context.contacts->save();
  if (in.context.solved_contacts) result.solved = in.context.solved_contacts->save();
  return result;
}

void restore_contacts(VariationalEquations& in, const ContactSnapshot& from) {
  if (in.context.contacts) {
    eom::hybrid::ContactModes::State state = *from.modes;
    state.restitution = in.context.contacts->save().restitution;
    in.context.contacts->restore(state);
  }
  if (in.context.solved_contacts) in.context.solved_contacts->restore(*from.solved);
  in.context.model.set_mode(from.mode);
}

void watch_contacts(VariationalEquations& in, std::span<eom::EventFunction> functions) {
  const eom::hybrid::EventFunctions& events = in.context.events;
  if (in.context.contacts) in.context.contacts->watch(events.of_contacts(functions));
  if (in.context.solved_contacts) in.context.solved_contacts->watch(events.of_solved_contacts(functions));
}

void change_contacts(VariationalEquations& in, const eom::Crossing& crossing, double& t, std::vector<double>& x) {
  eom::hybrid::RunContext& context = in.context;
  std::vector<eom::EventFunction> functions(context.events.size());
  eom::Crossing local = crossing;
  bool ended = false;
  if (context.contacts) {
    local.function -= context.events.first_contact();
    context.contacts->handle_event(t, x, local, context.events.of_contacts(functions));
    context.model.set_contact_mode(context.contacts->mode());
    ended = context.contacts->end_outcome().has_value();
  } else {
    local.function -= context.events.first_solved_contact();
    context.solved_contacts->handle_event(t, x, local, context.events.of_solved_contacts(functions));
    ended = context.solved_contacts->end_outcome().has_value();
  }
  if (ended) refuse_derivative(fmt::format("a contact ends the run at t = {}", t));
}

std::optional<SlipBound> bound_of_slip(VariationalEquations& in, const eom::Crossing& crossing, double t,
                                       const std::vector<double>& x) {
  SlipBound bound;
  if (in.context.solved_contacts) {
    constexpr std::size_t values = eom::hybrid::SolvedContacts::values_per_contact;
    const std::size_t function = crossing.function - in.context.events.first_solved_contact();
    bound.contact = function / values;
    const contacts::Description& contact = in.problem.code->contact_set.contacts[bound.contact];
    if (!contact.sticks || contact.slip.size() != 2 || function % values != 1) return std::nullopt;
    const contacts::ContactForces& forces = *in.context.model.contact_forces();
    bound.ends = forces.states()[bound.contact].mode != contacts::Mode::closed;
    if (bound.ends) bound.along = slip_of(in, bound.contact, t, x);
    return bound;
  }
  if (!in.context.contacts) return std::nullopt;
  const std::size_t function = crossing.function - in.context.events.first_contact();
  bound.contact = function / eom::contact_values;
  const eom::Contact& contact = in.problem.code->contacts[bound.contact];
  if (!contact.sticks || contact.dimensions != 2 || function % eom::contact_values > 2) return std::nullopt;
  bound.ends = eom::contact_digit(in.context.contacts->mode(), bound.contact) % 3 != 0;
  if (bound.ends) bound.along = slip_of(in, bound.contact, t, x);
  return bound;
}

int evaluate_contact_rows(VariationalEquations& in, double t, const double* x) {
  eom::hybrid::Model& model = in.context.model;
  model.forget_contact_forces();
  return model.contact_forces()->evaluate_rows(t, x, model.inputs_without_contacts(t));
}

std::array<double, 2> slip_at_rows(const contacts::ContactForces& forces, std::size_t j) {
  const std::vector<contacts::Row>& rows = forces.contact(j).slip;
  return {forces.rate(rows[0]), forces.rate(rows[1])};
}

std::array<double, 2> slip_of(VariationalEquations& in, std::size_t contact, double t, const std::vector<double>& x) {
  if (in.context.solved_contacts) {
    if (evaluate_contact_rows(in, t, x.data()) != 0) return {std::nan(""), std::nan("")};
    return slip_at_rows(*in.context.model.contact_forces(), contact);
  }
  const std::vector<std::size_t>& places = in.problem.contacts[contact].slip;
  std::vector<double> y(in.problem.code->output_names.size());
  if (in.context.outputs(t, x.data(), y) != 0) return {std::nan(""), std::nan("")};
  return {y[places[0]], y[places[1]]};
}

std::string ended_bounces(const VariationalEquations& in, const ContactSnapshot& before, const ContactSnapshot& after) {
  constexpr std::size_t several = 3;  // as where a run ends such a sequence (solved_contacts.hpp)
  if (before.modes && after.modes) {
    const std::vector<eom::Contact>& contacts = in.problem.code->contacts;
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const bool closes = contacts[j].unilateral && eom::contact_digit(before.modes->mode, j) == 3 &&
                          eom::contact_digit(after.modes->mode, j) != 3;
      if (closes && before.modes->hits.of(j) >= static_cast<std::ptrdiff_t>(several)) return contacts[j].name;
    }
  }
  if (before.solved && after.solved) {
    const std::vector<eom::contacts::Description>& contacts = in.problem.code->contact_set.contacts;
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const bool closes = before.solved->states[j].mode == eom::contacts::Mode::open &&
                          after.solved->states[j].mode != eom::contacts::Mode::open;
      if (closes && before.solved->hits[j] >= several) return contacts[j].name;
    }
  }
  return "";
}

}  // namespace eomgen::run
