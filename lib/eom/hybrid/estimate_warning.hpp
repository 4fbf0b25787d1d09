// SPDX-License-Identifier: MIT
// Reasons why an error estimate is unreliable, as values and as sentences.
#pragma once

#include <string>

#include "eom/hybrid/text.hpp"
#include "eom/outcome.hpp"

namespace eom::hybrid {

/// The first reason found why the estimate may miss an error or had to be enlarged.
struct EstimateWarning {
  enum class Kind {
    none,
    missed_narrow_force,  // after t fixed steps skip a force that is narrow in the state
    sensitive_start,      // a start that differs in its last digits ends with another outcome: `other`
    tighter_run_differs,  // a tighter run ended with the outcome `other`
    event_not_reached,    // a tighter run did not stop at the event
    unresolved,           // fixed steps do not resolve the motion: halving them moves states by `amount` of their size
    impulse,              // near t a force turns within one step, by `amount` of the velocity
    not_converging,       // shorter fixed steps change the end by as much again
    positions_frozen      // steps of `amount` change positions only in their last digits
  };
  Kind kind = Kind::none;
  double t = 0, amount = 0;
  Outcome other = Outcome::done;

  explicit operator bool() const { return kind != Kind::none; }
};

/// "" for none.
inline std::string sentence(const EstimateWarning& warning) {
  using Kind = EstimateWarning::Kind;
  switch (warning.kind) {
    case Kind::none: return "";
    case Kind::missed_narrow_force:
      return "a step after t = " + printed(warning.t, 6) +
             " goes over a force that is narrow in the state and misses it, so that the estimate is not valid; give "
             "shorter steps, or let them be chosen";
    case Kind::sensitive_start:
      return std::string("from a start that differs in its last digits the run ends with '") + name(warning.other) +
             "'; the estimate is not to be trusted";
    case Kind::tighter_run_differs:
      return std::string("a tighter run ended with '") + name(warning.other) + "'; the estimate is not to be trusted";
    case Kind::event_not_reached:
      return "a tighter run did not stop at the event: the compared ends are at different times";
    case Kind::unresolved:
      return "steps of this size do not resolve the motion: halving them moves states on the way by " +
             printed(warning.amount, 2) + " of their size; take shorter ones, or a solver that chooses its steps";
    case Kind::impulse:
      return "near t = " + printed(warning.t, 6) +
             " a force turns within one step, which changes the velocity by up to " + printed(warning.amount, 2) +
             " of its size in the wrong place; take shorter steps, or a solver that chooses its steps";
    case Kind::not_converging:
      return "steps of this size are too long for the method's order to show: shorter ones change the end by as much "
             "again; the estimate is not to be trusted";
    case Kind::positions_frozen:
      return "steps of " + printed(warning.amount, 3) +
             " change the positions by less than their last digits, so that constraints do not determine the rates; "
             "the estimate is not to be trusted";
  }
  return "";
}

}  // namespace eom::hybrid
