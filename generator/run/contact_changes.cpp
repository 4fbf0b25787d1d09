// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/contact_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace eomgen::run {

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
  if (!in.context.contacts) return std::nullopt;
  SlipBound bound;
  const std::size_t function = crossing.function - in.context.events.first_contact();
  bound.contact = function / eom::contact_values;
  const eom::Contact& contact = in.problem.code->contacts[bound.contact];
  if (!contact.sticks || contact.dimensions != 2 || function % eom::contact_values > 2) return std::nullopt;
  bound.ends = eom::contact_digit(in.context.contacts->mode(), bound.contact) % 3 != 0;
  if (bound.ends) bound.along = slip_of(in, bound.contact, t, x);
  return bound;
}

std::array<double, 2> slip_of(VariationalEquations& in, std::size_t contact, double t, const std::vector<double>& x) {
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

std::string unfollowed_contacts(const RunRequest& request) {
  // Their right-hand sides are differentiated by differences, which are wider than slip that ends.
  for (const eom::contacts::Description& contact : request.code.contact_set.contacts) {
    if (contact.sticks && contact.slip.size() == 2)
      return fmt::format("'{}' slides in two directions, and contact forces are solved for at every evaluation",
                         contact.name);
  }
  if (request.code.contacts.empty() && request.code.contact_set.empty()) return "";
  const bool resets = std::any_of(request.events.begin(), request.events.end(),
                                  [](const eom::hybrid::WatchedEvent& event) { return !event.reset.set.empty(); });
  if (resets || !request.samples.empty()) return "the model has contacts, and events or samples that change its state";
  return "";
}

}  // namespace eomgen::run
