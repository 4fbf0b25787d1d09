// SPDX-License-Identifier: MIT
// What a system has that a method may ask for, or may be unable to follow; what a method asks for; whether the two fit.
// In: features of a system, the needs of a method. Out: Eligibility, the reason as a value.
#pragma once

#include <initializer_list>
#include <span>

namespace eom {

enum class Feature : unsigned {
  jacobian,              // df/dx as a function
  series,                // the Taylor series of its solution
  momenta,               // dT/dqdot, their rates, and the mass matrix
  constraints,           // with multipliers: psi, A, b, and the mass matrix
  velocity_constraints,  // some of them bind velocities only
  modes,                 // its equations change on the way, at contacts that slip or are left
  kinks,                 // right-hand sides with abs, sign, min, max, if
  other_states,          // components that are no coordinates, velocities or quadratures
  moving_inputs,         // inputs that are functions of time, not steps
  charts,                // coordinates that are exchanged where they fail
};
inline constexpr Feature all_features[] = {
    Feature::jacobian, Feature::series, Feature::momenta,      Feature::constraints,   Feature::velocity_constraints,
    Feature::modes,    Feature::kinks,  Feature::other_states, Feature::moving_inputs, Feature::charts};

/// For "with ..." in a sentence.
constexpr const char* name(Feature feature) {
  switch (feature) {
    case Feature::jacobian: return "df/dx";
    case Feature::series: return "a Taylor series";
    case Feature::momenta: return "momenta";
    case Feature::constraints: return "constraints";
    case Feature::velocity_constraints: return "constraints on velocities";
    case Feature::modes: return "modes";
    case Feature::kinks: return "kinks";
    case Feature::other_states: return "states beside coordinates, velocities and quadratures";
    case Feature::moving_inputs: return "inputs that are functions of time";
    case Feature::charts: return "coordinates that are exchanged";
  }
  return "";
}

/// A set of them.
class Features {
 public:
  constexpr Features() = default;
  constexpr Features(std::initializer_list<Feature> features) {
    for (const Feature feature : features) bits_ |= bit(feature);
  }
  constexpr bool has(Feature feature) const { return (bits_ & bit(feature)) != 0; }
  constexpr bool none() const { return bits_ == 0; }
  constexpr Features operator|(Features other) const {
    other.bits_ |= bits_;
    return other;
  }
  /// With the feature, or without.
  constexpr Features set(Feature feature, bool present = true) const {
    Features changed = *this;
    changed.bits_ = present ? bits_ | bit(feature) : bits_ & ~bit(feature);
    return changed;
  }
  constexpr bool operator==(const Features&) const = default;

 private:
  static constexpr unsigned bit(Feature feature) { return 1U << static_cast<unsigned>(feature); }
  unsigned bits_ = 0;
};

/// A feature that a method cannot follow; why: a clause, without what it stands behind.
struct Refusal {
  Feature feature;
  const char* why;
};

/// What a method asks of a system; a method says so in a static member `needs`, and one without asks for nothing.
struct Needs {
  Features required = {};                 // without any of these it cannot run
  Features used = {};                     // taken where they are there, done without where they are not
  std::span<const Refusal> refuses = {};  // a system with one of these it cannot integrate
  const char* instead = "";               // the method to take where it is not eligible, and why that; empty: explicit
  bool keeps_constraints = false;         // itself, so that nothing is to be projected

  constexpr const Refusal* refusal(Feature feature) const {
    for (const Refusal& refused : refuses)
      if (refused.feature == feature) return &refused;
    return nullptr;
  }
};

/// Whether a method can integrate a system, and what stands against it.
struct Eligibility {
  enum class Reason { eligible, missing, refused };
  Reason reason = Reason::eligible;
  Feature feature = {};  // that is missing, or refused
  const char* why = "";  // of the refusal
  constexpr explicit operator bool() const { return reason == Reason::eligible; }
};

/// The first refusal in the method's order, else the first requirement that is missing.
constexpr Eligibility eligible(const Needs& needs, Features system) {
  for (const Refusal& refused : needs.refuses)
    if (system.has(refused.feature)) return {Eligibility::Reason::refused, refused.feature, refused.why};
  for (const Feature feature : all_features)
    if (needs.required.has(feature) && !system.has(feature)) return {Eligibility::Reason::missing, feature};
  return {};
}

}  // namespace eom
