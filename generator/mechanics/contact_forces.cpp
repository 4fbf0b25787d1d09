// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact_forces.hpp"

#include <algorithm>
#include <eom/modes/contact_state.hpp>

#include "mechanics/stages.hpp"

namespace eomgen::mechanics {
namespace {

/// Adds inputs to a copy of the model.
class InputAdder {
 public:
  explicit InputAdder(Mechanics& m) : m_(m), model_(std::make_shared<model::Model>(*m.model)) {}
  ~InputAdder() { m_.model = model_; }

  std::uint32_t add(const std::string& name, const model::Span& span) {
    model::Input input;
    input.name = name;
    input.span = span;
    input.source = model::Input::Source::contacts;
    model_->inputs.push_back(std::move(input));
    return static_cast<std::uint32_t>(model_->inputs.size() - 1);
  }

 private:
  Mechanics& m_;
  std::shared_ptr<model::Model> model_;
};

model::Span span_of(const model::Model& model, const Contact& contact) {
  for (const model::Constraint& constraint : model.constraints)
    if (constraint.name == contact.name) return constraint.span;
  for (const model::Force& force : model.forces)
    if (force.name == contact.name) return force.span;
  return {};
}

}  // namespace

bool needs_contact_inputs(const Mechanics& m) {
  return m.contacts.size() > eom::max_contacts || (m.model->impacts && !m.contacts.empty());
}

void require_contact_inputs(Mechanics& m) {
  for (const Contact& contact : m.contacts) {
    if (contact.constraints.size() < 2) continue;
    throw Error("mechanics", m.model->where(friction_law_of(m, contact).span),
                "the friction of the curve '" + contact.name +
                    "' cannot be solved for together with these contacts, or with a law of impacts",
                "remove this friction or [impacts], or leave at most three contacts that cannot hold more directions "
                "than are free");
  }
  for (const Contact& contact : m.contacts) {
    for (const std::uint32_t k : contact.constraints) m.constraints[k].force_input = 0;  // numbered later
  }
}

namespace {

/// Throws Error if a contact that can open has friction that the law of impacts does not define: by the smooth law, or
/// by Stronge's law with two directions of slip.
void require_friction_in_impacts(const Mechanics& m) {
  using Law = model::Impacts::Law;
  if (!m.model->impacts || m.model->impacts->law == Law::newton) return;
  for (const Contact& contact : m.contacts) {
    if (!contact.unilateral || contact.dimensions() == 0) continue;
    const model::Span where = friction_law_of(m, contact).span;
    if (contact.width)
      throw Error("mechanics", m.model->where(where),
                  "friction in impacts needs Coulomb's law, and that of '" + contact.name + "' is smooth",
                  "remove law = \"smooth\" and width, or write law = \"newton\" in [impacts], without friction");
    if (m.model->impacts->law != Law::stronge || contact.dimensions() < 2) continue;
    throw Error("mechanics", m.model->where(where),
                "'" + contact.name + "' can slip in two directions, and Stronge's law is defined for one",
                "write law = \"moreau\" or \"poisson\" in [impacts], or let the bodies move in a plane");
  }
}

}  // namespace

void number_contact_inputs(Mechanics& m) {
  const auto requires_input = [](const Constraint& constraint) { return constraint.force_input.has_value(); };
  const bool constrained = std::any_of(m.constraints.begin(), m.constraints.end(), requires_input);
  if (!constrained && !needs_contact_inputs(m)) return;
  require_friction_in_impacts(m);
  InputAdder inputs(m);
  const std::shared_ptr<const model::Model> before = m.model;
  for (Contact& contact : m.contacts) {
    const model::Span span = span_of(*before, contact);
    for (std::size_t a = 0; a < contact.dimensions(); ++a) {
      const std::uint32_t input =
          inputs.add(contact.name + ".friction" + (contact.dimensions() > 1 ? std::to_string(a + 1) : ""), span);
      if (a == 0) contact.first_input = input;
    }
    const std::uint32_t mode = inputs.add(contact.name + ".mode", span);
    if (!contact.first_input) contact.first_input = mode;
    for (const std::uint32_t k : contact.constraints)
      m.constraints[k].force_input = inputs.add(contact.name + ".lambda", span);
  }
}

std::map<symbolic::Symbol, symbolic::Symbol> contact_inputs(const Mechanics& m) {
  std::map<symbolic::Symbol, symbolic::Symbol> result;
  if (!m.has_contact_inputs()) return result;
  for (const Contact& contact : m.contacts) {
    for (std::uint32_t a = 0; a < contact.dimensions(); ++a)
      result[{SymbolKind::friction, contact.first + a, 0}] = {SymbolKind::input, *contact.first_input + a, 0};
  }
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    if (m.constraints[k].force_input)
      result[{SymbolKind::multiplier, k, 0}] = {SymbolKind::input, *m.constraints[k].force_input, 0};
  }
  return result;
}

Ref contact_mode(const Mechanics& m, const Contact& contact) {
  const auto after = static_cast<std::uint32_t>(contact.dimensions());
  return m.dag->symbol({SymbolKind::input, *contact.first_input + after, 0});
}

}  // namespace eomgen::mechanics
