// SPDX-License-Identifier: MIT
// Features of a system that a method may need or may not support; the requirements of a method; the check of one
// against the other. In: features of a system, the needs of a method. Out: Eligibility, with the reason as a value.
#pragma once

#include <initializer_list>
#include <span>

namespace eom {

/// A property of a system that decides which methods can integrate it.
enum class Feature : unsigned {
  jacobian,              // df/dx as a function
  series,                // the Taylor series of its solution
  momenta,               // dT/dqdot, their rates, and the mass matrix
  constraints,           // with multipliers: psi, A, b, and the mass matrix
  velocity_constraints,  // some of them constrain velocities only
  modes,                 // its equations change during the run, at contacts that slip or open
  kinks,                 // right-hand sides with abs, sign, min, max, if
  other_states,          // components that are not coordinates, velocities or quadratures
  moving_inputs,         // inputs that are continuous functions of time, not step functions
  charts,                // coordinates that are exchanged near their singularities
  contact_forces,        // forces of contacts that are solved for at every evaluation
};
inline constexpr Feature all_features[] = {Feature::jacobian,
                                           Feature::series,
                                           Feature::momenta,
                                           Feature::constraints,
                                           Feature::velocity_constraints,
                                           Feature::modes,
                                           Feature::kinks,
                                           Feature::other_states,
                                           Feature::moving_inputs,
                                           Feature::charts,
                                           Feature::contact_forces};

/// The feature as it follows "with ..." in a sentence.
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
    case Feature::contact_forces: return "contacts whose forces are solved for at every evaluation";
  }
  return "";
}

/// A set of features.
class Features {
 public:
  constexpr Features() = default;
  constexpr Features(std::initializer_list<Feature> features) {
    for (const Feature feature : features) bits_ |= bit(feature);
  }
  /// Whether the feature is in the set.
  constexpr bool has(Feature feature) const { return (bits_ & bit(feature)) != 0; }
  /// Whether the set is empty.
  constexpr bool none() const { return bits_ == 0; }
  constexpr Features operator|(Features other) const {
    other.bits_ |= bits_;
    return other;
  }
  /// A copy with or without the feature.
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

/// A feature that a method does not support; why: a clause that completes the message.
struct Refusal {
  Feature feature;
  const char* why;
};

/// Requirements of a method on a system. A method declares them in a static member `needs`; without it there are none.
struct Needs {
  Features required = {};                 // the method cannot run without these
  Features used = {};                     // used if available, not required
  std::span<const Refusal> refuses = {};  // the method cannot integrate a system that has one of these
  const char* alternative = "";           // a method to take if this one is not eligible, and why; empty: explicit
  bool keeps_constraints = false;         // the method satisfies the constraints itself; no projection is needed

  /// The reason to refuse a feature; null if it is not refused.
  constexpr const Refusal* refusal(Feature feature) const {
    for (const Refusal& refused : refuses)
      if (refused.feature == feature) return &refused;
    return nullptr;
  }
};

/// Whether a method can integrate a system, and the obstacle if not.
struct Eligibility {
  enum class Reason { eligible, missing, refused };
  Reason reason = Reason::eligible;
  Feature feature = {};  // the missing or refused one
  const char* why = "";  // of the refusal
  constexpr explicit operator bool() const { return reason == Reason::eligible; }
};

/// The first refusal in the method's order, else the first missing requirement.
constexpr Eligibility eligible(const Needs& needs, Features system) {
  for (const Refusal& refused : needs.refuses)
    if (system.has(refused.feature)) return {Eligibility::Reason::refused, refused.feature, refused.why};
  for (const Feature feature : all_features)
    if (needs.required.has(feature) && !system.has(feature)) return {Eligibility::Reason::missing, feature};
  return {};
}

}  // namespace eom
