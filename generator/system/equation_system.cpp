// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/equation_system.hpp"

#include <algorithm>

#include "lists.hpp"

namespace eomgen::system {

const char* name(Approach approach) { return approach == Approach::one ? "I" : "II"; }

const char* name(Form form) {
  switch (form) {
    case Form::nullspace: return "nullspace";
    case Form::chaplygin: return "chaplygin";
    case Form::multipliers: break;
  }
  return "multipliers";
}

std::vector<symbolic::Symbol> EquationSystem::state_symbols() const { return mapped(states, &FirstOrderState::symbol); }

bool EquationSystem::has_resets() const {
  return !samples.empty() ||
         std::any_of(events.begin(), events.end(), [](const Event& event) { return !event.reset.set.empty(); });
}

EquationSystem::EquationSystem() = default;
EquationSystem::EquationSystem(const EquationSystem&) = default;
EquationSystem::EquationSystem(EquationSystem&&) noexcept = default;
EquationSystem& EquationSystem::operator=(const EquationSystem&) = default;
EquationSystem& EquationSystem::operator=(EquationSystem&&) noexcept = default;
EquationSystem::~EquationSystem() = default;

}  // namespace eomgen::system
