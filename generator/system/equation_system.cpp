// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/equation_system.hpp"

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

std::string slip_slope_output(const std::string& slip, const std::string& coordinate) {
  return contact_prefix + ("slope." + slip) + "." + coordinate;
}
std::string phi_output(const std::string& slip) { return contact_prefix + ("phi." + slip); }
std::string restitution_output(const std::string& contact) { return contact_prefix + ("restitution." + contact); }

}  // namespace eomgen::system
