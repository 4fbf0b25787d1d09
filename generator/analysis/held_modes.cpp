// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/held_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace eomgen::analysis {
namespace {

using linear::HeldContact;
using linear::HeldMode;
using linear::Precise;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

/// A force or a slip this small beside its terms has no sign: runs end within their tolerance of a border.
constexpr double negligible = 1e-9;

/// Values of the contacts at the state of a problem, with the forces that its field has there; null: those of the
/// state alone.
class ContactValues {
 public:
  ContactValues(const SteadyProblem& p, const linear::Field<Precise>* field)
      : p_(p), field_(field), of_state_(p.flow->lookup(p.z, p.setting)) {}

  double operator()(Ref expression) const {
    return linear::to_double(
        linear::Tape(*p_.derived->mechanics.dag, {expression}, {}).values<Precise>([this](const Symbol& symbol) {
          return value_of(symbol);
        })[0]);
  }
  double length(const std::vector<Ref>& components) const {
    double square = 0;
    for (const Ref r : components) square += std::pow((*this)(r), 2);
    return std::sqrt(square);
  }
  /// The sum of the magnitudes that make up a velocity: of each rate times its slope.
  double terms(Ref velocity) const {
    const std::size_t n = p_.flow->coordinates();
    std::vector<Symbol> rates(p_.flow->symbols().begin() + static_cast<std::ptrdiff_t>(n),
                              p_.flow->symbols().begin() + static_cast<std::ptrdiff_t>(2 * n));
    const linear::ValueAndJacobian<Precise> s =
        linear::Tape(*p_.derived->mechanics.dag, {velocity}, rates).at<Precise>([this](const Symbol& symbol) {
          return value_of(symbol);
        });
    Precise sum(0), rest = s.value[0];
    for (std::size_t i = 0; i < n; ++i) {
      const Precise term = s.jacobian(0, i) * p_.z[n + i];
      sum = sum + linear::magnitude(term);
      rest = rest - term;
    }
    return linear::to_double(sum + linear::magnitude(rest));
  }
  /// Whether the motion determines a force.
  bool is_determined(const std::vector<Ref>& expressions) const {
    if (field_->undetermined.cols == 0) return true;
    const linear::ValueAndJacobian<Precise> s =
        linear::Tape(*p_.derived->mechanics.dag, expressions, p_.flow->forces())
            .at<Precise>([this](const Symbol& symbol) { return value_of(symbol); });
    const linear::Matrix<Precise> change = s.jacobian * field_->undetermined;
    return std::all_of(change.a.begin(), change.a.end(),
                       [](const Precise& x) { return linear::magnitude(x) < linear::tiny<Precise>(40); });
  }
  /// The largest force of a contact or constraint.
  double largest_force() const {
    double largest = 0;
    for (const Precise& force : field_->forces.a) largest = std::max(largest, std::abs(linear::to_double(force)));
    return largest;
  }

 private:
  Precise value_of(const Symbol& symbol) const {
    if (field_ == nullptr) return of_state_(symbol);
    const std::vector<Symbol>& forces = p_.flow->forces();
    const auto force = std::find(forces.begin(), forces.end(), symbol);
    if (force != forces.end()) return field_->forces(static_cast<std::size_t>(force - forces.begin()), 0);
    if (symbol.kind == SymbolKind::coordinate && symbol.order == 2) {
      const auto& free = p_.system().free;
      const auto place = std::find(free.begin(), free.end(), symbol.index) - free.begin();
      return field_->X(p_.flow->coordinates() + static_cast<std::size_t>(place), 0);
    }
    return of_state_(symbol);
  }

  const SteadyProblem& p_;
  const linear::Field<Precise>* field_;
  std::function<Precise(const Symbol&)> of_state_;
};

}  // namespace

SourceLocation location_of_contact(const model::Model& model, const std::string& name) {
  for (const model::Constraint& c : model.constraints) {
    if (c.name == name) return model.where(c.span);
  }
  for (const model::Force& f : model.forces) {
    if (f.name == name) return model.where(f.span);
  }
  return {model.file, 0, 0, 1, ""};
}

void refuse_border(const std::string& command, const model::Model& model, const std::string& contact,
                   const std::string& what) {
  throw Error(command, location_of_contact(model, contact),
              fmt::format("'{}' {} at this state: it lies on the border of two modes, whose equations have different "
                          "slopes",
                          contact, what),
              "take a state inside one mode: another start, or --at a time at which no event happens");
}

std::vector<HeldMode> held_modes(const mechanics::Mechanics& m, const std::map<std::string, double>& reported) {
  std::vector<HeldMode> result;
  for (const mechanics::Contact& contact : m.contacts) {
    const auto found = reported.find(contact.name);
    const double mode = found == reported.end() ? 0 : found->second;
    result.push_back({mode > 0.5 ? 1 : mode < -0.5 ? -1 : 0, 1});
  }
  return result;
}

std::unique_ptr<linear::Flow> flow_in_modes(SteadyProblem& p, const std::vector<HeldMode>& modes) {
  return std::make_unique<linear::Flow>(p.derived->mechanics, p.system(), modes);
}

void hold_contacts(SteadyProblem& p, std::vector<HeldMode> modes) {
  for (std::size_t attempt = 0; attempt <= modes.size(); ++attempt) {
    p.flow = flow_in_modes(p, modes);
    try {
      p.setting.leaf = p.flow->leaf(p.z, p.setting);
      const linear::Field<Precise> field = p.flow->at(p.z, p.setting);
      const ContactValues values(p, &field);
      bool changed = false;
      for (std::size_t j = 0; j < modes.size(); ++j) {
        const HeldContact& contact = p.flow->contacts()[j];
        if (contact.unilateral || !(values(contact.normal) < 0)) continue;
        modes[j].normal_sign = -modes[j].normal_sign;
        changed = true;
      }
      if (!changed) return;
    } catch (const std::domain_error&) {
      return;  // reported where the field is used
    }
  }
}

void require_inside_modes(const std::string& command, const SteadyProblem& p) {
  if (p.flow->contacts().empty()) return;
  const model::Model& model = p.derived->model;
  const ContactValues of_state(p, nullptr);
  for (const HeldContact& contact : p.flow->contacts()) {
    if (contact.smooth || contact.slip.empty() || contact.sticks()) continue;
    double terms = 0;
    for (const Ref w : contact.slip) terms += of_state.terms(w);
    if (!(of_state.length(contact.slip) > negligible * terms))
      refuse_border(command, model, contact.name, "begins to slide, or ends");
  }
  std::optional<linear::Field<Precise>> field;
  try {
    field = p.flow->at(p.z, p.setting);
  } catch (const std::domain_error&) {
    return;  // reported where the field is used
  }
  const ContactValues values(p, &*field);
  const double least = negligible * values.largest_force();
  for (const HeldContact& contact : p.flow->contacts()) {
    const bool known = values.is_determined({contact.normal});
    const bool presses = contact.unilateral || !contact.slip.empty();
    const double normal = values(contact.normal);
    if (presses && known && !(normal > least)) refuse_border(command, model, contact.name, "carries no force");
    if (contact.sticks() && known && contact.static_coefficient && values.is_determined(contact.friction)) {
      const double limit = values(*contact.static_coefficient) * normal;
      if (!(values.length(contact.friction) < (1 - negligible) * limit))
        refuse_border(command, model, contact.name, "has friction at its limit");
    }
  }
}

std::string mode_name(const HeldContact& contact) {
  if (contact.smooth) return "smooth friction";
  if (contact.slip.empty()) return "closed";
  if (contact.sticks()) return contact.rolls ? "rolls" : "sticks";
  return contact.held.mode < 0 ? "slides back" : "slides";
}

}  // namespace eomgen::analysis
